// littoral winding: which regions curves bound on a surface, and which curves bound nothing.

#include <memory>

#include "api/surface/winding.h"
#include "cli/input/method_options.h"
#include "cli/input/space_input.h"
#include "cli/input/surface_input.h"
#include "cli/verbs/verbs.h"
#include "io/read.h"
#include "io/render/picture.h"
#include "io/render/scene.h"
#include "io/surface/write_winding.h"
#include "io/write.h"
#include "littoral/error.h"

namespace littoral::cli {

namespace {

const std::vector<std::string> outputs = {".ply", ".obj", ".vtp",  ".csv",
                                          ".npy", ".txt", ".html", ".png"};

struct Arguments {
  std::string domain, points, curves, show = "region";
  std::vector<std::string> sources, out;
  MethodArguments method{SurfaceWinding::method, {}};
};

io::Scene scene_of(const Arguments& arguments, const WindingAnswer& answer, const Report& report) {
  io::Scene scene = io::make_scene(answer.shown, arguments.show);
  scene.isolines = 0;
  for (const MatX3& line : answer.bounding) scene.curves.push_back({line, true});
  for (const MatX3& line : answer.nonbounding) scene.curves.push_back({line, false});
  scene.title = std::filesystem::path(arguments.domain).stem().string();
  scene.facts = {{"method", report.method}, {"domain", report.domain}};
  for (const auto& option : report.options) scene.facts.push_back(option);
  for (const auto& warning : report.warnings) scene.facts.emplace_back("warning", warning);
  return scene;
}

void write_results(const Arguments& arguments, const WindingAnswer& answer, Session& session) {
  const Task task = session.task();
  for (const std::string& file : arguments.out) {
    task.checkpoint();
    const std::string extension = extension_of(file);
    if (extension == ".txt" || extension == ".csv" || extension == ".npy")
      io::write_labels(file, answer.region);
    else if (extension == ".obj")
      io::write_homogeneous_obj(file, answer.shown, "winding", "weight");
    else if (extension == ".html")
      io::write_page(file, scene_of(arguments, answer, session.report));
    else if (extension == ".png")
      io::write_picture(file, scene_of(arguments, answer, session.report));
    else
      io::write_field(file, answer.shown, arguments.show);
  }
  if (!arguments.curves.empty())
    io::write_polylines(arguments.curves, {{"bounding", &answer.bounding},
                                           {"nonbounding", &answer.nonbounding},
                                           {"completed", &answer.completed}});
}

/// Winding numbers of a mesh, soup or cloud at points in space.
void run_at_points(const Arguments& arguments, Session& session) {
  if (!arguments.sources.empty() || !arguments.curves.empty() || !arguments.method.options.empty())
    throw InputError(
        "option --points: winding numbers in space take no --sources, no --curves and no options");
  for (const std::string& file : arguments.out)
    check_output(file, {".csv", ".txt", ".npy", ".ply"}, "values at points");
  SpaceRequest request;
  request.flip = session.flip;
  const PolygonSoup input = io::read_surface(arguments.domain);
  const MatX3 queries = read_queries(arguments.points);
  session.reading = false;
  const VecX values = query_winding(input, queries, request, session.task(), session.report);
  write_query_table(arguments.out, queries, {{"winding"}, values});
  session.print_report();
}

void run(const Arguments& arguments, Session& session) {
  if (!arguments.points.empty()) {
    run_at_points(arguments, session);
    return;
  }
  for (const std::string& file : arguments.out) check_output(file, outputs, "winding numbers");
  if (!arguments.curves.empty()) check_output(arguments.curves, {".obj"}, "curves");
  const AnyMethod method = arguments.method.method();
  check_method<WindingDomain>(method);
  const auto mesh = std::make_shared<const SurfaceMesh>(read_mesh(arguments.domain));
  Sources sources = read_all_sources(arguments.sources, *mesh, session);
  if (sources.empty() && !mesh->soup().lines.empty())
    sources = io::sources_from_lines(mesh->soup(), arguments.domain);
  if (sources.empty())
    throw InputError("no curves given: use --sources FILE (" + arguments.domain +
                     " has no lines of its own)");
  session.reading = false;
  if (session.flip) sources = sources.reversed();
  const WindingAnswer answer =
      solve_once<WindingDomain>(method, {mesh}, sources, session.task(), session.report);
  write_results(arguments, answer, session);
  session.print_report();
}

}  // namespace

void add_winding(CLI::App& program, Session& session) {
  CLI::App* verb = program.add_subcommand(
      "winding", "regions that curves bound on a triangle mesh, and curves that bound nothing");
  auto arguments = std::make_shared<Arguments>();
  verb->add_option(
          "DOMAIN", arguments->domain,
          "the surface, or with --points a mesh, soup or cloud in space: .obj .ply .off .stl .pc "
          ".xyz .pcd")
      ->required()
      ->type_name("");
  verb->add_option("--sources,-s", arguments->sources,
                   "signed curves: .txt .json .obj .ply; may be repeated; without, the lines of "
                   "DOMAIN")
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->type_name("FILE");
  verb->add_option("--points", arguments->points,
                   "winding numbers in space, here: the vertices of any surface or cloud file, or "
                   ".csv or .txt with x, y, z first; to .csv .txt .npy .ply")
      ->type_name("FILE");
  verb->add_option("-o,--output", arguments->out,
                   "where to write: .ply .vtp (values at vertices), .obj (homogeneous texture "
                   "coordinates), .txt .csv .npy (labels of faces), .html .png; may be repeated")
      ->required()
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->type_name("OUT");
  verb->add_option("--curves", arguments->curves,
                   "where to write the bounding, nonbounding and completed curves: .obj")
      ->type_name("FILE");
  verb->add_option("--show", arguments->show, "what .html, .png and .vtp show: region or winding")
      ->check(CLI::IsMember({"region", "winding"}))
      ->type_name("WORD");
  verb->add_flag("--flip", session.flip, "reverse every curve, or the surface");
  add_method_options(*verb, arguments->method.options, Registry<WindingDomain>::instance().infos());
  add_index_option(*verb, session);
  add_json_option(*verb, session);
  add_common_options(*verb, session);
  verb->callback(
      [arguments, &session] { session.job = [arguments, &session] { run(*arguments, session); }; });
}

}  // namespace littoral::cli
