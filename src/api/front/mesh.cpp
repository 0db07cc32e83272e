#include "littoral/mesh.h"

#include <cmath>
#include <limits>

#include "api/surface/surface_domain.h"
#include "base/counted.h"
#include "base/option_table.h"
#include "contour/isolines.h"
#include "domain/volume/voxels.h"
#include "littoral/error.h"
#include "littoral/field.h"
#include "sources/surface/surface_points.h"
#include "spatial/weld.h"

namespace littoral {

namespace {

/// Soups from files have been checked; those made in code have not.
PolygonSoup with_indices_checked(PolygonSoup soup) {
  const auto check = [&](const char* what, auto number, int v) {
    if (v < 0 || v >= soup.n_vertices())
      throw InputError(what + std::to_string(number) + " refers to vertex " + std::to_string(v) +
                           "; there are " + counted(soup.n_vertices(), "vertex", "vertices") +
                           ", counted from 0",
                       "no-such-element");
  };
  const auto& offsets = soup.face_offsets;
  if (offsets.empty() || offsets.front() != 0 ||
      offsets.back() != static_cast<int>(soup.corners.size()))
    throw InputError("the face offsets do not fit the corners", "sizes-differ");
  for (int f = 0; f < soup.n_faces(); ++f) {
    if (offsets[std::size_t(f) + 1] < offsets[f])
      throw InputError("the face offsets fall at face " + std::to_string(f), "sizes-differ");
    for (const int v : soup.face(f)) check("face ", f, v);
  }
  for (std::size_t l = 0; l < soup.lines.size(); ++l)
    for (const int v : soup.lines[l]) check("line ", l, v);
  if (soup.normals.rows() != 0 && soup.normals.rows() != soup.points.rows())
    throw InputError("there are " + std::to_string(soup.normals.rows()) + " normals for " +
                         std::to_string(soup.points.rows()) + " points",
                     "sizes-differ");
  return soup;
}

}  // namespace

Mesh::Mesh(SurfaceDomain domain)
    : domain_(std::make_shared<const SurfaceDomain>(std::move(domain))) {}

Mesh::Mesh(PolygonSoup soup)
    : Mesh(SurfaceDomain{std::make_shared<const SurfaceMesh>(with_indices_checked(std::move(soup))),
                         nullptr}) {}

PolygonSoup Mesh::checked(const MatX& points, const Integers& faces) {
  if (points.cols() != 3)
    throw InputError("points must have 3 columns, these have " + std::to_string(points.cols()),
                     "option-value");
  if (faces.rows() > 0 && faces.cols() < 3)
    throw InputError(
        "faces must have 3 columns or more, these have " + std::to_string(faces.cols()),
        "option-value");
  PolygonSoup soup;
  soup.points = points;
  std::vector<int> corners;
  for (Eigen::Index f = 0; f < faces.rows(); ++f) {
    corners.clear();
    Eigen::Index n = faces.cols();
    while (n > 0 && faces(f, n - 1) == -1) --n;
    for (Eigen::Index k = 0; k < n; ++k) {
      if (faces(f, k) < 0 || faces(f, k) >= points.rows())
        throw InputError("face " + std::to_string(f) + " refers to vertex " +
                             std::to_string(faces(f, k)) + "; there are " +
                             counted(points.rows(), "vertex", "vertices") + ", counted from 0",
                         "no-such-element");
      corners.push_back(static_cast<int>(faces(f, k)));
    }
    soup.add_face(corners);
  }
  return soup;
}

Mesh Mesh::cloud(const MatX3& points, const MatX3& normals) {
  PolygonSoup soup;
  soup.points = points;
  soup.normals = normals;
  return Mesh(std::move(soup));
}

Mesh Mesh::voxels(const Grid& grid, const std::vector<unsigned char>& inside) {
  if (inside.size() != grid.n_nodes())
    throw InputError("there are " + std::to_string(inside.size()) + " voxels for " +
                         std::to_string(grid.n_nodes()) + " nodes",
                     "sizes-differ");
  VoxelSurface surface = boundary_of_voxels(grid, inside);
  return Mesh(SurfaceDomain{std::make_shared<const SurfaceMesh>(std::move(surface.mesh)),
                            std::make_shared<const MatX3>(std::move(surface.face_normals))});
}

std::string Mesh::kind() const { return domain_->kind(); }
int Mesh::n_vertices() const { return domain_->mesh->n_vertices(); }
int Mesh::n_faces() const { return domain_->mesh->n_faces(); }
int Mesh::n_edges() const { return domain_->mesh->n_edges(); }
int Mesh::n_components() const { return domain_->mesh->n_components(); }
const Rows<int, 2>& Mesh::edges() const { return domain_->mesh->edges(); }
const PolygonSoup& Mesh::soup() const { return domain_->mesh->soup(); }

Vec3 Mesh::position(const SurfacePoint& point) const {
  Vec3 x;
  for (int a = 0; a < 3; ++a) x[a] = interpolate(points().col(a), point);
  return x;
}

double Mesh::interpolate(const VecX& values, const SurfacePoint& point) const {
  const SurfaceMesh& mesh = *domain_->mesh;
  if (values.size() != mesh.n_vertices())
    throw InputError("there are " + std::to_string(values.size()) + " values for " +
                         counted(mesh.n_vertices(), "vertex", "vertices"),
                     "sizes-differ");
  if (point.on == SurfacePoint::On::vertex) {
    if (point.element < 0 || point.element >= mesh.n_vertices())
      throw InputError("there is no vertex " + std::to_string(point.element) + "; the mesh has " +
                           counted(mesh.n_vertices(), "vertex", "vertices") + ", counted from 0",
                       "no-such-element");
    return values[point.element];
  }
  check_element(mesh, point);
  check_barycentrics(point);
  double sum = 0;
  const auto add = [&](double weight, int v) {
    if (weight != 0) sum += weight * values[v];  // infinite values reach no farther than they must
  };
  if (point.on == SurfacePoint::On::edge) {
    for (int k = 0; k < 2; ++k) add(point.b[k], mesh.edges()(point.element, k));
    return sum;
  }
  const auto face = mesh.face(point.element);  // polygons: coordinates on the first three corners
  for (std::size_t k = 0; k < 3; ++k) add(point.b[k], face[k]);
  return sum;
}

std::vector<MatX3> Field::isolines(double level) const {
  const SurfaceMesh& on = *mesh.domain().mesh;
  std::vector<MatX3> lines;
  for (const Polyline& line : littoral::isolines(on, values, level))
    lines.push_back(polyline_points(on, line));
  return lines;
}

Mesh Mesh::welded(double distance) const {
  if (!(distance >= 0 && std::isfinite(distance)))
    throw InputError(
        "the distance to weld over must be finite and not negative, not " + number_text(distance),
        "option-value");
  return Mesh(weld(soup(), distance).soup);
}

}  // namespace littoral
