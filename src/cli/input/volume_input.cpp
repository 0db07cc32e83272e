#include "cli/input/volume_input.h"

#include "cli/output.h"
#include "io/write.h"
#include "littoral/error.h"

namespace littoral::cli {

double VolumeViewArguments::slice_at() const { return parse_number("slice", position); }

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

io::Scene volume_scene(const Volume& volume, const std::string& file,
                       const VolumeViewArguments& texts) {
  io::VolumeView view;
  view.axis = texts.axis_number();
  if (!texts.position.empty()) view.position = texts.slice_at();
  if (!texts.level.empty()) view.level = parse_number("level", texts.level);
  view.isosurface = !texts.no_surface;
  try {
    return io::make_volume_scene(volume, view);
  } catch (const InputError& e) {
    throw InputError(file + ": " + e.what());
  }
}

void check_level_outputs(const std::vector<std::string>& out, std::size_t levels,
                         const io::Kinds& kinds) {
  check_outputs(out, kinds);
  if (out.size() != 1 && out.size() != levels)
    throw InputError("there are " + std::to_string(out.size()) + " output files for " +
                     std::to_string(levels) + " levels: name one for all, or one for each");
}

void write_lines(const std::vector<std::string>& out, const SurfaceMesh& mesh,
                 const std::vector<LevelLines>& levels) {
  for (std::size_t i = 0; i < out.size(); ++i)
    io::write_surface(out[i], join_lines(mesh, out.size() == 1 ? levels : std::vector{levels[i]}));
}

}  // namespace littoral::cli
