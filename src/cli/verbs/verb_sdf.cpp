// littoral sdf: signed distance in space around a mesh, soup or point cloud.

#include <algorithm>
#include <memory>

#include "api/space/isosurfaces.h"
#include "base/stopwatch.h"
#include "cli/input/space_input.h"
#include "cli/input/tet_input.h"
#include "cli/input/volume_input.h"
#include "cli/verbs/verbs.h"
#include "contour/isosurface.h"
#include "io/read.h"
#include "io/render/picture.h"
#include "io/render/volume_scene.h"
#include "io/volume/volume.h"
#include "littoral/error.h"

namespace littoral::cli {

namespace {

const std::vector<std::string> outputs = {".vti", ".npy", ".nrrd", ".vdb", ".obj", ".ply",
                                          ".off", ".stl", ".html", ".png", ".vtk", ".vtu"};

struct Arguments {
  SpaceArguments space;
  std::string levels = "0";
  std::vector<std::string> out;
  double band = 0;
  bool clip = false;
  std::string domain = "grid";
  std::string tets = "lattice";
  TetFilling tetgen;
};

bool is_among(const std::string& file, const std::vector<std::string>& extensions) {
  return std::find(extensions.begin(), extensions.end(), extension_of(file)) != extensions.end();
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

void write_results(const Arguments& arguments, const Volume& volume, const TetField& tets,
                   Session& session) {
  const std::vector<double> levels = parse_numbers("--level", arguments.levels);
  for (const std::string& file : arguments.out) {
    session.task().checkpoint();
    if (is_among(file, volume_outputs)) {
      io::write_volume(file, volume, {.band = arguments.band});
    } else if (extension_of(file) == ".vtk" || extension_of(file) == ".vtu") {
      write_tet_field(file, tets.mesh, tets.values, "distance", session);
    } else if (is_among(file, surface_outputs)) {
      write_isosurfaces({file}, isosurfaces_of(volume, tets, levels, arguments.clip, session));
    } else {
      io::VolumeView view;
      view.level = levels.front();
      io::Scene scene = io::make_volume_scene(volume, view);
      scene.title = std::filesystem::path(arguments.space.input).stem().string();
      scene.facts = {{"method", session.report.method},
                     {"nodes", std::to_string(volume.grid.n_nodes())}};
      for (const auto& option : session.report.options) scene.facts.push_back(option);
      extension_of(file) == ".html" ? io::write_page(file, scene) : io::write_picture(file, scene);
    }
  }
}

void run(Arguments& arguments, Session& session) {
  for (const std::string& file : arguments.out) {
    check_output(file, outputs, "signed distance in space");
    const std::string extension = extension_of(file);
    if (arguments.domain != "tets" && (extension == ".vtk" || extension == ".vtu"))
      throw InputError(file + " holds tets: they are there with --domain tets");
  }
  if (arguments.tets != "lattice" && arguments.domain != "tets")
    throw InputError("option --tets goes with --domain tets");
  if (arguments.clip && arguments.domain == "tets")
    throw UnsupportedError("--clip is for grids: the cube of the tets is larger than the box");
  parse_numbers("--level", arguments.levels);
  const CsgShapes shapes = read_shapes(arguments.space, session, SpaceSignedHeat{});
  Volume volume;
  volume.grid = choose_grid(shapes, grid_request(arguments.space));
  session.reading = false;
  TetField tets;
  if (arguments.domain == "tets") {
    if (shapes.all.size() != 1 || shapes.all.front().field || shapes.csg.offset != 0)
      throw InputError("option --domain tets takes one mesh, soup or cloud");
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
  {
    const Stopwatch watch(session.report, "write");
    write_results(arguments, volume, tets, session);
  }
  session.print_report();
}

}  // namespace

void add_sdf(CLI::App& program, Session& session) {
  CLI::App* verb =
      program.add_subcommand("sdf", "signed distance in space around a mesh, soup or point cloud");
  auto arguments = std::make_shared<Arguments>();
  add_space_input(*verb, arguments->space, session);
  verb->add_option(
          "-o,--output", arguments->out,
          "where to write: .vti .npy .nrrd .vdb, of --domain tets .vtk .vtu, the surface at "
          "--level as .obj .ply .off .stl, or .html .png; may be repeated")
      ->required()
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->type_name("OUT");
  add_grid_options(*verb, arguments->space);
  verb->add_option("--domain", arguments->domain,
                   "where to solve: a grid, or tets that are small near the input only; volumes "
                   "are sampled from these [default grid]")
      ->check(CLI::IsMember({"grid", "tets"}).description(""))
      ->type_name("WORD");
  verb->add_option("--tets", arguments->tets,
                   "of --domain tets: lattice, or tetgen, tets whose faces follow a mesh that does "
                   "not cross itself, made by that program where it is installed [default lattice]")
      ->check(CLI::IsMember({"lattice", "tetgen"}).description(""))
      ->type_name("WORD");
  verb->add_option("--tetgen-timeout", arguments->tetgen.timeout,
                   "how long tetgen may take [seconds; default 600]")
      ->check(CLI::Range(0.01, 1e6).description(""))
      ->type_name("S");
  verb->add_option("--level", arguments->levels,
                   "levels of surfaces, separated by commas [length; default 0]")
      ->type_name("L[,L...]");
  verb->add_flag("--clip", arguments->clip, "close surfaces along the box where they leave it");
  verb->add_option("--band", arguments->band,
                   "for .vdb: half width of the band kept, in spacings; 0 keeps all [default 0]")
      ->check(CLI::Range(0.0, 1e6).description(""))
      ->type_name("W");
  add_space_method(*verb, arguments->space, "signed-heat; of several shapes as for query");
  add_shape_options(*verb, arguments->space);
  add_json_option(*verb, session);
  add_common_options(*verb, session);
  verb->callback(
      [arguments, &session] { session.job = [arguments, &session] { run(*arguments, session); }; });
}

}  // namespace littoral::cli
