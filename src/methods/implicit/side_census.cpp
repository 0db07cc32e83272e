#include "methods/implicit/side_census.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/index.h"
#include "base/parallel.h"

namespace littoral {

namespace {

// Off the faces, which are about 1 across altogether: sheets that are nearer count as one. But no
// more than so much of the longest side of the face itself, as parts may be that small.
constexpr double off_face = 1e-6, off_face_of_side = 1e-3;
constexpr double certain = 0.01;  // winding numbers this far from the level are on one side of it

}  // namespace

SideCensus side_census(const MatX3& points, const MatX3i& faces, const WindingNumber& winding,
                       int places) {
  SideCensus census;
  std::vector<double> areas(faces.rows());
  double total = 0;
  std::vector<Vec3> normals(faces.rows());
  for (std::size_t f = 0; f < areas.size(); ++f) {
    const Vec3 a = points.row(faces(f, 0)), b = points.row(faces(f, 1)),
               c = points.row(faces(f, 2));
    const Vec3 n = (b - a).cross(c - a);
    if (n.allFinite()) total += n.norm();
    normals[f] = n.stableNormalized();
    areas[f] = total;
  }
  if (!(total > 0)) return census;
  const std::size_t n = places;
  census.face.resize(n);
  census.back.resize(n);
  census.front.resize(n);
  parallel_for(n, 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const double at = (static_cast<double>(i) + 0.5) / places * total;
      const auto f = std::min(index(areas.size()) - 1,
                              std::upper_bound(areas.begin(), areas.end(), at) - areas.begin());
      // Corners weighted by a sequence that fills the square evenly (Roberts' R2), folded over.
      double u = std::fmod(0.5 + 0.7548776662466927 * static_cast<double>(i), 1.0),
             v = std::fmod(0.5 + 0.5698402909980532 * static_cast<double>(i), 1.0);
      if (u + v > 1) u = 1 - u, v = 1 - v;
      const Vec3 x = (1 - u - v) * points.row(faces(f, 0)) + u * points.row(faces(f, 1)) +
                     v * points.row(faces(f, 2));
      census.face[i] = static_cast<int>(f);
      double longest = 0;
      for (int k = 0; k < 3; ++k)
        longest =
            std::max(longest, (points.row(faces(f, (k + 1) % 3)) - points.row(faces(f, k))).norm());
      const Vec3 off = std::min(off_face, off_face_of_side * longest) * normals[f];
      census.back[i] = winding(x - off);
      census.front[i] = winding(x + off);
    }
  });
  return census;
}

SideCensus::Shares SideCensus::shares(const SideRule& rule) const {
  Shares out;
  if (face.empty()) return out;
  const double one = 1.0 / static_cast<double>(face.size());
  for (std::size_t i = 0; i < face.size(); ++i) {
    double behind = rule.inside(back[i]), before = rule.inside(front[i]);
    if (rule.sense < 0) std::swap(behind, before);
    if (behind > certain && before < -certain)
      out.bounds += one;
    else if (behind > certain && before > certain)
      out.within += one;
    else if (!(before > certain && behind < -certain))  // not bounding the other way
      out.without += one;
  }
  return out;
}

SideRule choose_sides(const SideCensus& census, bool as_given) {
  const SideRule outward{1, 0.5}, inward{1, -0.5};
  if (census.shares(inward).bounds <= census.shares(outward).bounds) return outward;
  // The surface encloses the side that its normals point to.
  return as_given ? inward : SideRule{-1, 0.5};
}

}  // namespace littoral
