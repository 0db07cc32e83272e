#include "spatial/triangulate.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "littoral/types.h"

namespace littoral {

namespace {

constexpr long max_tests = 50'000'000;  // of a point in an ear, per polygon

double turn(const Vec2& a, const Vec2& b, const Vec2& c) {
  const Vec2 u = b - a, v = c - a;
  return u.x() * v.y() - u.y() * v.x();
}

/// Corners in the plane of the polygon's vector area, counter-clockwise and of size about 1; empty
/// where there is no such plane.
std::vector<Vec2> flatten(const PolygonSoup& soup, std::span<const int> face) {
  Vec3 low = soup.points.row(face[0]), high = low;
  for (int v : face) {
    if (!soup.points.row(v).allFinite()) return {};
    low = low.cwiseMin(soup.points.row(v).transpose());
    high = high.cwiseMax(soup.points.row(v).transpose());
  }
  const double size = (high - low).stableNorm();
  if (!(size > 0) || !std::isfinite(size)) return {};
  std::vector<Vec3> p;
  for (int v : face) p.push_back((soup.points.row(v).transpose() - low) / size);
  Vec3 normal = Vec3::Zero();
  for (std::size_t k = 1; k + 1 < p.size(); ++k) normal += (p[k] - p[0]).cross(p[k + 1] - p[0]);
  if (!(normal.norm() > 1e-14)) return {};
  normal.normalize();
  const Vec3 x = normal.unitOrthogonal(), y = normal.cross(x);
  std::vector<Vec2> out;
  for (const Vec3& q : p) out.push_back({q.dot(x), q.dot(y)});
  return out;
}

/// The corners of a polygon that are left, by squares of the plane.
class CornerGrid {
 public:
  explicit CornerGrid(const std::vector<Vec2>& p) : p_(p) {
    side_ = std::max(1, static_cast<int>(std::sqrt(static_cast<double>(p.size()))));
    for (const Vec2& q : p) box_.extend(q);
    cells_.resize(std::size_t(side_) * side_);
    for (std::size_t i = 0; i < p.size(); ++i) corners_in(p[i]).push_back(static_cast<int>(i));
  }

  void remove(int corner) { std::erase(corners_in(p_[corner]), corner); }

  /// Squares that meet a box.
  struct Squares {
    std::array<int, 2> first, last;
    std::size_t count() const {
      return std::size_t(last[0] - first[0] + 1) * std::size_t(last[1] - first[1] + 1);
    }
  };
  Squares squares(const Eigen::AlignedBox2d& box) const {
    constexpr double rounding = 1e-9;
    const Vec2 more = Vec2::Constant(rounding);
    return {square_of(box.min() - more), square_of(box.max() + more)};
  }
  /// Does `found` say so of a corner in these squares?
  template <class Found>
  bool any(const Squares& squares, const Found& found) const {
    for (int j = squares.first[1]; j <= squares.last[1]; ++j)
      for (int i = squares.first[0]; i <= squares.last[0]; ++i)
        if (std::ranges::any_of(cells_[std::size_t(j) * side_ + i], found)) return true;
    return false;
  }

 private:
  std::array<int, 2> square_of(const Vec2& q) const {
    std::array<int, 2> at{};
    for (int a = 0; a < 2; ++a) {
      const double extent = box_.sizes()[a];
      const double share = extent > 0 ? (q[a] - box_.min()[a]) / extent : 0;
      at[a] = static_cast<int>(std::clamp(share * side_, 0.0, side_ - 1.0));
    }
    return at;
  }
  std::vector<int>& corners_in(const Vec2& q) {
    const auto [i, j] = square_of(q);
    return cells_[std::size_t(j) * side_ + i];
  }

  const std::vector<Vec2>& p_;
  int side_ = 1;
  Eigen::AlignedBox2d box_;
  std::vector<std::vector<int>> cells_;
};

/// Is the triangle a, b, c of the remaining polygon free of other corners, and turned the right
/// way? They are looked for in the grid where that is quicker.
bool is_ear(const std::vector<Vec2>& p, const std::vector<int>& rest, const CornerGrid* grid,
            std::size_t k, long& tests) {
  const std::size_t n = rest.size();
  const Vec2 &a = p[rest[(k + n - 1) % n]], &b = p[rest[k]], &c = p[rest[(k + 1) % n]];
  if (!(turn(a, b, c) > 0)) return false;
  const auto is_inside = [&](int i) {
    const Vec2& q = p[i];
    if (q == a || q == b || q == c) return false;
    ++tests;
    return turn(a, b, q) >= 0 && turn(b, c, q) >= 0 && turn(c, a, q) >= 0;
  };
  if (grid != nullptr) {
    Eigen::AlignedBox2d box(a);
    const CornerGrid::Squares squares = grid->squares(box.extend(b).extend(c));
    if (squares.count() < n) return !grid->any(squares, is_inside);
  }
  return std::ranges::none_of(rest, is_inside);
}

void cut(const PolygonSoup& soup, std::span<const int> face, PolygonSoup& out) {
  std::vector<int> rest(face.size());
  for (std::size_t k = 0; k < rest.size(); ++k) rest[k] = k;
  const auto emit = [&](int a, int b, int c) {
    out.add_face(std::array{face[a], face[b], face[c]});
  };
  const std::vector<Vec2> p = face.size() > 3 ? flatten(soup, face) : std::vector<Vec2>{};
  constexpr std::size_t few = 64;  // corners that are tested one by one
  std::optional<CornerGrid> grid;
  if (p.size() > few) grid.emplace(p);
  long tests = 0;
  std::size_t k = 1, misses = 0;
  while (!p.empty() && rest.size() > 3 && misses < rest.size() && tests < max_tests) {
    const std::size_t n = rest.size();
    k %= n;
    if (!is_ear(p, rest, grid ? &*grid : nullptr, k, tests)) {
      ++k;
      ++misses;
      continue;
    }
    emit(rest[(k + n - 1) % n], rest[k], rest[(k + 1) % n]);
    if (grid) grid->remove(rest[k]);
    rest.erase(rest.begin() + k);
    misses = 0;
  }
  for (std::size_t i = 1; i + 1 < rest.size(); ++i) emit(rest[0], rest[i], rest[i + 1]);
}

}  // namespace

PolygonSoup triangulate(const PolygonSoup& soup) {
  PolygonSoup out;
  out.points = soup.points;
  out.lines = soup.lines;
  out.normals = soup.normals;
  out.scalars = soup.scalars;
  for (int f = 0; f < soup.n_faces(); ++f)
    if (soup.face(f).size() >= 3) cut(soup, soup.face(f), out);
  return out;
}

MatX3i triangles_of(const PolygonSoup& soup) {
  return Eigen::Map<const MatX3i>(soup.corners.data(), soup.n_faces(), 3);
}

PolygonSoup soup_of(const MatX3& points, const MatX3i& triangles) {
  PolygonSoup soup;
  soup.points = points;
  for (Eigen::Index f = 0; f < triangles.rows(); ++f)
    soup.add_face(std::array{triangles(f, 0), triangles(f, 1), triangles(f, 2)});
  return soup;
}

JoinedTriangles join_triangles(const PolygonSoup& first, const PolygonSoup& second) {
  const MatX3i a = triangles_of(triangulate(first)), b = triangles_of(second);
  JoinedTriangles out{MatX3(first.points.rows() + second.points.rows(), 3),
                      MatX3i(a.rows() + b.rows(), 3), a.rows()};
  out.points << first.points, second.points;
  out.triangles << a, b.array() + static_cast<int>(first.points.rows());
  return out;
}

}  // namespace littoral
