#include "spatial/closest_on_triangle.h"

#include <algorithm>

namespace littoral {

namespace {

bool before(const Vec3& a, const Vec3& b) {
  return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

struct SegmentFoot {
  double weight_a = 1, weight_b = 0;
  Vec3 offset;
};

SegmentFoot closest_on_segment(const Vec3& a, const Vec3& b) {
  const bool swapped = before(b, a);
  const Vec3& p = swapped ? b : a;
  const Vec3& r = swapped ? a : b;
  const Vec3 d = r - p;
  const double length2 = d.squaredNorm();
  SegmentFoot foot;
  double from_p = 0;
  if (length2 > 0) from_p = std::clamp(-p.dot(d) / length2, 0.0, 1.0);
  double from_r = 1 - from_p;
  if (from_p > 0.5) {  // measured from the nearer end: relative accuracy there
    from_r = std::clamp(r.dot(d) / length2, 0.0, 1.0);
    from_p = 1 - from_r;
    foot.offset = r - from_r * d;
  } else {
    foot.offset = p + from_p * d;
  }
  foot.weight_a = swapped ? from_p : from_r;
  foot.weight_b = swapped ? from_r : from_p;
  return foot;
}

}  // namespace

TriangleFoot closest_on_triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3* corner[3] = {&a, &b, &c};
  TriangleFoot best;
  // Mostly a corner: where both its sides lead away from the query, more so than rounding could.
  for (int k = 0; k < 3; ++k) {
    const Vec3 &p = *corner[k], &q = *corner[(k + 1) % 3], &r = *corner[(k + 2) % 3];
    const double least = 1e-14 * (p.cwiseAbs().sum() * (q.cwiseAbs().sum() + r.cwiseAbs().sum()));
    if (p.dot(q - p) > least && p.dot(r - p) > least) {
      best.barycentric = {0, 0, 0};
      best.barycentric[k] = 1;
      best.offset = p;
      best.squared = p.squaredNorm();
      return best;
    }
  }
  double longest = -1;
  int base = 0;
  for (int k = 0; k < 3; ++k) {
    const Vec3 &p = *corner[k], &q = *corner[(k + 1) % 3];
    const SegmentFoot foot = closest_on_segment(p, q);
    const double squared = foot.offset.squaredNorm();
    if (k == 0 || squared < best.squared) {
      best.barycentric = {0, 0, 0};
      best.barycentric[k] = foot.weight_a;
      best.barycentric[(k + 1) % 3] = foot.weight_b;
      best.offset = foot.offset;
      best.squared = squared;
    }
    const double length2 = (q - p).squaredNorm();
    if (length2 > longest) {
      longest = length2;
      base = k;
    }
  }

  // The inside: coordinates along the longest side and the height over it, orthogonalised twice,
  // stay accurate for needles. A height below rounding of the side leaves nothing inside.
  const int i0 = base, i1 = (base + 1) % 3, i2 = (base + 2) % 3;
  const Vec3& origin = *corner[i0];
  const Vec3 side = *corner[i1] - origin, edge = *corner[i2] - origin;
  if (!(longest > 0)) return best;
  Vec3 height = edge - side * (edge.dot(side) / longest);
  height -= side * (height.dot(side) / longest);
  const double height2 = height.squaredNorm();
  if (!(height2 > 1e-30 * longest)) return best;

  double along = 0, up = 0;
  Vec3 foot = origin;
  for (int step = 0; step < 2; ++step) {  // the second step removes the rounding of the first
    const double more_up = -foot.dot(height) / height2;
    along += (-foot - more_up * edge).dot(side) / longest;
    up += more_up;
    foot = origin + along * side + up * edge;
  }
  const double rest = 1 - along - up;
  if (along > 0 && up > 0 && rest > 0 && along < 1 && up < 1) {
    const double squared = foot.squaredNorm();
    if (squared < best.squared) {
      best.barycentric[i0] = rest;
      best.barycentric[i1] = along;
      best.barycentric[i2] = up;
      best.offset = foot;
      best.squared = squared;
    }
  }
  return best;
}

}  // namespace littoral
