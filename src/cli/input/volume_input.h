#pragma once
// What verbs do with volumes and level sets.

#include <string>
#include <vector>

#include "api/surface/level_lines.h"
#include "cli/session.h"
#include "io/render/volume_scene.h"

namespace littoral::cli {

/// Options of `view` and `render` that are about volumes, as given.
struct VolumeViewArguments {
  std::string axis = "z", position, level;
  int axis_number() const { return axis.front() - 'x'; }
  double slice_at() const;  // --slice; throws InputError unless it is one number
  bool no_surface = false;
};
void add_volume_view_options(CLI::App& verb, VolumeViewArguments& texts);

/// A scene of a volume; `file` is where it comes from.
io::Scene volume_scene(const Volume& volume, const std::string& file,
                       const VolumeViewArguments& texts);

/// Throws unless there is one file or one for each of the levels, all of one of the kinds.
void check_level_outputs(const std::vector<std::string>& out, std::size_t levels,
                         const io::Kinds& kinds);

/// Writes lines: all into one file, or each level into its own.
void write_lines(const std::vector<std::string>& out, const SurfaceMesh& mesh,
                 const std::vector<LevelLines>& levels);

}  // namespace littoral::cli
