#include "api/tet/tet_boundary.h"

#include <cmath>
#include <map>
#include <utility>

#include "base/index.h"
#include "contour/isosurface.h"
#include "domain/tet/tet_locator.h"
#include "io/formats.h"
#include "io/write.h"
#include "io/write_table.h"
#include "littoral/error.h"
#include "littoral/report.h"

namespace littoral {

namespace {

/// The boundary of tets on one side of a plane across an axis, in a soup that shares its points.
class CutBoundary {
 public:
  CutBoundary(const TetMesh& mesh, const VecX& values, int axis, double position)
      : mesh_(mesh), values_(values), axis_(axis), position_(position) {
    const MatX3i faces = boundary_faces(mesh);
    for (Eigen::Index f = 0; f < faces.rows(); ++f) add_face(faces.row(f));
  }

  /// A point with its value appended; its number.
  int add_point(const Eigen::Vector4d& point) {
    points_.push_back(point);
    return static_cast<int>(points_.size()) - 1;
  }
  void add_polygon(const std::vector<int>& corners) {
    if (corners.size() >= 3) soup_.add_face(corners);
  }
  PolygonSoup soup(const std::string& field) {
    soup_.points.resize(index(points_.size()), 3);
    VecX at(soup_.points.rows());
    for (Eigen::Index i = 0; i < at.size(); ++i) {
      soup_.points.row(i) = points_[i].head<3>();
      at[i] = points_[i][3];
    }
    if (!field.empty()) soup_.scalars[field] = at;
    return std::move(soup_);
  }

 private:
  Eigen::Vector4d with_value(int v) const {
    return {mesh_.points(v, 0), mesh_.points(v, 1), mesh_.points(v, 2), values_[v]};
  }
  double beyond(int v) const { return mesh_.points(v, axis_) - position_; }

  void add_face(const Eigen::RowVector3i& face) {
    std::vector<int> corners;
    for (int k = 0; k < 3; ++k) {
      const int a = face[k], b = face[(k + 1) % 3];
      const double x = beyond(a), y = beyond(b);
      if (x <= 0) corners.push_back(number({a, a}, 0));
      if ((x < 0 && y > 0) || (x > 0 && y < 0))
        corners.push_back(a < b ? number({a, b}, x / (x - y)) : number({b, a}, y / (y - x)));
    }
    add_polygon(corners);
  }
  /// Of the point a share t of the way along an edge.
  int number(const std::pair<int, int>& edge, double t) {
    const auto [at, is_new] = number_of_.try_emplace(edge, static_cast<int>(points_.size()));
    if (!is_new) return at->second;
    const Eigen::Vector4d a = with_value(edge.first), b = with_value(edge.second);
    Eigen::Vector4d point = (1 - t) * a + t * b;
    if (std::isinf(a[3]) || std::isinf(b[3])) point[3] = infinity;
    return add_point(point);
  }

  const TetMesh& mesh_;
  const VecX& values_;
  int axis_;
  double position_;
  std::map<std::pair<int, int>, int> number_of_;  // vertices (twice the same) and cut edges
  std::vector<Eigen::Vector4d> points_;
  PolygonSoup soup_;
};

}  // namespace

PolygonSoup triangles_of(const io::TetFile& file, const MatX3i& triangles) {
  PolygonSoup soup;
  std::vector<int> number(std::size_t(file.mesh.n_vertices()), -1), kept;
  for (const int v : triangles.reshaped<Eigen::RowMajor>()) {
    int& n = number[v];
    if (n < 0) {
      n = static_cast<int>(kept.size());
      kept.push_back(v);
    }
    soup.corners.push_back(n);
    if (soup.corners.size() % 3 == 0)
      soup.face_offsets.push_back(static_cast<int>(soup.corners.size()));
  }
  soup.points = file.mesh.points(kept, Eigen::all);
  for (const auto& [name, values] : file.scalars) soup.scalars[name] = values(kept);
  return soup;
}

PolygonSoup boundary_of(const io::TetFile& file) {
  return triangles_of(file, boundary_faces(file.mesh));
}

PolygonSoup cut_open(const io::TetFile& file, int axis, double position) {
  const TetMesh& mesh = file.mesh;
  const std::string field = file.scalars.empty() ? "" : file.scalars.begin()->first;
  const VecX values = field.empty() ? VecX::Zero(mesh.n_vertices()) : file.scalars.at(field);
  CutBoundary out(mesh, values, axis, position);
  // The section, with the value of the tet that holds each of its corners.
  Report unread;
  const VecX height = mesh.points.col(axis).array() - position;
  const PolygonSoup section = isosurface(mesh, height, 0, unread);
  if (section.n_faces() == 0)
    throw InputError("the plane of option slice misses the tets", "nothing-there");
  const TetLocator locator(mesh);
  std::vector<int> number;
  for (int v = 0; v < section.n_vertices(); ++v) {
    const TetPoint p = locator.locate(section.points.row(v));
    double value = 0;
    for (int k = 0; k < 4 && p.tet >= 0; ++k) {
      const double at_corner = values[mesh.tets(p.tet, k)];
      value = std::isinf(value) || std::isinf(at_corner) ? infinity
                                                         : value + p.barycentric[k] * at_corner;
    }
    number.push_back(p.tet < 0 ? -1
                               : out.add_point({section.points(v, 0), section.points(v, 1),
                                                section.points(v, 2), value}));
  }
  for (int f = 0; f < section.n_faces(); ++f) {
    std::vector<int> corners;
    for (const int v : section.face(f))
      if (number[v] >= 0) corners.push_back(number[v]);
    out.add_polygon(corners);
  }
  return out.soup(field);
}

PolygonSoup drawn_surface(const io::TetFile& file) {
  PolygonSoup boundary = boundary_of(file);
  if (boundary.n_faces() == 0 || boundary.scalars.empty()) return boundary;
  const VecX& seen = boundary.scalars.begin()->second;
  const VecX& all = file.scalars.at(boundary.scalars.begin()->first);
  const bool one_sign = seen.minCoeff() >= 0 || seen.maxCoeff() <= 0;
  const bool two_signs = all.minCoeff() < 0 && all.maxCoeff() > 0;
  if (seen.minCoeff() < seen.maxCoeff() && !(one_sign && two_signs)) return boundary;
  constexpr int axis = 2;
  const double middle = boundary.points.col(axis).mean();
  const auto& tets = file.mesh.tets;
  const auto passes = [&](Eigen::Index t) {
    bool below = false, above = false;
    for (int k = 0; k < 4; ++k) {
      const double height = file.mesh.points(tets(t, k), axis) - middle;
      below = below || height <= 0;
      above = above || height > 0;
    }
    return below && above;
  };
  for (Eigen::Index t = 0; t < tets.rows(); ++t)
    if (passes(t)) return cut_open(file, axis, middle);
  return boundary;
}

void write_tet_values(const std::filesystem::path& path, const io::TetFile& file) {
  const auto& [field, values] = *file.scalars.begin();
  if (io::is_written_as(path, {io::Kind::table}))
    return io::write_table(path, {{field}, values, "vertex"});
  if (io::is_written_as(path, {io::Kind::field}))
    return io::write_field(path, boundary_of(file), field);
  io::write_tets(path, file.mesh, values, field);
}

}  // namespace littoral
