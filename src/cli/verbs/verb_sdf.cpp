// littoral sdf: signed distance in space around a mesh, soup or point cloud.

#include <memory>

#include "api/space/isosurfaces.h"
#include "cli/input/numbers.h"
#include "cli/input/space_input.h"
#include "cli/output.h"
#include "cli/plan/plan.h"
#include "cli/verbs/verbs.h"
#include "contour/isosurface.h"
#include "io/render/scene_style.h"
#include "io/render/volume_scene.h"
#include "io/volume/volume.h"
#include "littoral/error.h"
#include "spatial/grid_values.h"

namespace littoral::cli {

namespace {

using io::Kind;

const io::Kinds space_outputs = {Kind::volume, Kind::tets, Kind::surface, Kind::page,
                                 Kind::picture};

struct SdfArguments {
  SpaceArguments space;
  std::string levels, field = "distance", smoothing;
  std::vector<double> level_values;
  std::vector<std::string> out;
  double band = 0;
  bool clip = false, confidence = false;
  std::string domain = "grid";
  std::string tets = "lattice";
  TetFilling tetgen;
};

/// Winding numbers fall outward, so that their negatives have surfaces that face outward.
std::vector<Isosurface> winding_surfaces(Volume volume, std::vector<double> levels, bool clip,
                                         Session& session) {
  volume.values = -volume.values;
  for (double& level : levels) level = -level;
  std::vector<Isosurface> surfaces =
      isosurfaces(volume, levels, clip, session.report, session.task());
  for (Isosurface& surface : surfaces) surface.level = -surface.level;
  return surfaces;
}

std::vector<Isosurface> isosurfaces_of(const Volume& volume, const TetField& tets,
                                       const std::vector<double>& levels, bool clip,
                                       Session& session) {
  if (tets.mesh.n_tets() == 0)
    return isosurfaces(volume, levels, clip, session.report, session.task());
  std::vector<Isosurface> surfaces;
  for (const double level : levels)
    surfaces.push_back(
        {level, isosurface(tets.mesh, tets.values, level, session.report, session.task())});
  return surfaces;
}

/// The vertices of a surface with the confidence there.
void add_confidence(std::vector<Isosurface>& surfaces, const CsgShapes& shapes, Session& session) {
  for (Isosurface& each : surfaces)
    each.surface.scalars["confidence"] = confidence_at(shapes, each.surface.points, session);
}

void write_distance(const std::string& file, const SdfArguments& arguments, const CsgShapes& shapes,
                    const Volume& volume, const TetField& tets, Session& session) {
  const std::vector<double> levels = arguments.level_values;
  const std::string& input = arguments.space.input;
  if (io::is_written_as(file, {Kind::volume})) {
    io::VolumeWriteOptions options{.band = arguments.band};
    if (arguments.confidence)
      options.more.emplace_back("confidence",
                                confidence_at(shapes, grid_points(volume.grid), session));
    return io::write_volume(file, volume, options);
  }
  if (io::is_written_as(file, {Kind::tets}))
    return write_tet_result(file, tets.mesh, tets.values, input, session.report);
  if (io::is_written_as(file, {Kind::surface})) {
    auto surfaces = arguments.field == "winding"
                        ? winding_surfaces(volume, levels, arguments.clip, session)
                        : isosurfaces_of(volume, tets, levels, arguments.clip, session);
    if (arguments.confidence) add_confidence(surfaces, shapes, session);
    return write_isosurfaces({file}, surfaces);
  }
  io::VolumeView view;
  view.level = levels.front();
  io::Scene scene = io::make_volume_scene(volume, view);
  keep_upright(scene, input);
  if (const Box box = bounding_box(shapes); !scene.up && io::upright_axis(box.low, box.high)[2] > 0)
    scene.up = Vec3::UnitZ();  // of the input: the grid about it stands nowhere
  io::describe(scene, title_of(input), session.report);
  io::write_scene(file, scene);
}

void check_field(const SdfArguments& arguments) {
  if (arguments.field == "winding" && arguments.domain == "tets")
    throw UnsupportedError("option field winding is for grids", "options-conflict");
  if (arguments.field != "winding" && !arguments.smoothing.empty())
    throw InputError("option smoothing goes with --field winding", "options-conflict");
}

void check_confidence(const std::string& file) {
  if (!io::is_written_as(file, {Kind::volume})) return check_holds_confidence(file);
  if (!io::format_to_write(file, {Kind::volume}).more_values)
    throw InputError(file +
                         " holds one number per node: confidence is written to VTK image data, "
                         "and with the surface at --level to formats with numbers at vertices",
                     "options-conflict");
}

void run_sdf(SdfArguments& arguments, Session& session) {
  check_outputs(arguments.out, space_outputs);
  for (const std::string& file : arguments.out)
    if (arguments.domain != "tets" && io::is_written_as(file, {Kind::tets}))
      throw InputError(file + " holds tets: they are there with --domain tets", "options-conflict");
  for (const std::string& file : arguments.out)
    if (arguments.confidence) check_confidence(file);
  if (arguments.tets != "lattice" && arguments.domain != "tets")
    throw InputError("option tets goes with --domain tets", "options-conflict");
  if (arguments.clip && arguments.domain == "tets")
    throw UnsupportedError("option clip is for grids: the cube of the tets is larger than the box",
                           "options-conflict");
  if (arguments.field != "winding" && !arguments.levels.empty())
    check_lengths("level", arguments.levels);
  check_field(arguments);
  const CsgShapes shapes = read_shapes(arguments.space, session);
  const InputSize size = [&] { return longest_side(shapes); };
  if (arguments.levels.empty()) arguments.levels = arguments.field == "winding" ? "0.5" : "0";
  arguments.level_values = arguments.field == "winding"
                               ? parse_numbers("level", arguments.levels)
                               : parse_lengths("level", arguments.levels, size);
  Volume volume;
  volume.grid = choose_grid(shapes, grid_request(arguments.space, size));
  session.reading = false;
  if (planned(plan_in_space(shapes, volume.grid, session.dry_run), session)) return;
  TetField tets;
  if (arguments.field == "winding") {
    const Shape& shape = shapes.all.front();
    if (shapes.all.size() != 1 || shape.field || shapes.csg.offset != 0 ||
        !shape.request.method.name().empty() || !arguments.space.method.options.empty() ||
        !shape.request.values.empty())
      throw InputError(
          "option field winding takes one mesh, soup or cloud, no method, no offset and no values",
          "options-conflict");
    volume.values =
        grid_winding(shape.surface, volume.grid, shape.request, session.task(), session.report,
                     parse_radius("smoothing", arguments.smoothing, size));
    volume.name = "winding";
  } else if (arguments.domain == "tets") {
    if (shapes.all.size() != 1 || shapes.all.front().field || shapes.csg.offset != 0)
      throw InputError("option domain tets takes one mesh, soup or cloud", "options-conflict");
    const Shape& shape = shapes.all.front();
    arguments.tetgen.by =
        arguments.tets == "tetgen" ? TetFilling::By::tetgen : TetFilling::By::lattice;
    SpaceAnswer answer = tet_distance(shape.surface, volume.grid, arguments.tetgen, shape.request,
                                      session.task(), session.report);
    volume.values = std::move(answer.at_nodes);
    tets = std::move(answer.tets);
  } else {
    volume.values = grid_distance(shapes, volume.grid, session.task(), session.report);
  }
  session.record.grid = volume.grid;
  session.record.values = {range_of(volume.name, volume.values)};
  finish(arguments.out, session.task(), session, [&](const std::string& file) {
    write_distance(file, arguments, shapes, volume, tets, session);
  });
}

}  // namespace

void add_sdf(CLI::App& program, Session& session) {
  auto arguments = std::make_shared<SdfArguments>();
  CLI::App& verb = add_verb(program, session, arguments, "sdf",
                            "signed distance in space around a mesh, soup or point cloud", run_sdf);
  add_space_input(verb, arguments->space, session);
  add_output_option(verb, arguments->out,
                    "where to write: " + io::written_extensions({Kind::volume}) +
                        ", of --domain tets " + io::written_extensions({Kind::tets}) +
                        ", the surface at --level as " + io::written_extensions({Kind::surface}) +
                        ", or " + io::written_extensions({Kind::page, Kind::picture}));
  add_grid_options(verb, arguments->space);
  verb.add_option("--field", arguments->field,
                  "distance, or winding, the generalized winding number: 1 inside, 0 outside "
                  "[default distance]")
      ->check(one_of({"distance", "winding"}))
      ->type_name("WORD");
  add_smoothing_option(verb, arguments->smoothing, "of --field winding");
  verb.add_option("--domain", arguments->domain,
                  "where to solve: a grid, or tets that are small near the input only; volumes "
                  "are sampled from these [default grid]")
      ->check(one_of({"grid", "tets"}))
      ->type_name("WORD");
  verb.add_option("--tets", arguments->tets,
                  "of --domain tets: lattice, or tetgen, tets whose faces follow a mesh that does "
                  "not cross itself, made by that program where it is installed [default lattice]")
      ->check(one_of({"lattice", "tetgen"}))
      ->type_name("WORD");
  verb.add_option("--tetgen-timeout", arguments->tetgen.timeout,
                  "how long tetgen may take [seconds; default 600]")
      ->check(number_between(0.01, 1e6))
      ->type_name("S");
  verb.add_option("--level", arguments->levels,
                  std::string("levels of surfaces, separated by commas [") + length_unit_text +
                      "; default 0; of winding a number, default 0.5]")
      ->type_name("L[,L...]");
  verb.add_flag("--clip", arguments->clip, "close surfaces along the box where they leave it");
  verb.add_option("--band", arguments->band,
                  "for .vdb: half width of the band kept, in spacings; 0 keeps all [default 0]")
      ->check(number_between(0, 1e6))
      ->type_name("W");
  add_confidence_option(verb, arguments->confidence);
  add_values_option(verb, arguments->space);
  add_space_method(verb, arguments->space);
  add_shape_options(verb, arguments->space);
  add_plan_option(verb, session);
  add_json_option(verb, session);
}

}  // namespace littoral::cli
