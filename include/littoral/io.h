#pragma once
// Files. Every reader answers any bytes with a value or an InputError naming file and line; files
// are written beside their target and renamed. docs/reference/formats.md lists the formats.

#include <filesystem>
#include <string>

#include "littoral/field.h"
#include "littoral/mesh.h"
#include "littoral/through_tets.h"
#include "littoral/volume.h"
#include "littoral/winding.h"

namespace littoral {

/// The extensions of the files that read_mesh takes: ".obj .ply ...".
std::string mesh_extensions();
/// A mesh, a cloud, or the boundary of voxels.
Mesh read_mesh(const std::filesystem::path& path);
/// What a surface or cloud file holds, as it was written.
PolygonSoup read_soup(const std::filesystem::path& path);
/// Curves and points on a mesh.
Sources read_sources(const std::filesystem::path& path, const Mesh& mesh);
Volume read_volume(const std::filesystem::path& path);
TetMesh read_tets(const std::filesystem::path& path);

/// By extension: .ply .obj .vtp .csv .npy .txt with the field, .html a page, .png a picture.
void write(const Field& field, const std::filesystem::path& path);
/// By extension: .ply .obj .vtp the surface cut along the curves, .csv .npy .txt labels of faces,
/// .html a page, .png a picture.
void write(const Regions& regions, const std::filesystem::path& path);
void write(const Mesh& mesh, const std::filesystem::path& path);
void write(const PolygonSoup& soup, const std::filesystem::path& path);
void write(const Volume& volume, const std::filesystem::path& path);
void write(const TetField& field, const std::filesystem::path& path);

/// A self-contained page to turn the result in, offline. Throws UnsupportedError where the library
/// was built without the viewer.
void write_page(const Field& field, const std::filesystem::path& path);
void write_page(const Regions& regions, const std::filesystem::path& path);
/// A picture, without a display.
void write_picture(const Field& field, const std::filesystem::path& path);
void write_picture(const Regions& regions, const std::filesystem::path& path);

}  // namespace littoral
