// littoral offset: dilated, eroded, opened and closed shapes, and curves on surfaces.

#include <algorithm>
#include <cmath>
#include <memory>

#include "api/space/isosurfaces.h"
#include "api/space/offset_quality.h"
#include "api/surface/level_lines.h"
#include "cli/input/method_options.h"
#include "cli/input/space_input.h"
#include "cli/input/surface_input.h"
#include "cli/output.h"
#include "cli/verbs/verbs.h"
#include "littoral/error.h"

namespace littoral::cli {

namespace {

struct OffsetArguments {
  std::string in, field;
  std::vector<std::string> sources, out;
  std::string distances, dilate, erode;
  Morphology morphology;
  bool clip = false;
  MethodArguments method;
  SpaceArguments space;
};

// --distance, then --dilate as they are, then --erode as negative; 0 for --open and --close alone.
std::vector<double> all_distances(const OffsetArguments& arguments) {
  std::vector<double> all;
  if (!arguments.distances.empty()) all = parse_numbers("distance", arguments.distances);
  for (const auto& [option, text, sign] :
       {std::tuple("dilate", &arguments.dilate, 1.0), {"erode", &arguments.erode, -1.0}}) {
    if (text->empty()) continue;
    for (const double radius : parse_numbers(option, *text)) {
      if (radius < 0)
        throw InputError(std::string("option ") + option + " takes no negative number");
      all.push_back(sign * radius);
    }
  }
  if (!all.empty()) return all;
  if (arguments.morphology.open > 0 || arguments.morphology.close > 0) return {0};
  throw InputError("no offset given: use --distance, --dilate, --erode, --open or --close");
}

void offset_curves(OffsetArguments& arguments, const std::vector<double>& distances,
                   Session& session) {
  check_level_outputs(arguments.out, distances.size(), {io::Kind::sources});
  const AnyMethod method = arguments.method.method();
  check_method<SurfaceDomain>(method);
  const SurfaceMesh mesh = read_mesh(arguments.in);
  Sources sources = read_all_sources(arguments.sources, mesh, session);
  if (session.flip) sources = sources.reversed();
  session.reading = false;
  Task task = session.task();
  const bool once = arguments.morphology.open == 0 && arguments.morphology.close == 0;
  const auto solver =
      prepare(method, domain_of(mesh), once ? SolveHint::single_rhs : SolveHint::many_rhs,
              task.stage(0.2, "preparing"), session.report);
  const auto levels = offset_lines(*solver, mesh, sources, distances, arguments.morphology,
                                   session.report, task.stage(0.75, "offsets"));
  task.checkpoint(1);
  write_lines(arguments.out, mesh, levels);
}

/// Signed distance, and the surfaces that it was measured from: the input and what completes it;
/// none where there are several shapes or points.
struct DistanceAround {
  Volume distance;
  PolygonSoup input, completion;
};

/// Around a shape or several, on a grid that holds all offsets of it; that of a volume alone is
/// there already.
DistanceAround distance_around(OffsetArguments& arguments, const std::vector<double>& distances,
                               Session& session) {
  SpaceArguments& space = arguments.space;
  space.input = arguments.in;
  space.field = arguments.field;
  space.method = arguments.method;
  CsgShapes shapes = read_shapes(space, session);
  if (shapes.all.size() == 1 && shapes.all.front().field)
    return {*shapes.all.front().field, {}, {}};
  double farthest = 0;
  for (const double d : distances) farthest = std::max(farthest, std::abs(d));
  const double reach = farthest + arguments.morphology.open + arguments.morphology.close;
  GridOptions grid = grid_request(space);
  grid.padding += reach / longest_side(shapes);
  DistanceAround around;
  around.distance.grid = choose_grid(shapes, grid);
  session.reading = false;
  SpaceAnswer answer = grid_answer(shapes, around.distance.grid, session.task(), session.report);
  around.distance.values = std::move(answer.at_nodes);
  around.completion = std::move(answer.completion);
  if (shapes.plain()) around.input = std::move(shapes.all.front().surface);
  return around;
}

void offset_shape(OffsetArguments& arguments, const std::vector<double>& distances,
                  Session& session) {
  check_level_outputs(arguments.out, distances.size(), {io::Kind::surface});
  const DistanceAround around = distance_around(arguments, distances, session);
  session.reading = false;
  Task task = session.task();
  const auto surfaces =
      offset_isosurfaces(around.distance, distances, arguments.morphology, arguments.clip,
                         session.report, task.stage(0.9, "offsets"));
  const bool once = arguments.morphology.open == 0 && arguments.morphology.close == 0;
  if (once && around.input.n_faces() > 0)
    for (const Isosurface& surface : surfaces)
      measure_offset(surface, around.input, around.completion, session.report,
                     task.stage(0.1 / static_cast<double>(surfaces.size()), "measuring offsets"));
  task.checkpoint(1);
  write_isosurfaces(arguments.out, surfaces);
}

void run_offset(OffsetArguments& arguments, Session& session) {
  const std::vector<double> distances = all_distances(arguments);
  if (arguments.sources.empty())
    offset_shape(arguments, distances, session);
  else
    offset_curves(arguments, distances, session);
  session.print_report();
}

void add_options(CLI::App& verb, OffsetArguments& arguments, Session& session) {
  add_input_option(verb, "INPUT", arguments.in,
                   "a mesh, soup or point cloud " +
                       io::read_extensions({io::Kind::surface, io::Kind::cloud}) +
                       ", a volume of signed distance " + io::read_extensions({io::Kind::volume}) +
                       ", or with --sources the surface the curves lie on");
  verb.add_option("--distance", arguments.distances,
                  "offsets, separated by commas; negative ones are inside [length]")
      ->type_name("D[,D...]");
  verb.add_option("--dilate", arguments.dilate, "offsets outward [length]")->type_name("R[,R...]");
  verb.add_option("--erode", arguments.erode, "offsets inward [length]")->type_name("R[,R...]");
  const auto radius = [](CLI::Option* option) {
    option->check(CLI::Range(0.0, 1e300).description(""))->type_name("R");
  };
  radius(verb.add_option("--open", arguments.morphology.open,
                         "first erode by R and dilate by R: thin parts go [length]"));
  radius(verb.add_option("--close", arguments.morphology.close,
                         "first (after --open) dilate by R and erode by R: gaps fill [length]"));
  verb.add_flag("--clip", arguments.clip, "close the surface flat where it meets the box");
  add_output_option(verb, arguments.out,
                    io::written_extensions({io::Kind::surface}) + ", lines " +
                        io::written_extensions({io::Kind::sources}) +
                        ": one file, or one for each distance");
  verb.add_option("--field", arguments.field, "which values of a volume [default: distance]")
      ->type_name("NAME");
  add_repeated_option(
      verb, "--sources,-s", arguments.sources,
      "curves on INPUT: " + io::read_extensions({io::Kind::sources}) + "; may be repeated")
      ->type_name("FILE");
  verb.add_option("--method", arguments.method.name,
                  "of `littoral sdf`, or for curves of `littoral distance` [default: as there]")
      ->type_name("NAME");
  verb.add_flag("--flip", session.flip, "reverse every signed curve, or all normals");
  verb.add_flag("--estimate-normals", arguments.space.estimate_normals,
                "of a point cloud: compute normals from neighbouring points");
  add_grid_options(verb, arguments.space);
  add_shape_options(verb, arguments.space, false);
  const auto& on_surfaces = Registry<SurfaceDomain>::instance();
  add_method_options(verb, arguments.method.options,
                     joined(Registry<SpaceDomain>::instance().infos(),
                            {on_surfaces.find(Automatic::method)->info,
                             on_surfaces.find(SignedHeat::method)->info}));
  add_index_option(verb, session);
  add_json_option(verb, session);
}

}  // namespace

void add_offset(CLI::App& program, Session& session) {
  auto arguments = std::make_shared<OffsetArguments>();
  add_options(add_verb(program, session, arguments, "offset",
                       "offset surfaces and curves; dilate, erode, open and close", run_offset),
              *arguments, session);
}

}  // namespace littoral::cli
