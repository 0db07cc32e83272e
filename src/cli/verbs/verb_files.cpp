// littoral info, convert and contour: files in, facts or files out.

#include <iostream>
#include <memory>

#include "api/report_json.h"
#include "api/space/isosurfaces.h"
#include "api/surface/level_lines.h"
#include "api/surface/mesh_info.h"
#include "api/tet/tet_boundary.h"
#include "base/counted.h"
#include "cli/input/lengths.h"
#include "cli/input/numbers.h"
#include "cli/input/space_input.h"
#include "cli/input/surface_input.h"
#include "cli/output.h"
#include "cli/verbs/verbs.h"
#include "contour/isosurface.h"
#include "io/write.h"
#include "littoral/error.h"
#include "spatial/finite_box.h"
#include "spatial/triangulate.h"
#include "spatial/weld.h"

namespace littoral::cli {

namespace {

struct FileArguments {
  std::string in, out, mesh, field, levels, range, weld;
  int count = 0;  // of evenly spaced levels; 0: none
  std::vector<std::string> outs;
  double band = 0;
  bool triangulate = false, clip = false;
};

using io::Kind;

const io::Kinds soup_outputs = {Kind::surface, Kind::field};

template <class... Jobs>
struct Overloaded : Jobs... {
  using Jobs::operator()...;
};
template <class... Jobs>
Overloaded(Jobs...) -> Overloaded<Jobs...>;

void info(FileArguments& arguments, Session& session) {
  if (arguments.mesh.empty() && io::is_read_as(arguments.in, {Kind::sources}) &&
      !io::is_read_as(arguments.in, {Kind::surface}))
    throw InputError(arguments.in + " holds sources: name the surface they lie on with --mesh FILE",
                     "nothing-given");
  std::vector<InfoEntry> entries;
  if (arguments.mesh.empty()) {
    entries = content_info(io::read_content(arguments.in, arguments.field));
  } else {
    const SurfaceMesh mesh = read_mesh(arguments.mesh);
    const Sources sources = read_all_sources({arguments.in}, mesh, session);
    entries = sources_info(mesh, sources, session.report);
  }
  session.print_warnings();
  for (InfoEntry& entry : entries)
    if (auto* text = std::get_if<std::string>(&entry.value))
      *text = session.with_flags(*text, "sdf");
  std::cout << (session.json ? info_json(entries) + "\n" : info_text(entries));
}

/// The field named or the only one of a tet file.
const VecX& field_of(const io::TetFile& file, const FileArguments& arguments, std::string& name) {
  PolygonSoup fields;
  fields.scalars = file.scalars;
  name = choose_field(fields, arguments.field, arguments.in);
  return file.scalars.at(name);
}

PolygonSoup welded(const PolygonSoup& soup, const std::string& distance, Session& session) {
  const InputSize size = [&] { return points_size(soup.points); };
  Welded found = weld(soup, parse_radius("weld", distance, size));
  if (found.n_dropped_faces > 0)
    session.report.warn("degenerate-faces",
                        counted(found.n_dropped_faces, "face", "faces") +
                            " shrank to an edge or a point by option weld: left out");
  return std::move(found.soup);
}

void convert_soup(PolygonSoup soup, const FileArguments& arguments, Session& session) {
  if (io::is_written_as(arguments.out, {Kind::volume}) &&
      !io::is_written_as(arguments.out, soup_outputs))
    throw InputError(arguments.out + " holds a volume, and " + arguments.in +
                         " is none: littoral sdf makes the one of distance to it",
                     "unknown-format");
  check_outputs({arguments.out}, soup_outputs);
  const bool field_only = !io::is_written_as(arguments.out, {Kind::surface});
  const std::string field = choose_field(soup, arguments.field, arguments.in, !field_only);
  if (!arguments.weld.empty()) soup = welded(soup, arguments.weld, session);
  if (arguments.triangulate) soup = triangulate(soup);
  session.reading = false;
  session.task().checkpoint();
  if (io::is_written_as(arguments.out, {Kind::table}))  // the field that was chosen, alone
    std::erase_if(soup.scalars, [&](const auto& each) { return each.first != field; });
  if (field_only)
    io::write_field(arguments.out, soup, field);
  else
    io::write_surface(arguments.out, soup, field);
}

void convert(FileArguments& arguments, Session& session) {
  check_outputs({arguments.out}, {Kind::surface, Kind::field, Kind::volume, Kind::tets});
  if (arguments.band > 0 && !io::has_extension(arguments.out, ".vdb"))
    throw InputError("option band is for .vdb; other formats hold every node", "options-conflict");
  const bool to_tets = io::is_written_as(arguments.out, {Kind::tets});
  if (to_tets && !io::is_read_as(arguments.in, {Kind::tets}))
    throw InputError(arguments.out + " holds tets, " + arguments.in + " has none",
                     "unknown-format");
  check_lengths("weld", arguments.weld);
  const auto check_no_weld = [&] {
    if (!arguments.weld.empty())
      throw InputError("option weld is for surfaces and clouds, also the boundary of tets",
                       "options-conflict");
  };
  const Overloaded job{[&](const Volume& volume) {
                         check_no_weld();
                         check_outputs({arguments.out}, {Kind::volume});
                         session.reading = false;
                         session.task().checkpoint();
                         io::write_volume(arguments.out, volume, {.band = arguments.band});
                       },
                       [&](const io::TetFile& file) {
                         if (!to_tets) return convert_soup(boundary_of(file), arguments, session);
                         check_no_weld();
                         std::string name;
                         const VecX& values = field_of(file, arguments, name);
                         session.reading = false;
                         io::write_tets(arguments.out, file.mesh, values, name);
                       },
                       [&](const PolygonSoup& soup) { convert_soup(soup, arguments, session); }};
  std::visit(job, io::read_content(arguments.in, arguments.field));
}

/// The levels given, or evenly spaced ones: between the extremes of the values, or from one end of
/// a range to the other. Per cent are of the longest side of what distance is known on.
std::vector<double> levels_for(const FileArguments& arguments, const VecX& values,
                               const InputSize& size) {
  if (!arguments.levels.empty()) return parse_lengths("level", arguments.levels, size);
  const int n = arguments.count;
  std::vector<double> levels;
  if (!arguments.range.empty()) {
    const auto [low, high] = parse_range("range", arguments.range);
    for (int i = 0; i < n; ++i)
      levels.push_back(n == 1 ? (low + high) / 2 : low + (high - low) * i / (n - 1));
    return levels;
  }
  const FieldRange range = range_of("", values);
  if (!(range.low < range.high))
    throw InputError("option count: the values of " + arguments.in + " do not differ",
                     "nothing-there");
  for (int i = 1; i <= n; ++i) levels.push_back(range.low + (range.high - range.low) * i / (n + 1));
  return levels;
}

/// The longest side of points that a field is known at. Throws InputError unless it is distance.
InputSize side_for(const std::string& field, const MatX3& points) {
  return [&] {
    if (field != "distance")
      throw InputError("option level: % is of a length, for the field distance, not for " + field,
                       "options-conflict");
    return (points.colwise().maxCoeff() - points.colwise().minCoeff()).maxCoeff();
  };
}

double no_side() {
  throw InputError(
      "option level: % is of the longest side of a shape, and a volume holds only its box: give a "
      "length",
      "options-conflict");
}

void contour(FileArguments& arguments, Session& session) {
  if (arguments.levels.empty() == (arguments.count == 0))
    throw InputError("name either option level or option count", "nothing-given");
  if (!arguments.range.empty() && arguments.count == 0)
    throw InputError("option range goes with option count", "options-conflict");
  const std::size_t count = levels_for(arguments, Eigen::Vector2d(0, 1), [] { return 1.0; }).size();
  io::Kinds outputs;
  if (io::is_read_as(arguments.in, {Kind::surface, Kind::cloud})) outputs.push_back(Kind::sources);
  if (io::is_read_as(arguments.in, {Kind::volume, Kind::tets})) outputs.push_back(Kind::surface);
  if (!outputs.empty()) check_level_outputs(arguments.outs, count, outputs);
  const Overloaded job{
      [&](const Volume& volume) {
        check_outputs(arguments.outs, {Kind::surface});
        warn_without_box(arguments.in, session);
        session.reading = false;
        write_isosurfaces(arguments.outs,
                          isosurfaces(volume, levels_for(arguments, volume.values, no_side),
                                      arguments.clip, session.report, session.task()));
      },
      [&](const io::TetFile& file) {
        check_outputs(arguments.outs, {Kind::surface});
        std::string name;
        const VecX& values = field_of(file, arguments, name);
        session.reading = false;
        std::vector<Isosurface> surfaces;
        for (const double level : levels_for(arguments, values, side_for(name, file.mesh.points)))
          surfaces.push_back(
              {level, isosurface(file.mesh, values, level, session.report, session.task())});
        write_isosurfaces(arguments.outs, surfaces);
      },
      [&](const PolygonSoup& soup) {
        check_outputs(arguments.outs, {Kind::sources});
        const std::string name = choose_field(soup, arguments.field, arguments.in);
        const VecX values = soup.scalars.at(name);
        const SurfaceMesh mesh = mesh_of(soup, arguments.in);
        session.reading = false;
        Task task = session.task();
        const auto found =
            level_lines(mesh, values, levels_for(arguments, values, side_for(name, soup.points)),
                        session.report, task);
        task.checkpoint(1);
        write_lines(arguments.outs, mesh, found);
      }};
  std::visit(job, io::read_content(arguments.in, arguments.field));
}

void add_field(CLI::App& verb, FileArguments& arguments) {
  verb.add_option("--field", arguments.field,
                  "which values [default: distance, an OBJ's texture u, or the only ones]")
      ->type_name("NAME");
}

}  // namespace

void add_info(CLI::App& program, Session& session) {
  auto arguments = std::make_shared<FileArguments>();
  CLI::App& verb = add_verb(program, session, arguments, "info",
                            "what is in a file, and what is wrong with it", info);
  add_input_option(verb, "FILE", arguments->in,
                   kinds_help({Kind::surface, Kind::cloud, Kind::volume, Kind::tets}) +
                       ", or with --mesh " + kinds_help({Kind::sources}));
  verb.add_option("--mesh", arguments->mesh, "the surface that the sources in FILE lie on")
      ->type_name("FILE");
  verb.add_option("--field", arguments->field, "which values of a volume")->type_name("NAME");
  add_index_option(verb, session);
  add_json_option(verb, session);
}

void add_convert(CLI::App& program, Session& session) {
  auto arguments = std::make_shared<FileArguments>();
  CLI::App& verb =
      add_verb(program, session, arguments, "convert", "between file formats", convert);
  add_input_option(verb, "IN", arguments->in,
                   kinds_help({Kind::surface, Kind::cloud, Kind::volume, Kind::tets}) +
                       ": their boundary, or whole");
  add_output_option(verb, arguments->out,
                    io::written_extensions({Kind::surface}) + ", of a field " +
                        io::written_extensions({Kind::field}) + ", a volume " +
                        io::written_extensions({Kind::volume}) + ", tets " +
                        io::written_extensions({Kind::tets}));
  verb.add_option("--band", arguments->band,
                  "for .vdb: keep values nearer to zero than this many spacings, 0 to 1e6; 0: all "
                  "[default 0]")
      ->check(number_between(0, 1e6))
      ->type_name("N");
  verb.add_flag("--triangulate", arguments->triangulate, "cut polygons into triangles");
  verb.add_option(
          "--weld", arguments->weld,
          std::string("of a surface or cloud: join vertices that are at most this far apart; 0: "
                      "at one place [") +
              length_unit_text + "]")
      ->type_name("D");
  add_field(verb, *arguments);
}

void add_contour(CLI::App& program, Session& session) {
  auto arguments = std::make_shared<FileArguments>();
  CLI::App& verb = add_verb(
      program, session, arguments, "contour",
      "lines on a surface, or surfaces in a volume, where a field takes given values", contour);
  add_input_option(verb, "FIELD", arguments->in,
                   "a surface with values: .ply .vtp .vtk, or .obj with texture; " +
                       kinds_help({Kind::volume, Kind::tets}) + " with values");
  verb.add_option("--level", arguments->levels,
                  "the values, separated by commas [unit of the field; distance on a surface or in "
                  "tets also with % of the longest side]")
      ->type_name("L[,L...]");
  verb.add_option("--count", arguments->count,
                  "instead: this many evenly spaced values between the smallest and the largest, 1 "
                  "to 1000")
      ->check(whole_number(1, 1000))
      ->type_name("N");
  verb.add_option("--range", arguments->range,
                  "of --count: from the one value to the other, both included")
      ->type_name("A,B");
  add_output_option(verb, arguments->outs,
                    "lines: " + io::written_extensions({Kind::sources}) +
                        "; surfaces: " + io::written_extensions({Kind::surface}) +
                        "; one file, or one for each level");
  verb.add_flag("--clip", arguments->clip,
                "volumes: close the surface flat where it meets the box");
  add_field(verb, *arguments);
}

}  // namespace littoral::cli
