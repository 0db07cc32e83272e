// littoral distance: distance on a surface from curves and points on it.

#include <memory>

#include "api/surface/surface_domain.h"
#include "api/tet/tet_domain.h"
#include "base/stopwatch.h"
#include "cli/input/method_options.h"
#include "cli/input/surface_input.h"
#include "cli/input/tet_input.h"
#include "cli/verbs/verbs.h"
#include "io/read.h"
#include "io/render/picture.h"
#include "io/render/scene.h"
#include "io/write.h"
#include "littoral/error.h"
#include "sources/boundary_curves.h"

namespace littoral::cli {

namespace {

const std::vector<std::string> outputs = {".ply", ".obj", ".vtp",  ".csv",
                                          ".npy", ".txt", ".html", ".png"};

struct Arguments {
  std::string domain;
  std::vector<std::string> sources, out;
  std::vector<long long> vertices;
  bool boundary = false;
  MethodArguments method;
};

Sources gather_sources(const Arguments& arguments, const SurfaceMesh& mesh, Session& session) {
  Sources sources = read_all_sources(arguments.sources, mesh, session);
  for (int v : checked_vertices(arguments.vertices, mesh.n_vertices(), arguments.domain, session))
    sources.points.push_back(SurfacePoint::at_vertex(v));
  if (arguments.boundary) {
    const std::vector<Curve> loops = boundary_curves(mesh);
    if (loops.empty())
      throw InputError("option --boundary: " + arguments.domain + " has no boundary");
    sources.curves.insert(sources.curves.end(), loops.begin(), loops.end());
  }
  if (!sources.empty()) return sources;
  if (!mesh.soup().lines.empty()) return io::sources_from_lines(mesh.soup(), arguments.domain);
  throw InputError(
      "nothing to measure distance from: name --sources FILE, --vertex I or --boundary (" +
      arguments.domain + " has no lines of its own)");
}

/// Files get a cloud's points without the triangles that show it.
PolygonSoup cloud_with(const PolygonSoup& shown, const SurfaceMesh& cloud) {
  PolygonSoup out = cloud.soup();
  out.scalars = shown.scalars;
  return out;
}

void write_results(const Arguments& arguments, const SurfaceMesh& mesh, const Sources& sources,
                   SurfaceAnswer answer, const Task& task, Session& session) {
  PolygonSoup result = answer.shown ? std::move(*answer.shown) : mesh.soup();
  if (!answer.shown) {
    result.scalars.clear();
    result.scalars["distance"] = std::move(answer.values);
  }
  double written = 0;
  for (const std::string& file : arguments.out) {
    task.checkpoint(written++ / static_cast<double>(arguments.out.size()));
    const std::string extension = extension_of(file);
    if (extension != ".html" && extension != ".png") {
      io::write_field(file, mesh.n_faces() ? result : cloud_with(result, mesh));
      continue;
    }
    io::Scene scene = io::make_scene(result);
    io::add_sources(scene, mesh, sources);
    scene.title = std::filesystem::path(arguments.domain).stem().string();
    scene.facts = {{"method", session.report.method},
                   {"domain", session.report.domain},
                   {"vertices", std::to_string(mesh.n_vertices())},
                   {"faces", std::to_string(mesh.n_faces())}};
    for (const auto& option : session.report.options) scene.facts.push_back(option);
    double seconds = 0;
    for (const auto& [stage, time] : session.report.timings) seconds += time;
    char text[32];
    std::snprintf(text, sizeof text, "%.2f s", seconds);
    scene.facts.emplace_back("time", text);
    for (const auto& warning : session.report.warnings)
      scene.facts.emplace_back("warning", warning);
    extension == ".html" ? io::write_page(file, scene) : io::write_picture(file, scene);
  }
}

void run(Arguments& arguments, Session& session) {
  if (io::is_tets(arguments.domain))
    return distance_through_tets({arguments.domain, arguments.method.method(), arguments.sources,
                                  arguments.out, arguments.vertices, arguments.boundary},
                                 session);
  for (const std::string& file : arguments.out) check_output(file, outputs, "a field on a surface");
  const AnyMethod method = arguments.method.method();
  check_method<SurfaceDomain>(method);
  Report& report = session.report;
  const auto [domain, sources] = [&] {
    const Stopwatch watch(report, "read");
    auto read = std::make_shared<const SurfaceInput>(read_domain(arguments.domain));
    Sources given = gather_sources(arguments, read->mesh, session);
    return std::pair(read, session.flip ? given.reversed() : std::move(given));
  }();
  const SurfaceMesh& mesh = domain->mesh;
  session.reading = false;
  Task task = session.task();
  SurfaceAnswer answer = solve_once<SurfaceDomain>(method, domain_of(mesh, domain->normals()),
                                                   sources, task.stage(0.95, "distance"), report);
  {
    const Stopwatch watch(report, "write");
    write_results(arguments, mesh, sources, std::move(answer), task.stage(0.05, "writing"),
                  session);
  }
  session.print_report();
}

}  // namespace

void add_distance(CLI::App& program, Session& session) {
  CLI::App* verb = program.add_subcommand("distance",
                                          "distance on a surface from curves and points on it, or "
                                          "through tets");
  auto arguments = std::make_shared<Arguments>();
  verb->add_option("DOMAIN", arguments->domain,
                   "the surface: mesh .obj .ply .off .stl, point cloud .pc .xyz .pcd .ply, "
                   "voxels .vol .npy .nrrd .vti; or tets .mesh .vtk .tet")
      ->required()
      ->type_name("");
  add_repeated_option(*verb, "--sources,-s", arguments->sources,
                      "what distance is measured from: .txt .json .obj .ply, in tets any surface "
                      "or cloud; may be repeated; without sources, --vertex and --boundary, the "
                      "lines of DOMAIN, or the triangles among its tets")
      ->type_name("FILE");
  add_repeated_option(*verb, "--vertex", arguments->vertices,
                      "a source vertex, from 0; may be repeated")
      ->type_name("I");
  verb->add_flag("--boundary", arguments->boundary,
                 "measure from the boundary of the surface or of the tets, without sign");
  add_output_option(
      *verb, arguments->out,
      "where to write: .ply .obj .vtp .csv .npy .txt .html .png, of tets .vtk .vtu, too");
  add_methods(
      *verb, arguments->method,
      joined(Registry<SurfaceDomain>::instance().infos(), Registry<TetDomain>::instance().infos()));
  verb->add_flag("--flip", session.flip, "reverse every signed curve: the other side is positive");
  add_index_option(*verb, session);
  add_json_option(*verb, session);
  add_common_options(*verb, session);
  verb->callback(
      [arguments, &session] { session.job = [arguments, &session] { run(*arguments, session); }; });
}

}  // namespace littoral::cli
