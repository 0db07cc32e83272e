#pragma once
// Files. Every reader answers any bytes with a value or an InputError naming file and line; files
// are written beside their target and renamed. docs/reference/formats.md lists the formats.

#include <filesystem>
#include <optional>
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
/// By extension: files of volumes, .html a page, .png a picture.
void write(const Volume& volume, const std::filesystem::path& path);
/// By extension: .vtk .vtu tets with the field, .csv .npy .txt values, .ply .obj .vtp the boundary
/// with the field, .html a page, .png a picture.
void write(const TetField& field, const std::filesystem::path& path);

/// A plane across an axis.
struct Section {
  int axis = 2;         // 0, 1, 2
  double position = 0;  // along it [length]
};

/// A self-contained page to turn the result in, offline. Throws UnsupportedError where the library
/// was built without the viewer.
void write_page(const Field& field, const std::filesystem::path& path);
void write_page(const Regions& regions, const std::filesystem::path& path);
void write_page(const Volume& volume, const std::filesystem::path& path);
/// The boundary, cut open at a plane: where none is given in the middle if the field has one value
/// all over the boundary, else nowhere. Throws InputError for a plane that misses the tets.
void write_page(const TetField& field, const std::filesystem::path& path,
                const std::optional<Section>& cut = {});
/// A picture, without a display.
void write_picture(const Field& field, const std::filesystem::path& path);
void write_picture(const Regions& regions, const std::filesystem::path& path);
void write_picture(const Volume& volume, const std::filesystem::path& path);
void write_picture(const TetField& field, const std::filesystem::path& path,
                   const std::optional<Section>& cut = {});

}  // namespace littoral
