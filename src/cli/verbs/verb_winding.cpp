// littoral winding: which regions curves bound on a surface, and which curves bound nothing.

#include <memory>

#include "api/surface/winding.h"
#include "cli/input/method_options.h"
#include "cli/input/query_points.h"
#include "cli/input/space_input.h"
#include "cli/input/surface_input.h"
#include "cli/output.h"
#include "cli/plan/plan.h"
#include "cli/verbs/verbs.h"
#include "io/read.h"
#include "io/surface/write_winding.h"
#include "littoral/error.h"

namespace littoral::cli {

namespace {

using io::Kind;

const io::Kinds region_outputs = {Kind::field, Kind::page, Kind::picture};

struct WindingArguments {
  std::string domain, curves, smoothing, show = "region";
  std::vector<std::string> sources, out;
  QueryPoints points;
  NamedSources named;
  MethodArguments method;
};

void write_regions(const std::string& file, const WindingArguments& arguments,
                   const WindingAnswer& answer, const Report& report) {
  if (io::is_written_as(file, {Kind::table}))
    return io::write_table(file, {{"region"}, answer.region.cast<double>(), "face"});
  if (io::has_extension(file, ".obj"))
    return io::write_homogeneous_obj(file, answer.shown, "winding", "weight");
  write_result(file, answer.shown, arguments.show, arguments.domain, report, [&](io::Scene& scene) {
    scene.isolines = 0;
    for (const MatX3& line : answer.bounding) scene.curves.push_back({line, true});
    for (const MatX3& line : answer.nonbounding) scene.curves.push_back({line, false});
  });
}

/// Winding numbers of a mesh, soup or cloud at points in space.
void run_at_points(const WindingArguments& arguments, Session& session) {
  if (!arguments.sources.empty() || !arguments.named.empty() || !arguments.curves.empty() ||
      !arguments.method.options.empty())
    throw InputError("winding numbers at points in space take no sources, no curves and no options",
                     "options-conflict");
  check_outputs(arguments.out, query_outputs);
  SpaceRequest request;
  request.flip = session.flip;
  const PolygonSoup input = io::read_surface(arguments.domain);
  const io::PointTable queries = read_queries(arguments.points);
  session.reading = false;
  const double smoothing = parse_radius("smoothing", arguments.smoothing,
                                        [&] { return bounding_box(input).size().maxCoeff(); });
  const VecX values =
      query_winding(input, queries.points, request, session.task(), session.report, smoothing);
  session.record.values = {range_of("winding", values)};
  finish(arguments.out, session.task(), session, [&](const std::string& file) {
    write_at_points(file, queries, {{"winding"}, values});
  });
}

void run_winding(WindingArguments& arguments, Session& session) {
  if (!arguments.points.empty()) {
    run_at_points(arguments, session);
    return;
  }
  if (!arguments.smoothing.empty())
    throw InputError("option smoothing goes with option points or option at", "options-conflict");
  check_outputs(arguments.out, region_outputs);
  if (!arguments.curves.empty() && !io::has_extension(arguments.curves, ".obj"))
    throw InputError("cannot write " + arguments.curves + " as named lines; possible: .obj",
                     "cannot-write");
  if (!arguments.curves.empty()) check_outputs({arguments.curves}, {Kind::surface});
  const AnyMethod method = arguments.method.method();
  check_method<WindingDomain>(method);
  const auto mesh = std::make_shared<const SurfaceMesh>(read_mesh(arguments.domain));
  Sources sources = read_all_sources(arguments.sources, *mesh, session);
  sources.add(named_sources(arguments.named, *mesh, arguments.domain, session));
  if (sources.empty() && !mesh->soup().lines.empty())
    sources = io::sources_from_lines(mesh->soup(), arguments.domain);
  if (sources.empty())
    throw InputError("no curves given: use option sources or option curve-vertices (" +
                         arguments.domain + " has no lines of its own)",
                     "nothing-given");
  session.reading = false;
  if (session.flip) sources = sources.reversed();
  RunPlan plan = plan_on(AnyMethod(), domain_of(*mesh));
  plan.methods = Registry<WindingDomain>::instance().infos();
  if (planned(plan, session)) return;
  const WindingAnswer answer =
      solve_once<WindingDomain>(method, {mesh}, sources, session.task(), session.report);
  session.record.values = {range_of("region", answer.region.cast<double>())};
  if (!arguments.curves.empty())
    io::write_polylines(arguments.curves, {{"bounding", &answer.bounding},
                                           {"nonbounding", &answer.nonbounding},
                                           {"completed", &answer.completed}});
  finish(arguments.out, session.task(), session,
         [&](const std::string& file) { write_regions(file, arguments, answer, session.report); });
}

}  // namespace

void add_winding(CLI::App& program, Session& session) {
  auto arguments = std::make_shared<WindingArguments>();
  CLI::App& verb = add_verb(
      program, session, arguments, "winding",
      "regions that curves bound on a triangle mesh, and curves that bound nothing", run_winding);
  add_input_option(verb, "DOMAIN", arguments->domain,
                   kinds_help({Kind::surface}) +
                       ", or with --points or --at a mesh, soup or cloud in space: " +
                       io::read_extensions({Kind::surface, Kind::cloud}));
  add_repeated_option(verb, "--sources,-s", arguments->sources,
                      "signed curves: " + io::read_extensions({Kind::sources}) +
                          "; may be repeated; without, the lines of DOMAIN")
      ->type_name("FILE");
  add_named_curves(verb, arguments->named);
  add_query_points(
      verb, arguments->points,
      "winding numbers in space, to " + io::written_extensions(query_outputs) + ", at: ");
  add_smoothing_option(verb, arguments->smoothing, "with --points or --at");
  add_output_option(verb, arguments->out,
                    "where to write: " + io::written_extensions(region_outputs) +
                        "; tables have labels of faces, .obj homogeneous texture coordinates, "
                        "others values at vertices");
  verb.add_option("--curves", arguments->curves,
                  "where to write the bounding, nonbounding and completed curves: .obj")
      ->type_name("OUT");
  verb.add_option("--show", arguments->show,
                  "what pages, pictures and .vtp show: region or winding")
      ->check(one_of({"region", "winding"}))
      ->type_name("WORD");
  verb.add_flag("--flip", session.flip, "reverse every curve, or the surface");
  add_method_options(verb, arguments->method.options, Registry<WindingDomain>::instance().infos());
  add_index_option(verb, session);
  add_plan_option(verb, session);
  add_json_option(verb, session);
}

}  // namespace littoral::cli
