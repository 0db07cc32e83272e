#include "domain/mesh/nodal_surface.h"

#include <cmath>

namespace littoral {

Vec3 tangent_axis(const Vec3& n) {
  Eigen::Index smallest = 0;
  n.cwiseAbs().minCoeff(&smallest);
  const Vec3 e = Vec3::Unit(smallest);
  return (e - e.dot(n) * n).normalized();
}

Vec3 turned(const Vec3& v, const Vec3& a, const Vec3& b) {
  const double c = 1 + a.dot(b);
  if (!(c > 1e-12)) return (v - v.dot(b) * b).stableNormalized() * v.norm();
  return v - v.dot(b) / c * (a + b);
}

Vec3 normalized_or_z(const Vec3& v) {
  return v.squaredNorm() > 0 ? Vec3(v.stableNormalized()) : Vec3(Vec3::UnitZ());
}

Vec3 area_vector(const SurfaceMesh& refined, const IntrinsicTriangulation& T, int t) {
  Vec3 p[3];
  for (int k = 0; k < 3; ++k) p[k] = refined.point(T.faces(t, k)) / T.unit;
  return 0.5 * T.orientation[t] * (p[1] - p[0]).cross(p[2] - p[0]);
}

MatX3 vertex_area_vectors(const SurfaceMesh& refined, const IntrinsicTriangulation& T) {
  MatX3 sum = MatX3::Zero(refined.n_vertices(), 3);
  for (int t = 0; t < T.n_faces(); ++t)
    for (int k = 0; k < 3; ++k) sum.row(T.faces(t, k)) += area_vector(refined, T, t);
  return sum;
}

}  // namespace littoral
