#pragma once
// Finer triangles of the same surface, and loops of edges on them.

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "littoral/polygon_soup.h"
#include "littoral/types.h"
#include "test_meshes.h"

namespace littoral::test {

/// Every triangle becomes four of the same shape; the first vertices stay. A curve of vertices
/// takes in the middles of its edges.
inline PolygonSoup quartered(const PolygonSoup& soup, std::vector<int>* curve = nullptr) {
  PolygonSoup fine;
  std::map<std::pair<int, int>, int> middles;
  std::vector<Vec3> points;
  for (int i = 0; i < soup.n_vertices(); ++i) points.emplace_back(soup.points.row(i));
  auto middle = [&](int i, int j) {
    const auto [at, fresh] =
        middles.try_emplace({std::min(i, j), std::max(i, j)}, static_cast<int>(points.size()));
    if (fresh) points.emplace_back(0.5 * (points[i] + points[j]));
    return at->second;
  };
  for (int f = 0; f < soup.n_faces(); ++f) {
    const auto c = soup.face(f);
    const int a = middle(c[0], c[1]), b = middle(c[1], c[2]), d = middle(c[2], c[0]);
    add_triangle(fine, c[0], a, d);
    add_triangle(fine, a, c[1], b);
    add_triangle(fine, d, b, c[2]);
    add_triangle(fine, a, b, d);
  }
  if (curve) {
    std::vector<int> longer;
    for (std::size_t k = 0; k < curve->size(); ++k) {
      longer.push_back((*curve)[k]);
      if (k + 1 < curve->size()) longer.push_back(middle((*curve)[k], (*curve)[k + 1]));
    }
    *curve = std::move(longer);
  }
  fine.points.resize(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i)
    fine.points.row(static_cast<Eigen::Index>(i)) = points[i];
  return fine;
}

/// The longest closed loop of edges around the faces whose vertices have d <= radius.
inline std::vector<int> loop_at(const PolygonSoup& soup, const VecX& d, double radius) {
  std::map<int, int> after;
  std::map<std::pair<int, int>, int> half;
  for (int f = 0; f < soup.n_faces(); ++f) {
    const auto c = soup.face(f);
    if (!(d[c[0]] <= radius && d[c[1]] <= radius && d[c[2]] <= radius)) continue;
    for (int k = 0; k < 3; ++k) half[{c[k], c[(k + 1) % 3]}] = 1;
  }
  for (const auto& [e, unused] : half)
    if (!half.contains({e.second, e.first})) after[e.first] = e.second;
  std::vector<int> best;
  while (!after.empty()) {
    std::vector<int> loop{after.begin()->first};
    while (after.contains(loop.back())) {
      const int i = loop.back();
      loop.push_back(after[i]);
      after.erase(i);
    }
    if (loop.front() == loop.back() && loop.size() > best.size()) best = loop;
  }
  return best;
}

}  // namespace littoral::test
