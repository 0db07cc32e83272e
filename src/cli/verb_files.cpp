// littoral info, convert and contour: files in, facts or files out.

#include <iostream>
#include <memory>

#include "cli/surface_input.h"
#include "cli/verbs.h"
#include "littoral/api/mesh_info.h"
#include "littoral/api/report_json.h"
#include "littoral/base/error.h"
#include "littoral/base/option_table.h"
#include "littoral/contour/isolines.h"
#include "littoral/domain/triangulate.h"
#include "littoral/io/read.h"
#include "littoral/io/write.h"

namespace littoral::cli {

namespace {

struct Arguments {
  std::string in, out, mesh, field, levels;
  bool triangulate = false;
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
  if (arguments.mesh.empty()) {
    entries = surface_info(io::read_surface(arguments.in));
  } else {
    const SurfaceMesh mesh = read_mesh(arguments.mesh);
    const SurfaceSources sources = read_all_sources({arguments.in}, mesh, session);
    entries = sources_info(mesh, sources, session.report);
  }
  session.print_warnings();
  std::cout << (session.json ? info_json(entries) + "\n" : info_text(entries));
}

void convert(const Arguments& arguments, Session& session) {
  check_output(arguments.out, {".obj", ".ply", ".off", ".stl", ".vtp", ".csv", ".npy", ".txt"},
               "a surface");
  PolygonSoup soup = io::read_surface(arguments.in);
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
  check_output(arguments.out, {".obj", ".ply"}, "lines");
  const std::vector<double> levels = parse_numbers("--level", arguments.levels);
  PolygonSoup soup = io::read_surface(arguments.in);
  const VecX values = soup.scalars.at(choose_field(soup, arguments.field, arguments.in));
  const SurfaceMesh mesh = mesh_of(std::move(soup), arguments.in);
  session.reading = false;
  PolygonSoup out;
  std::vector<Vec3> points;
  std::vector<double> level_of_point;
  Task task = session.task();
  for (double level : levels) {
    task.stage(1.0 / static_cast<double>(levels.size()), "tracing lines").checkpoint();
    const std::vector<Polyline> lines = isolines(mesh, values, level);
    if (lines.empty()) session.report.warn("there are no lines at level " + number_text(level));
    for (const Polyline& line : lines) {
      std::vector<int> indices;
      for (const SurfacePoint& node : line.nodes) {
        indices.push_back(static_cast<int>(points.size()));
        points.push_back(mesh.position(node));
        level_of_point.push_back(level);
      }
      if (line.closed) indices.push_back(indices.front());
      out.lines.push_back(std::move(indices));
    }
  }
  if (points.empty())
    throw InputError("none of the levels is met by a face of " + arguments.in +
                     ": there is nothing to write");
  out.points.resize(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i)
    out.points.row(static_cast<Eigen::Index>(i)) = points[i];
  if (extension_of(arguments.out) == ".ply")
    out.scalars["level"] = Eigen::Map<const VecX>(level_of_point.data(),
                                                  static_cast<Eigen::Index>(level_of_point.size()));
  task.checkpoint();
  io::write_surface(arguments.out, out);
}

using Job = void (*)(const Arguments&, Session&);

CLI::App& add_verb(CLI::App& program, Session& session, std::shared_ptr<Arguments> arguments,
                   Job job, const char* name, const char* help) {
  CLI::App* verb = program.add_subcommand(name, help);
  add_common_options(*verb, session);
  verb->callback([=, &session] { session.job = [=, &session] { job(*arguments, session); }; });
  return *verb;
}

void add_output(CLI::App& verb, Arguments& arguments, const char* help) {
  verb.add_option("-o,--output", arguments.out, help)->required()->type_name("OUT");
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
  verb.add_option("FILE", arguments->in, "a surface, or with --mesh sources")
      ->required()
      ->type_name("");
  verb.add_option("--mesh", arguments->mesh, "the surface that the sources in FILE lie on")
      ->type_name("FILE");
  add_index_option(verb, session);
  add_json_option(verb, session);
}

void add_convert(CLI::App& program, Session& session) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App& verb =
      add_verb(program, session, arguments, convert, "convert", "between file formats");
  verb.add_option("IN", arguments->in, "a surface: .obj .ply .off .stl")->required()->type_name("");
  add_output(verb, *arguments, ".obj .ply .off .stl, or of a field .vtp .csv .npy .txt");
  verb.add_flag("--triangulate", arguments->triangulate, "cut polygons into triangles");
  add_field(verb, *arguments);
}

void add_contour(CLI::App& program, Session& session) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App& verb = add_verb(program, session, arguments, contour, "contour",
                            "lines on a surface where a field takes given values");
  verb.add_option("FIELD", arguments->in, "a surface with values: .ply, or .obj with texture")
      ->required()
      ->type_name("");
  verb.add_option("--level", arguments->levels,
                  "the values, separated by commas [unit of the field]")
      ->required()
      ->type_name("L[,L...]");
  add_output(verb, *arguments, "lines: .obj .ply");
  add_field(verb, *arguments);
}

}  // namespace littoral::cli
