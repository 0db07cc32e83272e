// littoral distance: distance on a surface from curves and points on it, or through tets.

#include <memory>

#include "api/surface/surface_domain.h"
#include "api/tet/tet_boundary.h"
#include "api/tet/tet_domain.h"
#include "base/stopwatch.h"
#include "cli/input/method_options.h"
#include "cli/input/numbers.h"
#include "cli/input/surface_input.h"
#include "cli/output.h"
#include "cli/plan/plan.h"
#include "cli/verbs/verbs.h"
#include "io/read.h"
#include "io/render/discs.h"
#include "littoral/error.h"
#include "sources/curves/boundary_curves.h"

namespace littoral::cli {

namespace {

using io::Kind;

const io::Kinds surface_outputs = {Kind::field, Kind::page, Kind::picture};
const io::Kinds tet_outputs = {Kind::tets, Kind::field, Kind::page, Kind::picture};

struct DistanceArguments {
  std::string domain;
  std::vector<std::string> sources, out;
  NamedSources named;
  bool boundary = false;
  std::string values;
  MethodArguments method;
};

[[noreturn]] void throw_no_sources(const std::string& domain, const std::string& own) {
  throw InputError(
      "nothing to measure distance from: name --sources FILE, --vertex I, --at X,Y,Z or --boundary "
      "(" +
          domain + " has no " + own + " of its own)",
      "nothing-given");
}

Sources gather(const DistanceArguments& arguments, const SurfaceMesh& mesh, Session& session) {
  if (!arguments.values.empty())
    throw InputError(
        "option values is for tets; on surfaces the files of --sources hold the values of curves "
        "and points",
        "options-conflict");
  Sources sources = read_all_sources(arguments.sources, mesh, session);
  sources.add(named_sources(arguments.named, mesh, arguments.domain, session));
  if (arguments.boundary) {
    const std::vector<Curve> loops = boundary_curves(mesh);
    if (loops.empty())
      throw InputError("option boundary: " + arguments.domain + " has no boundary",
                       "nothing-there");
    sources.curves.insert(sources.curves.end(), loops.begin(), loops.end());
  }
  if (sources.empty()) {
    if (mesh.soup().lines.empty()) throw_no_sources(arguments.domain, "lines");
    sources = io::sources_from_lines(mesh.soup(), arguments.domain);
  }
  return session.flip ? sources.reversed() : sources;
}

/// One number for all or one for each file of surfaces, each vertex and then the boundary.
std::vector<double> tet_values(const DistanceArguments& arguments, const TetSources& sources) {
  if (arguments.values.empty()) return {};
  std::vector<double> values = parse_numbers("values", arguments.values);
  if (values.size() == 1) return values;
  const std::size_t n_named =
      arguments.sources.size() + sources.vertices.size() + std::size_t(sources.boundary);
  if (values.size() != n_named)
    throw InputError("option values: there are " + std::to_string(values.size()) + " numbers for " +
                         std::to_string(n_named) +
                         " sources; give one for all, or one for each file of --sources, each "
                         "--vertex and --boundary",
                     "sizes-differ");
  if (arguments.sources.empty()) return values;
  std::vector<double> of_elements;
  for (std::size_t i = 0; i < arguments.sources.size(); ++i) {
    const PolygonSoup surface = io::read_surface(arguments.sources[i]);
    of_elements.resize(
        of_elements.size() +
            std::size_t(surface.n_faces() > 0 ? surface.n_faces() : surface.n_vertices()),
        values[i]);
  }
  return of_elements;
}

TetSources gather(const DistanceArguments& arguments, const io::TetFile& file, Session& session) {
  TetSources sources;
  const NamedSources& named = arguments.named;
  if (!named.at.empty() || !named.faces.empty() || !named.edges.empty() || !named.curves.empty())
    throw InputError(
        "options --at, --face, --edge and --curve-vertices are for surfaces; tets take "
        "--vertex, --boundary and --sources",
        "options-conflict");
  sources.vertices =
      checked_vertices(named.vertices, file.mesh.n_vertices(), arguments.domain, session);
  sources.boundary = arguments.boundary;
  sources.surface = read_surfaces(arguments.sources);
  sources.flip = session.flip;
  if (sources.vertices.empty() && arguments.sources.empty() && !sources.boundary) {
    if (file.triangles.rows() == 0) throw_no_sources(arguments.domain, "triangles");
    sources.surface = triangles_of(file, file.triangles);
  }
  sources.values = tet_values(arguments, sources);
  return sources;
}

/// Files get a cloud's points without the triangles that show it.
PolygonSoup cloud_with(const PolygonSoup& shown, const SurfaceMesh& cloud) {
  PolygonSoup out = cloud.soup();
  out.scalars = shown.scalars;
  return out;
}

const VecX& values_of(const SurfaceAnswer& answer) { return answer.values; }
const VecX& values_of(const VecX& answer) { return answer; }

/// `read(file)` opens the domain, `domain(input)` makes it one of methods, `write` a file.
template <class D, class Read, class MakeDomain, class Write>
void measure(const DistanceArguments& arguments, const io::Kinds& outputs, Session& session,
             Read read, MakeDomain domain, Write write) {
  check_outputs(arguments.out, outputs);
  if (const auto given = arguments.method.options.find("confidence");
      given != arguments.method.options.end() && given->second != "off")
    for (const std::string& file : arguments.out) check_holds_confidence(file);
  const AnyMethod method = arguments.method.method();
  check_method<D>(method);
  const auto [input, sources] = [&] {
    const Stopwatch watch(session.report, "read");
    auto opened = read(arguments.domain);
    auto from = gather(arguments, *opened, session);
    return std::pair(std::move(opened), std::move(from));
  }();
  session.reading = false;
  const D on = domain(*input);
  if (planned(plan_on(method, on), session)) return;
  Task task = session.task();
  const auto answer =
      solve_once<D>(method, on, sources, task.stage(0.95, "distance"), session.report);
  session.record.values = {range_of("distance", values_of(answer))};
  finish(arguments.out, task.stage(0.05, "writing"), session,
         [&, &from = sources, &opened = input](const std::string& file) {
           write(file, *opened, from, answer);
         });
}

struct OpenedSurface : SurfaceInput {
  operator const SurfaceMesh&() const { return mesh; }
};

void measure_on_surface(const DistanceArguments& arguments, Session& session) {
  measure<SurfaceDomain>(
      arguments, surface_outputs, session,
      [](const std::string& file) {
        return std::make_shared<const OpenedSurface>(OpenedSurface{read_domain(file)});
      },
      [](const OpenedSurface& input) { return domain_of(input.mesh, input.normals()); },
      [&](const std::string& file, const SurfaceMesh& mesh, const Sources& sources,
          const SurfaceAnswer& answer) {
        const bool of_input = !answer.shown || io::is_written_as(file, {Kind::table});
        PolygonSoup result = of_input ? mesh.soup() : *answer.shown;
        if (of_input) {
          result.scalars = {{"distance", answer.values}};
          if (answer.confidence.size() > 0) result.scalars["confidence"] = answer.confidence;
        }
        if (mesh.n_faces() == 0 && io::is_written_as(file, {Kind::field}))
          result = cloud_with(result, mesh);
        write_result(file, result, "distance", arguments.domain, session.report,
                     [&](io::Scene& scene) {
                       io::add_sources(scene, mesh, sources);
                       if (mesh.n_faces() == 0) io::show_as_discs(scene);
                     });
      });
}

void measure_through_tets(const DistanceArguments& arguments, Session& session) {
  measure<TetDomain>(
      arguments, tet_outputs, session,
      [](const std::string& file) {
        return std::make_shared<const io::TetFile>(io::read_tets(file));
      },
      [](const io::TetFile& file) { return TetDomain{std::make_shared<const TetMesh>(file.mesh)}; },
      [&](const std::string& file, const io::TetFile& input, const TetSources&,
          const VecX& values) {
        write_tet_result(file, input.mesh, values, arguments.domain, session.report);
      });
}

}  // namespace

void add_distance(CLI::App& program, Session& session) {
  auto arguments = std::make_shared<DistanceArguments>();
  CLI::App& verb = add_verb(program, session, arguments, "distance",
                            "distance on a surface from curves and points on it, or through tets",
                            [](DistanceArguments& given, Session& s) {
                              const bool tets = io::holds(given.domain, Kind::tets);
                              (tets ? measure_through_tets : measure_on_surface)(given, s);
                            });
  add_input_option(verb, "DOMAIN", arguments->domain,
                   "the surface: " + kinds_help({Kind::surface, Kind::cloud, Kind::voxels}) +
                       "; or " + kinds_help({Kind::tets}));
  add_repeated_option(verb, "--sources,-s", arguments->sources,
                      "what distance is measured from: " + io::read_extensions({Kind::sources}) +
                          ", in tets any surface or cloud; may be repeated; without sources, "
                          "--vertex and --boundary, the lines of DOMAIN, or the triangles among "
                          "its tets")
      ->type_name("FILE");
  add_named_sources(verb, arguments->named);
  verb.add_flag("--boundary", arguments->boundary,
                "measure from the boundary of the surface or of the tets, without sign");
  verb.add_option("--values", arguments->values,
                  "of tets, what distance is counted from: one number, or one for each file of "
                  "--sources, each --vertex and then --boundary; on surfaces files of sources hold "
                  "them")
      ->type_name("C,...");
  add_output_option(verb, arguments->out,
                    "where to write: " + io::written_extensions(surface_outputs) + ", of tets " +
                        io::written_extensions({Kind::tets}) + ", too");
  add_methods(
      verb, arguments->method,
      joined(Registry<SurfaceDomain>::instance().infos(), Registry<TetDomain>::instance().infos()));
  verb.add_flag("--flip", session.flip, "reverse every signed curve: the other side is positive");
  add_index_option(verb, session);
  add_plan_option(verb, session);
  add_json_option(verb, session);
}

}  // namespace littoral::cli
