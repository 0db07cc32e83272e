#include "api/samples/triangle_choice.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "littoral/error.h"

namespace littoral {

namespace {

struct CornerPoints {
  Vec3 a, b, c;
  Vec3 twice_area() const { return (b - a).cross(c - a); }
};

CornerPoints corners_of(const PolygonSoup& triangles, int f) {
  const auto face = triangles.face(f);
  return {triangles.points.row(face[0]), triangles.points.row(face[1]),
          triangles.points.row(face[2])};
}

}  // namespace

template <class Factor>
TriangleChoice TriangleChoice::weighted(const PolygonSoup& triangles, const Factor& factor) {
  TriangleChoice choice;
  choice.triangles_ = &triangles;
  double sum = 0;
  for (int f = 0; f < triangles.n_faces(); ++f)
    choice.sums_.push_back(sum += corners_of(triangles, f).twice_area().norm() * factor(f));
  return choice;
}

TriangleChoice TriangleChoice::by_area(const PolygonSoup& triangles) {
  TriangleChoice choice = weighted(triangles, [](int) { return 1.0; });
  if (choice.sums_.empty() || !(choice.sums_.back() > 0))
    throw InputError("the surface has no area", "empty-input");
  return choice;
}

TriangleChoice TriangleChoice::by_turn(const PolygonSoup& triangles) {
  MatX3 normals = MatX3::Zero(triangles.n_vertices(), 3);
  for (int f = 0; f < triangles.n_faces(); ++f) {
    const Vec3 normal = corners_of(triangles, f).twice_area();
    for (const int corner : triangles.face(f)) normals.row(corner) += normal;
  }
  normals.rowwise().normalize();
  TriangleChoice choice = weighted(triangles, [&](int f) {
    const auto face = triangles.face(f);
    double turn = 0;
    for (std::size_t k = 0; k < 3; ++k)
      turn = std::max(turn, (normals.row(face[k]) - normals.row(face[(k + 1) % 3])).norm());
    return turn < 1e-6 ? 0 : turn;  // less is rounding
  });
  return choice.sums_.empty() || !(choice.sums_.back() > 0) ? by_area(triangles) : choice;
}

PointOnTriangle TriangleChoice::choose(RandomNumbers& random) const {
  const double reached = random.uniform() * sums_.back();
  const auto found = std::upper_bound(sums_.begin(), sums_.end(), reached);
  const auto f =
      static_cast<int>(std::min<std::ptrdiff_t>(found - sums_.begin(), std::ssize(sums_) - 1));
  const CornerPoints t = corners_of(*triangles_, f);
  double u = random.uniform(), v = random.uniform();
  if (u + v > 1) {
    u = 1 - u;
    v = 1 - v;
  }
  return {t.a + u * (t.b - t.a) + v * (t.c - t.a), t.twice_area().normalized()};
}

}  // namespace littoral
