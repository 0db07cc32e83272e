// littoral offset: dilated, eroded, opened and closed shapes, and curves on surfaces.

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "api/space/isosurfaces.h"
#include "api/space/offset_quality.h"
#include "api/surface/level_lines.h"
#include "base/option_table.h"
#include "cli/input/method_options.h"
#include "cli/input/space_input.h"
#include "cli/input/surface_input.h"
#include "cli/output.h"
#include "cli/plan/plan.h"
#include "cli/verbs/verbs.h"
#include "littoral/error.h"

namespace littoral::cli {

namespace {

struct OffsetArguments {
  std::string in, field;
  std::vector<std::string> sources, out;
  NamedSources named;
  std::string distances, dilate, erode, open, close, wall;
  bool clip = false;
  MethodArguments method;
  SpaceArguments space;
};

/// What was asked for, in the unit of the input.
struct OffsetLengths {
  std::vector<double> distances;
  Morphology morphology;
  double wall = 0;  // thickness
  bool plain() const { return morphology.open == 0 && morphology.close == 0 && wall == 0; }
};

// --distance, then --dilate as they are, then --erode as negative; 0 where only other things are
// asked for.
OffsetLengths lengths_of(const OffsetArguments& arguments, const InputSize& size) {
  OffsetLengths all;
  all.morphology.open = parse_radius("open", arguments.open, size);
  all.morphology.close = parse_radius("close", arguments.close, size);
  all.wall = parse_radius("shell", arguments.wall, size);
  if (!arguments.wall.empty() && all.wall == 0)
    throw InputError("option shell takes a positive thickness", "option-value");
  if (!arguments.distances.empty())
    all.distances = parse_lengths("distance", arguments.distances, size);
  for (const auto& [option, text, sign] :
       {std::tuple("dilate", &arguments.dilate, 1.0), {"erode", &arguments.erode, -1.0}}) {
    if (text->empty()) continue;
    for (const double radius : parse_lengths(option, *text, size)) {
      if (radius < 0)
        throw InputError(std::string("option ") + option + " takes no negative number",
                         "option-value");
      all.distances.push_back(sign * radius);
    }
  }
  if (!all.distances.empty()) return all;
  if (all.plain())
    throw InputError(
        "no offset given: use --distance, --dilate, --erode, --shell, --open or --close",
        "nothing-given");
  all.distances = {0};
  return all;
}

void offset_curves(OffsetArguments& arguments, std::size_t count, Session& session) {
  if (!arguments.wall.empty())
    throw InputError("option shell is for shapes in space", "options-conflict");
  if (!arguments.space.values.empty())
    throw InputError(
        "option values is for shapes in space; files of --sources hold the values of curves",
        "options-conflict");
  check_level_outputs(arguments.out, count, {io::Kind::sources});
  const AnyMethod method = arguments.method.method();
  check_method<SurfaceDomain>(method);
  const SurfaceMesh mesh = read_mesh(arguments.in);
  const OffsetLengths lengths =
      lengths_of(arguments, [&] { return bounding_box(mesh.soup()).size().maxCoeff(); });
  Sources sources = read_all_sources(arguments.sources, mesh, session);
  sources.add(named_sources(arguments.named, mesh, arguments.in, session));
  if (session.flip) sources = sources.reversed();
  session.reading = false;
  const SurfaceDomain domain = domain_of(mesh);
  RunPlan plan = plan_on(method, domain);
  plan.like = "distance";
  if (planned(plan, session)) return;
  Task task = session.task();
  const auto solver =
      prepare(method, domain, lengths.plain() ? SolveHint::single_rhs : SolveHint::many_rhs,
              task.stage(0.2, "preparing"), session.report);
  const auto levels = offset_lines(*solver, mesh, sources, lengths.distances, lengths.morphology,
                                   session.report, task.stage(0.75, "offsets"));
  task.checkpoint(1);
  write_lines(arguments.out, mesh, levels);
}

/// Signed distance, and the surfaces that it was measured from: the input and what completes it;
/// none where there are several shapes or points, or values that distance is counted from.
struct DistanceAround {
  Volume distance;
  PolygonSoup input, completion;
  std::shared_ptr<const PointwiseDistance> exact;  // what was sampled, where it is known
  OffsetLengths lengths;
};

bool planned_as_sdf(const CsgShapes& shapes, const Grid& grid, Session& session) {
  RunPlan plan = plan_in_space(shapes, grid, session.dry_run);
  plan.like = "sdf";
  return planned(plan, session);
}

/// Around a shape or several, on a grid that holds all offsets of it; that of a volume alone is
/// there already.
/// None where only the plan was asked for.
std::optional<DistanceAround> distance_around(OffsetArguments& arguments, Session& session) {
  SpaceArguments& space = arguments.space;
  space.input = arguments.in;
  space.field = arguments.field;
  space.method = arguments.method;
  CsgShapes shapes = read_shapes(space, session);
  const InputSize size = [&] { return longest_side(shapes); };
  const OffsetLengths lengths = lengths_of(arguments, size);
  if (shapes.all.size() == 1 && shapes.all.front().field)
    return planned_as_sdf(shapes, shapes.all.front().field->grid, session)
               ? std::nullopt
               : std::optional(DistanceAround{*shapes.all.front().field, {}, {}, {}, lengths});
  double farthest = 0;
  for (const double d : lengths.distances) farthest = std::max(farthest, std::abs(d));
  const double reach =
      farthest + lengths.wall / 2 + lengths.morphology.open + lengths.morphology.close;
  GridOptions grid = grid_request(space, size);
  constexpr double farthest_reach = 900;  // longest sides
  if (!(reach <= farthest_reach * longest_side(shapes)))
    throw InputError("the offsets reach " + rounded_text(reach) + " from an input of size " +
                         rounded_text(longest_side(shapes)) + ": more than " +
                         rounded_text(farthest_reach) +
                         " times its size is not computed. Are they in its unit?",
                     "option-value");
  grid.padding += reach / longest_side(shapes);
  DistanceAround around;
  around.lengths = lengths;
  around.distance.grid = choose_grid(shapes, grid);
  session.reading = false;
  if (planned_as_sdf(shapes, around.distance.grid, session)) return {};
  SpaceAnswer answer = grid_answer(shapes, around.distance.grid, session.task(), session.report);
  around.distance.values = std::move(answer.at_nodes);
  around.completion = std::move(answer.completion);
  around.exact = std::move(answer.function);
  if (shapes.plain() && shapes.all.front().request.values.empty())
    around.input = std::move(shapes.all.front().surface);
  return around;
}

void offset_shape(OffsetArguments& arguments, std::size_t count, Session& session) {
  check_level_outputs(arguments.out, count, {io::Kind::surface});
  const std::optional<DistanceAround> measured = distance_around(arguments, session);
  if (!measured) return;
  const DistanceAround& around = *measured;
  const OffsetLengths& lengths = around.lengths;
  session.record.grid = around.distance.grid;
  session.reading = false;
  Task task = session.task();
  if (lengths.wall > 0) {
    write_isosurfaces(
        arguments.out,
        wall_isosurfaces(around.distance, lengths.distances, lengths.wall, lengths.morphology,
                         arguments.clip, session.report, task, around.exact.get()));
    return;
  }
  const auto surfaces =
      offset_isosurfaces(around.distance, lengths.distances, lengths.morphology, arguments.clip,
                         session.report, task.stage(0.9, "offsets"), around.exact.get());
  if (lengths.plain() && around.input.n_faces() > 0)
    for (const Isosurface& surface : surfaces)
      measure_offset(surface, around.input, around.completion, session.report,
                     task.stage(0.1 / static_cast<double>(surfaces.size()), "measuring offsets"));
  task.checkpoint(1);
  write_isosurfaces(arguments.out, surfaces);
}

void run_offset(OffsetArguments& arguments, Session& session) {
  const std::size_t count = lengths_of(arguments, [] { return 1.0; }).distances.size();
  if (arguments.sources.empty() && arguments.named.empty())
    offset_shape(arguments, count, session);
  else
    offset_curves(arguments, count, session);
  if (!session.dry_run) session.print_report();
}

void add_options(CLI::App& verb, OffsetArguments& arguments, Session& session) {
  add_input_option(verb, "INPUT", arguments.in,
                   "a mesh, soup or point cloud " +
                       io::read_extensions({io::Kind::surface, io::Kind::cloud}) +
                       ", a volume of signed distance " + io::read_extensions({io::Kind::volume}) +
                       ", or with --sources the surface the curves lie on");
  const std::string unit = std::string(" [") + length_unit_text + "]";
  verb.add_option("--distance", arguments.distances,
                  "offsets, separated by commas; negative ones are inside" + unit)
      ->type_name("D[,D...]");
  verb.add_option("--dilate", arguments.dilate, "offsets outward" + unit)->type_name("R[,R...]");
  verb.add_option("--erode", arguments.erode, "offsets inward" + unit)->type_name("R[,R...]");
  verb.add_option("--shell", arguments.wall,
                  "a closed wall of this thickness, half of it on either side of each offset "
                  "(without any, of the surface): the inner side is reversed" +
                      unit)
      ->type_name("T");
  verb.add_option("--open", arguments.open,
                  "first erode by R and dilate by R: thin parts go" + unit)
      ->type_name("R");
  verb.add_option("--close", arguments.close,
                  "first (after --open) dilate by R and erode by R: gaps fill" + unit)
      ->type_name("R");
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
  add_named_curves(verb, arguments.named);
  verb.add_option("--method", arguments.method.name,
                  "of `littoral sdf`, or for curves of `littoral distance` [default: as there]")
      ->type_name("NAME");
  verb.add_flag("--flip", session.flip, "reverse every signed curve, or all normals");
  verb.add_flag("--estimate-normals", arguments.space.estimate_normals,
                "of a point cloud: compute normals from neighbouring points");
  add_values_option(verb, arguments.space);
  add_grid_options(verb, arguments.space);
  add_shape_options(verb, arguments.space, false);
  const auto& on_surfaces = Registry<SurfaceDomain>::instance();
  add_method_options(verb, arguments.method.options,
                     joined(Registry<SpaceDomain>::instance().infos(),
                            {on_surfaces.find(Automatic::method)->info,
                             on_surfaces.find(SignedHeat::method)->info}));
  add_index_option(verb, session);
  add_plan_option(verb, session);
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
