// littoral info, convert and contour: files in, facts or files out.

#include <iostream>
#include <memory>

#include "api/report_json.h"
#include "api/space/volume_info.h"
#include "api/surface/level_lines.h"
#include "api/surface/mesh_info.h"
#include "cli/input/surface_input.h"
#include "cli/input/tet_input.h"
#include "cli/input/volume_input.h"
#include "cli/verbs/verbs.h"
#include "domain/mesh/triangulate.h"
#include "io/read.h"
#include "io/volume/volume.h"
#include "io/write.h"
#include "littoral/error.h"

namespace littoral::cli {

namespace {

struct Arguments {
  std::string in, out, mesh, field, levels;
  std::vector<std::string> outs;
  double band = 0;
  bool triangulate = false, clip = false;
};

bool is_field_file(const std::string& extension) {
  return extension == ".csv" || extension == ".npy" || extension == ".txt" || extension == ".vtp";
}

void info(const Arguments& arguments, Session& session) {
  const std::string extension = extension_of(arguments.in);
  if (arguments.mesh.empty() && (extension == ".txt" || extension == ".json"))
    throw InputError(arguments.in +
                     " holds sources: name the surface they lie on with --mesh FILE");
  std::vector<InfoEntry> entries;
  if (arguments.mesh.empty() && io::is_volume(arguments.in)) {
    entries = volume_info(io::read_volume(arguments.in, arguments.field));
  } else if (arguments.mesh.empty() && io::is_tets(arguments.in)) {
    entries = tet_info(io::read_tets(arguments.in));
  } else if (arguments.mesh.empty()) {
    entries = surface_info(io::read_surface(arguments.in));
  } else {
    const SurfaceMesh mesh = read_mesh(arguments.mesh);
    const Sources sources = read_all_sources({arguments.in}, mesh, session);
    entries = sources_info(mesh, sources, session.report);
  }
  session.print_warnings();
  std::cout << (session.json ? info_json(entries) + "\n" : info_text(entries));
}

void convert(const Arguments& arguments, Session& session) {
  if (io::is_volume(arguments.in))
    return convert_volume(arguments.in, arguments.field, arguments.out, arguments.band, session);
  const bool tets = io::is_tets(arguments.in);
  if (extension_of(arguments.out) == ".vtk" || extension_of(arguments.out) == ".vtu") {
    if (!tets) throw InputError(arguments.out + " holds tets, " + arguments.in + " has none");
    const io::TetFile file = io::read_tets(arguments.in);
    PolygonSoup fields;
    fields.scalars = file.scalars;
    const std::string name = choose_field(fields, arguments.field, arguments.in);
    session.reading = false;
    return io::write_tets(arguments.out, file.mesh, file.scalars.at(name), name);
  }
  check_output(arguments.out, {".obj", ".ply", ".off", ".stl", ".vtp", ".csv", ".npy", ".txt"},
               "a surface");
  PolygonSoup soup =
      tets ? boundary_of(io::read_tets(arguments.in)) : io::read_surface(arguments.in);
  const bool field_only = is_field_file(extension_of(arguments.out));
  const bool texture = extension_of(arguments.out) == ".obj";
  std::string field;
  if (field_only || texture || !arguments.field.empty())
    field = choose_field(soup, arguments.field, arguments.in, texture && arguments.field.empty());
  if (arguments.triangulate) soup = triangulate(soup);
  session.reading = false;
  session.task().checkpoint();
  if (field_only)
    io::write_field(arguments.out, soup, field);
  else
    io::write_surface(arguments.out, soup, field.empty() ? "distance" : field);
}

void contour(const Arguments& arguments, Session& session) {
  const std::vector<double> levels = parse_numbers("--level", arguments.levels);
  if (io::is_volume(arguments.in))
    return contour_volume(arguments.in, arguments.field, levels, arguments.clip, arguments.outs,
                          session);
  if (io::is_tets(arguments.in))
    return contour_tets(arguments.in, arguments.field, levels, arguments.outs, session);
  check_level_outputs(arguments.outs, levels.size(), {".obj", ".ply"}, "lines");
  PolygonSoup soup = io::read_surface(arguments.in);
  const VecX values = soup.scalars.at(choose_field(soup, arguments.field, arguments.in));
  const SurfaceMesh mesh = mesh_of(std::move(soup), arguments.in);
  session.reading = false;
  Task task = session.task();
  const auto lines = level_lines(mesh, values, levels, session.report, task);
  task.checkpoint(1);
  write_lines(arguments.outs, mesh, lines);
}

using Job = void (*)(const Arguments&, Session&);

CLI::App& add_verb(CLI::App& program, Session& session, std::shared_ptr<Arguments> arguments,
                   Job job, const char* name, const char* help) {
  CLI::App* verb = program.add_subcommand(name, help);
  add_common_options(*verb, session);
  verb->callback([=, &session] { session.job = [=, &session] { job(*arguments, session); }; });
  return *verb;
}

void add_field(CLI::App& verb, Arguments& arguments) {
  verb.add_option("--field", arguments.field,
                  "which values [default: distance, an OBJ's texture u, or the only ones]")
      ->type_name("NAME");
}

}  // namespace

void add_info(CLI::App& program, Session& session) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App& verb = add_verb(program, session, arguments, info, "info",
                            "what is in a file, and what is wrong with it");
  verb.add_option("FILE", arguments->in, "a surface, a volume, tets, or with --mesh sources")
      ->required()
      ->type_name("");
  verb.add_option("--mesh", arguments->mesh, "the surface that the sources in FILE lie on")
      ->type_name("FILE");
  verb.add_option("--field", arguments->field, "which values of a volume")->type_name("NAME");
  add_index_option(verb, session);
  add_json_option(verb, session);
}

void add_convert(CLI::App& program, Session& session) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App& verb =
      add_verb(program, session, arguments, convert, "convert", "between file formats");
  verb.add_option("IN", arguments->in,
                  "a surface or cloud: .obj .ply .off .stl .pc .xyz .pcd, or a volume: .vti .nrrd "
                  ".npy .vol, or the boundary of tets: .mesh .vtk .tet")
      ->required()
      ->type_name("");
  verb.add_option("-o,--output", arguments->out,
                  ".obj .ply .off .stl, of a field .vtp .csv .npy .txt, a volume .vti .npy .nrrd "
                  ".vdb")
      ->required()
      ->type_name("OUT");
  verb.add_option("--band", arguments->band,
                  "for .vdb: keep values nearer to zero than this many spacings, 0 to 1e6; 0: all "
                  "[default 0]")
      ->check(CLI::Range(0.0, 1e6).description(""))
      ->type_name("N");
  verb.add_flag("--triangulate", arguments->triangulate, "cut polygons into triangles");
  add_field(verb, *arguments);
}

void add_contour(CLI::App& program, Session& session) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App& verb = add_verb(program, session, arguments, contour, "contour",
                            "lines on a surface, or surfaces in a volume, where a field takes "
                            "given values");
  verb.add_option(
          "FIELD", arguments->in,
          "a surface with values: .ply, or .obj with texture; a volume: .vti .nrrd .npy .vol; or "
          "tets with values: .vtk")
      ->required()
      ->type_name("");
  verb.add_option("--level", arguments->levels,
                  "the values, separated by commas [unit of the field]")
      ->required()
      ->type_name("L[,L...]");
  add_level_outputs(verb, arguments->outs,
                    "lines: .obj .ply; surfaces: .obj .ply .off .stl; one file, or one for each "
                    "level");
  verb.add_flag("--clip", arguments->clip,
                "volumes: close the surface flat where it meets the box");
  add_field(verb, *arguments);
}

}  // namespace littoral::cli
