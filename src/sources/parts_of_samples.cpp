#include "sources/parts_of_samples.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "base/disjoint_sets.h"
#include "sources/space_distances.h"
#include "spatial/triangulate.h"

namespace littoral {

namespace {

/// The first vertex at the same place as each.
std::vector<int> first_at_place(const MatX3& points) {
  std::vector<int> order(static_cast<std::size_t>(points.rows()));
  std::iota(order.begin(), order.end(), 0);
  const auto less = [&](int a, int b) {
    for (int k = 0; k < 3; ++k)
      if (points(a, k) != points(b, k)) return points(a, k) < points(b, k);
    return a < b;
  };
  std::sort(order.begin(), order.end(), less);
  std::vector<int> first(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && points.row(order[i]) == points.row(order[i - 1]);
    first[order[i]] = same ? first[order[i - 1]] : order[i];
  }
  return first;
}

}  // namespace

std::vector<int> parts_of_samples(const PolygonSoup& surface, const OrientedPoints& samples) {
  std::vector<int> part(static_cast<std::size_t>(samples.size()), 0);
  if (surface.n_faces() == 0) return part;
  const PolygonSoup triangles = triangulate(surface);
  const std::vector<int> first = first_at_place(triangles.points);
  DisjointSets joined(triangles.n_vertices());
  for (int f = 0; f < triangles.n_faces(); ++f)
    for (int k = 1; k < 3; ++k)
      joined.join(first[triangles.face(f)[0]], first[triangles.face(f)[k]]);
  const NearestSource nearest(triangles, samples);
  std::map<int, int> number;
  for (std::size_t i = 0; i < part.size(); ++i) {
    const int f = nearest.triangle_at(samples.points.row(static_cast<Eigen::Index>(i)));
    const int root = joined.find(first[triangles.face(f)[0]]);
    part[i] = number.try_emplace(root, static_cast<int>(number.size())).first->second;
  }
  return part;
}

}  // namespace littoral
