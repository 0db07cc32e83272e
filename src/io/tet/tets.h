#pragma once
// Tet meshes in files.

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "littoral/tet_mesh.h"

namespace littoral::io {

/// Everything of a tet file that is used here, as it was written.
struct TetFile {
  TetMesh mesh;                         // indices in range; points may be non-finite
  MatX3i triangles{0, 3};               // of the file's own, by vertex: boundaries and interfaces
  std::map<std::string, VecX> scalars;  // per vertex, e.g. "distance"; may be +inf
};

/// Reads tets by extension (any case):
///   .mesh  Medit, text: Vertices, Tetrahedra and Triangles; other sections are skipped, but those
///          of other cells in space are refused
///   .vtk   VTK legacy, text or binary, versions 1 to 5: an unstructured grid of tetrahedra, of
///          which triangles are kept and lower cells skipped; scalars at points
///   .tet   counts of vertices and tets, x y z, then 4 a b c d (from 0)
/// Errors: InputError "name:line: ..." for text, "name: byte N: ..." for binary files, with the
/// number of the element; UnsupportedError for cells that are not tetrahedra; IoError.
TetFile read_tets(const std::filesystem::path& path);

/// The same from memory. Never allocates more than a small multiple of bytes.size().
TetFile read_tets_bytes(std::string_view bytes, const std::string& extension,
                        const std::string& name);

/// Writes tets with one value per vertex by extension: .vtk (legacy, binary), .vtu (appended raw
/// data), both with exact numbers. Throws UnsupportedError for other extensions, InputError for a
/// wrong number of values, IoError.
void write_tets(const std::filesystem::path& path, const TetMesh& mesh, const VecX& values,
                const std::string& field = "distance");

}  // namespace littoral::io
