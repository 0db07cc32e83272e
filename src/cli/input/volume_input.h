#pragma once
// What verbs do with volumes and level sets.

#include <string>
#include <vector>

#include "api/surface/level_lines.h"
#include "cli/session.h"
#include "io/render/volume_scene.h"

namespace littoral::cli {

/// One number; throws InputError naming the option.
double parse_number(const std::string& option, const std::string& text);

/// Options of `view` and `render` that are about volumes, as given.
struct VolumeViewArguments {
  std::string axis = "z", position, level;
  int axis_number() const { return axis.front() - 'x'; }
  double slice_at() const;  // --slice; throws InputError unless it is one number
  bool no_surface = false;
};
void add_volume_view_options(CLI::App& verb, VolumeViewArguments& texts);

/// A scene of the volume in a file.
io::Scene read_volume_scene(const std::string& file, const std::string& field,
                            const VolumeViewArguments& texts);

/// Adds -o for one file for all levels, or one for each.
void add_level_outputs(CLI::App& verb, std::vector<std::string>& out, const char* help);
/// Throws InputError unless there is one file or one for each of the levels, all with one of the
/// extensions.
void check_level_outputs(const std::vector<std::string>& out, std::size_t levels,
                         const std::vector<std::string>& extensions, const std::string& what);

/// Writes lines: all into one file, or each level into its own.
void write_lines(const std::vector<std::string>& out, const SurfaceMesh& mesh,
                 const std::vector<LevelLines>& levels);

/// Level sets of the volume in a file, written as surfaces.
void contour_volume(const std::string& file, const std::string& field,
                    const std::vector<double>& levels, bool clip,
                    const std::vector<std::string>& out, Session& session);

/// A volume in another format.
void convert_volume(const std::string& file, const std::string& field, const std::string& out,
                    double band, Session& session);

inline const std::vector<std::string> surface_outputs = {".obj", ".ply", ".off", ".stl"};
inline const std::vector<std::string> volume_outputs = {".vti", ".npy", ".nrrd", ".vdb"};

}  // namespace littoral::cli
