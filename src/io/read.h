#pragma once
// Reading files. Every reader answers any bytes with a value or an InputError naming file and line.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "base/platform/file_places.h"
#include "domain/mesh/surface_mesh.h"
#include "littoral/polygon_soup.h"
#include "littoral/report.h"
#include "littoral/sources.h"

namespace littoral::io {

/// Reads .obj .off .ply .stl, and point clouds as .pc .xyz .pcd or .ply, by extension (any case).
/// Points are kept even where they are not finite; files without vertices are rejected. OBJ:
/// normals, and the texture's u as scalar "u", are kept where each vertex has exactly one. PLY:
/// normals and the vertices' floating-point properties are kept. STL: corners at one position are
/// merged. Errors: InputError "name:line:
/// ..." for text, "name: byte N: ..." for binary files; IoError.
PolygonSoup read_surface(const std::filesystem::path& path);

/// The same from memory; `name` is used in messages, `extension` is ".obj" and so on. Never
/// allocates more than a small multiple of bytes.size().
PolygonSoup read_surface_bytes(std::string_view bytes, const std::string& extension,
                               const std::string& name);

/// Reads sources for a mesh, by extension. Indices out of range, parameters outside [0, 1], curves
/// of fewer than two nodes, unknown keywords and files without sources are InputErrors; consecutive
/// nodes need not share a face.
///
/// .txt  signed-heat: keyword lines signed_curve, unsigned_curve, unsigned_point (a 1 after one
///       reverses the nodes), then `v i`, `e i t` (edge number of SurfaceMesh), `e i j t` (the
///       edge's vertices; (1-t) i + t j), `f i a b [c]`, all 0-based, or `l i j ...`, 1-based.
///       Without any keyword line: surface winding number: points `v i`, `e i t`, segments `l a b`
///       by point number, 1-based unless a line `#offset 0`; joined head to tail (see chain in
///       source_nodes.h).
/// .json {"curves": [{"signed": true, "closed": false, "points": [[x,y,z], ...]} or
///       {"nodes": [{"v": i} | {"e": [i,j], "t": t} | {"f": i, "b": [a,b,c]}, ...]}, ...],
///       "points": [node, ...]}, 0-based; signed and closed are as shown where left out; a closed
///       curve must not repeat its first node, that is done here.
/// .obj .ply  lines, as signed curves: on the mesh's vertices where the file's vertices are the
/// mesh's,
///       otherwise free polylines in space. Single segments are joined head to tail.
///
/// `index_base` (0 or 1) overrides the bases of .txt and .json. Warnings go to the report.
Sources read_sources(const std::filesystem::path& path, const SurfaceMesh& mesh,
                     std::optional<int> index_base, Report& report);
Sources read_sources_bytes(std::string_view bytes, const std::string& extension,
                           const std::string& name, const SurfaceMesh& mesh,
                           std::optional<int> index_base, Report& report);

/// The polylines of a mesh file's own `l` lines, as signed curves on its vertices. A file of single
/// segments has them joined head to tail. Throws InputError for a line through a non-finite vertex.
Sources sources_from_lines(const PolygonSoup& soup, const std::string& name);

/// A whole file, unpacked if its name ends in .gz.
class FileBytes {
 public:
  /// Throws IoError naming the file (missing, unreadable, a directory), InputError if it is said to
  /// be packed and is not.
  explicit FileBytes(const std::filesystem::path& path);

  std::string_view view() const {
    return bytes_ ? std::string_view(bytes_.get(), size_) : std::string_view(text_);
  }

 private:
  /// Of a file of so many bytes, or more or fewer by now; by all threads.
  void read(FilePlaces& file, const std::filesystem::path& path, std::size_t size);

  std::unique_ptr<char[]> bytes_;  // or null: text_
  std::size_t size_ = 0;
  std::string text_;
};

/// The same as a string, which is a copy.
std::string read_bytes(const std::filesystem::path& path);

/// How a file begins, and its size as far as that is known [bytes], both unpacked.
struct FirstBytes {
  std::string bytes{};
  std::uint64_t size = 0;
};
/// `most` bytes at most; none of what is no plain file or cannot be read, such as standard input,
/// which can be read but once.
FirstBytes first_bytes(const std::filesystem::path& path, std::size_t most);

}  // namespace littoral::io
