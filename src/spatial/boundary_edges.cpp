#include "spatial/boundary_edges.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "base/index.h"
#include "base/same_rows.h"
#include "spatial/covered_triangles.h"
#include "spatial/finite_box.h"

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

namespace {

/// A side between two vertices, the lower first, run along so many times from the lower to the
/// higher, less those back.
struct CountedSide {
  std::pair<int, int> ends;
  int count;
};

CountedSide side_between(int a, int b) { return {std::minmax({a, b}), a < b ? 1 : -1}; }

}  // namespace

std::vector<std::array<int, 2>> boundary_chain(const MatX3& points, const MatX3i& faces,
                                               std::vector<char>* nothing) {
  const std::vector<int> first = same_positions(points);
  std::vector<CountedSide> sides;
  struct Flat {
    Eigen::Index face;
    std::array<CountedSide, 3> around;
  };
  std::vector<Flat> flat;
  if (nothing) nothing->assign(faces.rows(), 0);
  sides.reserve(3 * faces.rows());
  const double size = points_size(points);
  for (Eigen::Index f = 0; f < faces.rows(); ++f) {
    std::array<int, 3> at;
    bool finite = true;
    for (int k = 0; k < 3; ++k) {
      finite = finite && points.row(faces(f, k)).allFinite();
      at[k] = first[faces(f, k)];
    }
    if (!finite || at[0] == at[1] || at[1] == at[2] || at[2] == at[0]) continue;
    const std::array<CountedSide, 3> around{side_between(at[0], at[1]), side_between(at[1], at[2]),
                                            side_between(at[2], at[0])};
    sides.insert(sides.end(), around.begin(), around.end());
    if (is_flat(points.row(faces(f, 0)), points.row(faces(f, 1)), points.row(faces(f, 2)), size))
      flat.push_back({f, around});
  }
  const auto before = [](const CountedSide& a, const CountedSide& b) { return a.ends < b.ends; };
  std::sort(sides.begin(), sides.end(), before);
  std::size_t n = 0;  // sums of sides that are the same
  for (std::size_t i = 0; i < sides.size(); ++i) {
    if (n > 0 && sides[n - 1].ends == sides[i].ends)
      sides[n - 1].count += sides[i].count;
    else
      sides[n++] = sides[i];
  }
  sides.resize(n);
  for (const auto& [face, around] : flat) {
    std::array<int*, 3> sums;
    for (std::size_t k = 0; k < 3; ++k)
      sums[k] = &std::lower_bound(sides.begin(), sides.end(), around[k], before)->count;
    bool free = true;
    for (std::size_t k = 0; k < 3; ++k) free = free && *sums[k] * around[k].count > 0;
    if (!free) continue;
    for (std::size_t k = 0; k < 3; ++k) *sums[k] -= around[k].count;
    if (nothing) (*nothing)[face] = 1;
  }
  std::vector<std::array<int, 2>> out;
  for (const CountedSide& side : sides) {
    const auto [a, b] = side.ends;
    for (int i = side.count; i > 0; --i) out.push_back({a, b});
    for (int i = side.count; i < 0; ++i) out.push_back({b, a});
  }
  return out;
}

MatX3i without_copies(const MatX3& points, const MatX3i& faces) {
  const std::vector<int> first = same_positions(points);
  std::vector<std::array<int, 3>> keys(faces.rows());  // corners, the lowest first
  for (int f = 0; f < index(keys.size()); ++f) {
    for (int k = 0; k < 3; ++k) keys[f][k] = first[faces(f, k)];
    std::rotate(keys[f].begin(), std::min_element(keys[f].begin(), keys[f].end()), keys[f].end());
  }
  const std::vector<int> kept = first_of_each(keys);
  return faces(kept, Eigen::all);
}

std::vector<std::array<int, 2>> each_once(std::vector<std::array<int, 2>> chain) {
  chain.erase(std::unique(chain.begin(), chain.end()), chain.end());
  return chain;
}

std::vector<std::array<int, 2>> boundary_edges(const MatX3& points, const MatX3i& faces) {
  return each_once(boundary_chain(points, faces));
}

}  // namespace littoral
