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
///   .mesh  Medit, text: Vertices, Tetrahedra, Hexahedra, Prisms, Pyramids, Triangles and
///          Quadrilaterals; other sections are skipped
///   .vtk   VTK legacy, text or binary, versions 1 to 5: an unstructured grid; scalars at points
///   .vtu   the same as XML: text, base64 or appended, plain or packed by zlib
///   .msh   Gmsh 2 and 4, text or binary
///   .tet   counts of vertices and tets, x y z, then 4 a b c d (from 0)
/// Hexahedra, prisms and pyramids are cut into tets that fit together (io/tet/cell_mesh.h),
/// polygons among the cells into triangles. Errors: InputError "name:line: ..." for text, "name:
/// byte N: ..." for binary files, with the number of the element; UnsupportedError for cells of
/// other kinds; IoError.
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
