#include "spatial/boundary_edges.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "base/index.h"

namespace littoral {

std::vector<int> same_positions(const MatX3& points) {
  const auto key = [&](int v) { return std::array{points(v, 0), points(v, 1), points(v, 2)}; };
  std::vector<int> order, first(points.rows());
  for (int v = 0; v < index(first.size()); ++v) {
    first[v] = v;
    if (points.row(v).allFinite()) order.push_back(v);
  }
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    const auto p = key(a), q = key(b);
    return p < q || (p == q && a < b);
  });
  for (std::size_t i = 1; i < order.size(); ++i)
    if (key(order[i]) == key(order[i - 1])) first[order[i]] = first[order[i - 1]];
  return first;
}

std::vector<std::array<int, 2>> boundary_chain(const MatX3& points, const MatX3i& faces) {
  const std::vector<int> first = same_positions(points);
  struct Side {
    std::pair<int, int> ends;  // the lower first
    int count;                 // 1 from the lower to the higher, -1 back
  };
  std::vector<Side> sides;
  sides.reserve(3 * faces.rows());
  for (Eigen::Index f = 0; f < faces.rows(); ++f) {
    bool finite = true;
    for (int k = 0; k < 3; ++k) finite = finite && points.row(faces(f, k)).allFinite();
    if (!finite) continue;
    for (int k = 0; k < 3; ++k) {
      const int a = first[faces(f, k)], b = first[faces(f, (k + 1) % 3)];
      if (a != b) sides.push_back({std::minmax({a, b}), a < b ? 1 : -1});
    }
  }
  std::sort(sides.begin(), sides.end(),
            [](const Side& a, const Side& b) { return a.ends < b.ends; });
  std::vector<std::array<int, 2>> out;
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    int sum = 0;
    for (; end < sides.size() && sides[end].ends == sides[begin].ends; ++end)
      sum += sides[end].count;
    const auto [a, b] = sides[begin].ends;
    for (; sum > 0; --sum) out.push_back({a, b});
    for (; sum < 0; ++sum) out.push_back({b, a});
  }
  return out;
}

std::vector<std::array<int, 2>> boundary_edges(const MatX3& points, const MatX3i& faces) {
  std::vector<std::array<int, 2>> edges = boundary_chain(points, faces);
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

}  // namespace littoral
