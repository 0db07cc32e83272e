#pragma once
// One reader per surface format. Each takes a whole file and the name to use in messages, and
// answers any bytes with what they say or an InputError. Points are kept even where they are not
// finite.

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "littoral/polygon_soup.h"

namespace littoral::io {

/// Wavefront OBJ: v (extra numbers ignored), vt, vn, f, l; every other record is ignored. Normals
/// and the texture's u (as scalar "u") are kept where each vertex has exactly one.
PolygonSoup read_obj(std::string_view bytes, const std::string& name);

/// Geomview OFF, text or binary, with any of the prefixes ST, C, N; normals are kept, colours are
/// not. Binary files may lack the counts of colours or have the lowest byte first.
PolygonSoup read_off(std::string_view bytes, const std::string& name);

/// Stanford PLY, ascii or binary of either byte order. Normals and the vertices' floating-point
/// properties are kept; triangle strips become their triangles, edges lines, joined while one
/// begins where the last one ended (or by the property "line" of our own files).
PolygonSoup read_ply(std::string_view bytes, const std::string& name);

/// The surfaces, lines and points of a glTF scene (.gltf, .glb), placed by its nodes. Vertices of a
/// mesh at one place are one; normals are kept where each has exactly one, attributes "_NAME" as
/// scalars "name". Skins, morphs and compressed meshes are UnsupportedErrors.
PolygonSoup read_gltf(std::string_view bytes, const std::string& name);
/// The same with buffers in files beside it.
PolygonSoup read_gltf_beside(std::string_view bytes, const std::filesystem::path& path);

/// 3MF: the triangles of all items to be built, placed by their transforms and those of components,
/// in millimetres. Items in other parts of the file (production extension) are read; other required
/// extensions than that and materials are UnsupportedErrors.
PolygonSoup read_3mf(std::string_view bytes, const std::string& name);

/// VTK polygon data as XML: polygons, strips, lines, normals ("Normals") and values at points.
PolygonSoup read_vtp(std::string_view bytes, const std::string& name);

/// STL, ascii or binary: told apart by the size that the triangle count asks for, not by the first
/// word. Corners at the same position are merged; facet normals are ignored.
PolygonSoup read_stl(std::string_view bytes, const std::string& name);
/// True if a file of this size [bytes] that begins so is 84 bytes and 50 for each of the triangles
/// that it counts there, one at least. Only chance, 1 in 4e9, makes another file such a one.
bool is_binary_stl(std::string_view first, std::uint64_t size);

/// Point cloud of records "v x y z" and "vn x y z" in any order; as many normals as points, or
/// none.
PolygonSoup read_pc(std::string_view bytes, const std::string& name);

/// Point cloud of rows "x y z" or "x y z nx ny nz"; further columns are ignored where there are not
/// six, or where they are colours. A first line with one number is taken for a count.
PolygonSoup read_xyz(std::string_view bytes, const std::string& name);

/// Three numbers a point without a name: colours (whole numbers up to 255, or shares up to 1)
/// rather than normals, none of which is negative only where all face one way, and mostly of unit
/// length then.
bool are_colours(const MatX3& columns);

/// Point cloud of the Point Cloud Library, ascii or uncompressed binary: x y z, normal_x normal_y
/// normal_z.
PolygonSoup read_pcd(std::string_view bytes, const std::string& name);

}  // namespace littoral::io
