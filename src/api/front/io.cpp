#include "littoral/io.h"

#include "api/surface/surface_domain.h"
#include "api/tet/tet_boundary.h"
#include "io/formats.h"
#include "io/read.h"
#include "io/render/discs.h"
#include "io/render/picture.h"
#include "io/render/scene.h"
#include "io/render/volume_scene.h"
#include "io/surface/write_winding.h"
#include "io/tet/tets.h"
#include "io/volume/read_voxels.h"
#include "io/volume/volume.h"
#include "io/write.h"
#include "io/write_table.h"
#include "littoral/error.h"

namespace littoral {

namespace {

/// Is it written as a page or picture? Throws UnsupportedError, naming all that is written, where
/// it is none of these kinds either.
bool is_shown(const std::filesystem::path& path, io::Kinds kinds) {
  const io::Kinds shown{io::Kind::page, io::Kind::picture};
  kinds.insert(kinds.end(), shown.begin(), shown.end());
  io::format_to_write(path, kinds);
  return io::is_written_as(path, shown);
}

/// A soup over the vertices of the mesh with the values there.
PolygonSoup with_values(PolygonSoup soup, const Field& field) {
  soup.scalars = {{"distance", field.values}};
  if (field.confidence.size() > 0) soup.scalars["confidence"] = field.confidence;
  return soup;
}

PolygonSoup surface_of(const Field& field) {
  return field.refined ? *field.refined : with_values(field.mesh.soup(), field);
}

io::Scene scene_of(const Field& field) {
  io::Scene scene = io::make_scene(surface_of(field));
  io::add_sources(scene, *field.mesh.domain().mesh, field.sources);
  if (field.mesh.n_faces() == 0) io::show_as_discs(scene);
  io::describe(scene, field.report.method, field.report);
  return scene;
}

io::Scene scene_of(const Regions& regions) {
  io::Scene scene = io::make_scene(regions.surface, "region");
  scene.isolines = 0;
  for (const MatX3& line : regions.bounding) scene.curves.push_back({line, true});
  for (const MatX3& line : regions.nonbounding) scene.curves.push_back({line, false});
  io::describe(scene, regions.report.method, regions.report);
  return scene;
}

io::Scene scene_of(const TetField& field, const std::optional<Section>& cut) {
  if (cut && (cut->axis < 0 || cut->axis > 2))
    throw InputError("option axis: there are 0, 1 and 2, for x, y and z", "option-value");
  const io::TetFile file{field.mesh, {}, {{"distance", field.values}}};
  io::Scene scene =
      io::make_scene(cut ? cut_open(file, cut->axis, cut->position) : drawn_surface(file));
  io::describe(scene, field.report.method, field.report);
  return scene;
}

}  // namespace

std::string mesh_extensions() {
  return io::read_extensions({io::Kind::surface, io::Kind::cloud, io::Kind::voxels});
}

Mesh read_mesh(const std::filesystem::path& path) {
  io::format_to_read(io::extension_to_read(path), path.string(),
                     {io::Kind::surface, io::Kind::cloud, io::Kind::voxels});
  if (!io::holds(path, io::Kind::voxels)) return Mesh(io::read_surface(path));
  const io::VoxelMask mask = io::read_voxels(path);
  return Mesh::voxels(mask.grid, mask.inside);
}

PolygonSoup read_soup(const std::filesystem::path& path) { return io::read_surface(path); }

Sources read_sources(const std::filesystem::path& path, const Mesh& mesh) {
  Report report;
  return io::read_sources(path, *mesh.domain().mesh, std::nullopt, report);
}

Volume read_volume(const std::filesystem::path& path) { return io::read_volume(path); }
TetMesh read_tets(const std::filesystem::path& path) { return io::read_tets(path).mesh; }

void write(const Field& field, const std::filesystem::path& path) {
  if (is_shown(path, {io::Kind::field})) return io::write_scene(path, scene_of(field));
  // Tables are of the mesh's own vertices; clouds go without the triangles that show them.
  const bool of_mesh = field.mesh.n_faces() == 0 || io::is_written_as(path, {io::Kind::table});
  io::write_field(path, of_mesh ? with_values(field.mesh.soup(), field) : surface_of(field));
}

void write(const Regions& regions, const std::filesystem::path& path) {
  if (is_shown(path, {io::Kind::field})) return io::write_scene(path, scene_of(regions));
  if (io::is_written_as(path, {io::Kind::table}))
    return io::write_table(path, {{"region"}, regions.region.cast<double>(), "face"});
  if (io::has_extension(path, ".obj"))
    return io::write_homogeneous_obj(path, regions.surface, "winding", "weight");
  io::write_field(path, regions.surface, "region");
}

void write(const Mesh& mesh, const std::filesystem::path& path) {
  io::write_surface(path, mesh.soup());
}
void write(const PolygonSoup& soup, const std::filesystem::path& path) {
  io::write_surface(path, soup);
}
void write(const Volume& volume, const std::filesystem::path& path) {
  if (is_shown(path, {io::Kind::volume}))
    return io::write_scene(path, io::make_volume_scene(volume));
  io::write_volume(path, volume);
}
void write(const TetField& field, const std::filesystem::path& path) {
  if (is_shown(path, {io::Kind::tets, io::Kind::field}))
    return io::write_scene(path, scene_of(field, {}));
  write_tet_values(path, {field.mesh, {}, {{"distance", field.values}}});
}

void write_page(const Field& field, const std::filesystem::path& path) {
  io::write_page(path, scene_of(field));
}
void write_page(const Regions& regions, const std::filesystem::path& path) {
  io::write_page(path, scene_of(regions));
}
void write_page(const Volume& volume, const std::filesystem::path& path) {
  io::write_page(path, io::make_volume_scene(volume));
}
void write_page(const TetField& field, const std::filesystem::path& path,
                const std::optional<Section>& cut) {
  io::write_page(path, scene_of(field, cut));
}
void write_picture(const Field& field, const std::filesystem::path& path) {
  io::write_picture(path, scene_of(field));
}
void write_picture(const Regions& regions, const std::filesystem::path& path) {
  io::write_picture(path, scene_of(regions));
}
void write_picture(const Volume& volume, const std::filesystem::path& path) {
  io::write_picture(path, io::make_volume_scene(volume));
}
void write_picture(const TetField& field, const std::filesystem::path& path,
                   const std::optional<Section>& cut) {
  io::write_picture(path, scene_of(field, cut));
}

}  // namespace littoral
