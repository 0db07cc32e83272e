#include "spatial/prepared_triangles.h"

#include <algorithm>
#include <cmath>

#include "base/index.h"

namespace littoral {

namespace {

/// What the kernel needs, relative to the frame of the tree. False for triangles so thin that
/// their plane is not known to all digits.
bool set_triangle(const std::array<Vec3, 3>& corners, NearTriangle<double>& t) {
  double longest = 0;
  std::array<Vec3, 3> edge;
  for (std::size_t k = 0; k < 3; ++k) {
    edge[k] = corners[(k + 1) % 3] - corners[k];
    const double length2 = edge[k].squaredNorm();
    t.per_length[k] = length2 > 0 ? 1 / length2 : 0;
    longest = std::max(longest, length2);
  }
  const auto cross = [](const Vec3& a, const Vec3& b) {
    return Vec3(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]);
  };
  const Vec3 n = cross(edge[0], edge[1]);
  const double area2 = n.squaredNorm();
  t.per_normal = area2 > 0 ? 1 / area2 : 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 inward = cross(n, edge[k]);
    for (std::size_t d = 0; d < 3; ++d) {
      t.corner[k][d] = corners[k][index(d)];
      t.edge[k][d] = edge[k][index(d)];
      t.inward[k][d] = inward[index(d)];
      t.normal[d] = n[index(d)];
    }
  }
  // Height over the longest side: a thousandth of it, and of the size of all triangles 1e-9.
  return area2 >= 1e-6 * longest * longest && area2 >= 1e-18 * longest;
}

/// The same in single precision, with a normal and directions inward of unit length.
NearTriangle<float> in_single(const NearTriangle<double>& t) {
  const auto rounded = [](const std::array<double, 3>& v, double scale) {
    return std::array<float, 3>{static_cast<float>(v[0] * scale), static_cast<float>(v[1] * scale),
                                static_cast<float>(v[2] * scale)};
  };
  NearTriangle<float> out;
  const double per_normal = std::sqrt(t.per_normal);
  for (std::size_t k = 0; k < 3; ++k) {
    out.corner[k] = rounded(t.corner[k], 1);
    out.edge[k] = rounded(t.edge[k], 1);
    out.per_length[k] = static_cast<float>(t.per_length[k]);
    out.inward[k] = rounded(t.inward[k], per_normal * std::sqrt(t.per_length[k]));
  }
  out.normal = rounded(t.normal, per_normal);
  out.per_normal = 1;
  return out;
}

}  // namespace

void PreparedTriangles::set(int triangle, const std::array<Vec3, 3>& corners,
                            PreparedTriangle& out) {
  out.triangle = triangle;
  out.plane = set_triangle(corners, out.exact);
  if (out.plane) out.rough = in_single(out.exact);
}

}  // namespace littoral
