#include "cli/input/volume_input.h"

#include <filesystem>

#include "api/space/isosurfaces.h"
#include "io/volume/volume.h"
#include "io/write.h"
#include "littoral/error.h"

namespace littoral::cli {

double parse_number(const std::string& option, const std::string& text) {
  const std::vector<double> numbers = parse_numbers(option, text);
  if (numbers.size() != 1) throw InputError("option " + option + " takes one number");
  return numbers.front();
}

double VolumeViewArguments::slice_at() const { return parse_number("--slice", position); }

void add_volume_view_options(CLI::App& verb, VolumeViewArguments& texts) {
  const auto volumes = [](CLI::Option* option) { return option->group("Volumes"); };
  volumes(verb.add_option("--axis", texts.axis,
                          "the slice is orthogonal to this axis: x, y or z [default z]"))
      ->check(CLI::IsMember({"x", "y", "z"}).description(""))
      ->type_name("A");
  volumes(
      verb.add_option("--slice", texts.position,
                      "where along the axis [length; default: the middle of the box]; tets are cut "
                      "open there"))
      ->type_name("P");
  volumes(verb.add_option("--level", texts.level,
                          "the level of the surface shown [default 0, or half way where the values "
                          "do not pass 0]"))
      ->type_name("L");
  volumes(verb.add_flag("--no-surface", texts.no_surface, "show the slice only"));
}

io::Scene read_volume_scene(const std::string& file, const std::string& field,
                            const VolumeViewArguments& texts) {
  io::VolumeView view;
  view.axis = texts.axis_number();
  if (!texts.position.empty()) view.position = texts.slice_at();
  if (!texts.level.empty()) view.level = parse_number("--level", texts.level);
  view.isosurface = !texts.no_surface;
  const Volume volume = io::read_volume(file, field);
  try {
    return io::make_volume_scene(volume, view);
  } catch (const InputError& e) {
    throw InputError(file + ": " + e.what());
  }
}

void add_level_outputs(CLI::App& verb, std::vector<std::string>& out, const char* help) {
  verb.add_option("-o,--output", out, help)
      ->required()
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->type_name("OUT");
}

void check_level_outputs(const std::vector<std::string>& out, std::size_t levels,
                         const std::vector<std::string>& extensions, const std::string& what) {
  for (const std::string& file : out) check_output(file, extensions, what);
  if (out.size() != 1 && out.size() != levels)
    throw InputError("there are " + std::to_string(out.size()) + " output files for " +
                     std::to_string(levels) + " levels: name one for all, or one for each");
}

void write_lines(const std::vector<std::string>& out, const SurfaceMesh& mesh,
                 const std::vector<LevelLines>& levels) {
  for (std::size_t i = 0; i < out.size(); ++i) {
    PolygonSoup lines = join_lines(mesh, out.size() == 1 ? levels : std::vector{levels[i]});
    if (extension_of(out[i]) == ".obj") lines.scalars.clear();
    io::write_surface(out[i], lines);
  }
}

void contour_volume(const std::string& file, const std::string& field,
                    const std::vector<double>& levels, bool clip,
                    const std::vector<std::string>& out, Session& session) {
  check_level_outputs(out, levels.size(), surface_outputs, "a surface");
  const Volume volume = io::read_volume(file, field);
  session.reading = false;
  Task task = session.task();
  const auto surfaces = isosurfaces(volume, levels, clip, session.report, task);
  task.checkpoint(1);
  write_isosurfaces(out, surfaces);
}

void convert_volume(const std::string& file, const std::string& field, const std::string& out,
                    double band, Session& session) {
  check_output(out, volume_outputs, "a volume");
  if (band > 0 && extension_of(out) != ".vdb")
    throw InputError("option --band is for .vdb; other formats hold every node");
  const Volume volume = io::read_volume(file, field);
  session.reading = false;
  session.task().checkpoint();
  io::write_volume(out, volume, {.band = band});
}

}  // namespace littoral::cli
