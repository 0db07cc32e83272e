#pragma once
// The file formats, one row each. From the rows come the choice of reader and writer, what messages
// and help say about extensions, and docs/reference/formats.md.

#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "domain/mesh/surface_mesh.h"
#include "io/render/picture.h"
#include "io/tet/tets.h"
#include "io/volume/read_voxels.h"
#include "io/volume/volume.h"
#include "io/write_table.h"
#include "littoral/polygon_soup.h"
#include "littoral/report.h"
#include "littoral/sources.h"

namespace littoral::io {

/// What a file may hold.
enum class Kind { surface, cloud, volume, voxels, tets, sources, field, table, page, picture };
using Kinds = std::vector<Kind>;

/// What a file holds, whichever it is; clouds are soups without faces.
using Content = std::variant<PolygonSoup, Volume, TetFile>;

/// A format; what it has no reader or writer for, it is not read or written as.
struct Format {
  std::string_view extension;  // ".obj"
  std::string_view about;
  bool lines = false;        // a surface's lines are kept, so that it can hold sources
  bool no_box = false;       // of a volume, origin and spacing are not kept
  bool more_values = false;  // of volumes and surfaces, several values at each node are written
  bool exchanged = false;    // files bear the extensions of all that are, whichever they hold

  PolygonSoup (*read_surface)(std::string_view bytes, const std::string& name) = nullptr;
  PolygonSoup (*read_cloud)(std::string_view bytes, const std::string& name) = nullptr;
  Volume (*read_volume)(std::string_view bytes, const std::string& name,
                        const std::string& field) = nullptr;
  VoxelMask (*read_voxels)(std::string_view bytes, const std::string& name) = nullptr;
  TetFile (*read_tets)(std::string_view bytes, const std::string& name) = nullptr;
  /// Where files of the format are of several of these kinds: this one as what it is.
  Content (*read_any)(std::string_view bytes, const std::string& name,
                      const std::string& field) = nullptr;
  /// Where surfaces may name further files: with those beside `path`.
  PolygonSoup (*read_beside)(std::string_view bytes, const std::filesystem::path& path) = nullptr;
  Sources (*read_sources)(std::string_view bytes, const std::string& name, const SurfaceMesh& mesh,
                          std::optional<int> index_base) = nullptr;
  PointTable (*read_table)(std::string_view bytes, const std::string& name) = nullptr;

  // Clouds and, by `more_values`, fields are written with all values at their points.
  void (*write_surface)(std::ostream& out, const PolygonSoup& soup,
                        const std::string& field) = nullptr;
  void (*write_cloud)(std::ostream& out, const PolygonSoup& soup,
                      const std::string& field) = nullptr;
  void (*write_field)(std::ostream& out, const PolygonSoup& soup,
                      const std::string& field) = nullptr;
  void (*write_volume)(std::ostream& out, const Volume& volume,
                       const VolumeWriteOptions& options) = nullptr;
  void (*write_tets)(std::ostream& out, const TetMesh& mesh, const VecX& values,
                     const std::string& field) = nullptr;
  void (*write_table)(std::ostream& out, const Table& table) = nullptr;
  void (*write_page)(const std::filesystem::path& path, const Scene& scene) = nullptr;
  void (*write_picture)(const std::filesystem::path& path, const Scene& scene,
                        const PictureOptions& options) = nullptr;

  /// How files begin after blanks, in lower case and with a blank for a line end; what begins with
  /// '<' may stand further on.
  std::vector<std::string_view> begins{};
  /// Where files may begin anyhow: do these first bytes go with a file of this size?
  bool (*fits)(std::string_view first, std::uint64_t size) = nullptr;

  bool (*available)() = nullptr;  // null: in every build
  std::string_view unless = "";   // why it is not
};

const std::vector<Format>& formats();
/// The row of an extension in any case; null where there is none.
const Format* format_of(const std::string& extension);

/// "ply:-": standard input or output in the format .ply. Not so where a folder stands before it.
bool is_standard_stream(const std::filesystem::path& path);
/// What the name of a file to be read says: ".ply" of "a.ply", "a.ply.gz" and "ply:-".
std::string extension_named(const std::filesystem::path& path);
/// What says its format: the name, or else the contents. These are asked where the name has no
/// extension that is known or one that is exchanged for others, and tell if they begin as files of
/// one format alone do.
std::string extension_to_read(const std::filesystem::path& path);
/// The same of a file to be written: ".ply" of "a.ply" and "ply:-".
std::string extension_to_write(const std::filesystem::path& path);

bool reads(const Format& format, Kind kind);
bool writes(const Format& format, Kind kind);
/// The extensions that any of the kinds is read from or written to: ".obj .ply".
std::string read_extensions(const Kinds& kinds);
std::string written_extensions(const Kinds& kinds);
/// "a surface, cloud or volume"
std::string kinds_text(const Kinds& kinds);

/// The format with this extension (any case), if it is read as any of the kinds. Throws InputError
/// for unknown extensions and UnsupportedError for those of other formats, saying what is possible.
const Format& format_to_read(const std::string& extension, const std::string& name,
                             const Kinds& kinds);
/// The format of a file to be written as any of the kinds. Throws UnsupportedError saying what is
/// possible, or what this build lacks.
const Format& format_to_write(const std::filesystem::path& path, const Kinds& kinds);

/// True if the extension is that of a format read or written as one of the kinds.
bool is_named_as(const std::filesystem::path& path, const Kinds& kinds);
bool is_written_as(const std::filesystem::path& path, const Kinds& kinds);
/// The same of what says the format of a file that is there.
bool is_read_as(const std::filesystem::path& path, const Kinds& kinds);

/// True if a file is named so, in any case.
bool has_extension(const std::filesystem::path& path, std::string_view extension);

/// Reads a surface, cloud, volume or tets. `field` is that of a volume. Throws as the readers do.
Content read_content(const std::filesystem::path& path, const std::string& field = "");

/// Is a file read as this kind, by its extension or, where that leaves a choice, by what it holds?
/// Throws as the readers do.
bool holds(const std::filesystem::path& path, Kind kind);

/// A page or a picture of a scene, by extension. Throws as write_page and write_picture do.
void write_scene(const std::filesystem::path& path, const Scene& scene);

/// A line for each format, and docs/reference/formats.md.
std::string formats_text();
std::string formats_markdown();

}  // namespace littoral::io
