#include "api/space/thin_parts.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/index.h"
#include "base/option_table.h"
#include "base/parallel.h"

namespace littoral {

namespace {

constexpr double share_allowed = 0.01;  // of the surface
constexpr std::size_t most_measured = 2000;
constexpr double thinnest = 0.05;  // of those that are lost: as thick as these are to be held
constexpr double slack = 1.2;      // spacings in a part that is held for sure
constexpr double touching = 0.98;  // of its radius: how far a ball may be from the surface
constexpr int halvings = 12;
constexpr double largest_grid = 1024.0 * 1024 * 1024;  // of a grid that is worth naming

/// Which sides the eight nodes of the cell at x are on: 1 inside, 2 outside, 3 both; 3 beyond the
/// box, of which nothing is known.
int sides_at(const Vec3& x, const Grid& grid, const VecX& values) {
  std::array<int, 3> cell;
  for (int a = 0; a < 3; ++a) {
    const double at = std::floor((x[a] - grid.origin[a]) / grid.spacing[a]);
    if (!(at >= 0 && at < grid.n[a] - 1)) return 3;
    cell[a] = static_cast<int>(at);
  }
  int sides = 0;
  for (int c = 0; c < 8; ++c)
    sides |=
        values[index(grid.node(cell[0] + (c & 1), cell[1] + (c >> 1 & 1), cell[2] + (c >> 2)))] < 0
            ? 1
            : 2;
  return sides;
}

/// The diameter of the largest ball, up to 2 most, that touches the surface at x with its centre
/// along `to`, on the side where distance has this sign; 0 where there is none.
double thickness(const PointwiseDistance& distance, const Vec3& x, const Vec3& to, double sign,
                 double most) {
  double fits = 0, large = most;
  for (int i = 0; i < halvings; ++i) {
    const double radius = i == 0 ? most : (fits + large) / 2;
    (sign * distance.value(x + radius * to) >= touching * radius ? fits : large) = radius;
    if (fits == most) break;
  }
  return 2 * fits;
}

}  // namespace

void warn_of_thin_parts(const PointwiseDistance& distance, const OrientedPoints& samples,
                        const Grid& grid, const VecX& values, Report& report) {
  const double h = grid.spacing.maxCoeff();
  const auto n = std::size_t(samples.size());
  std::vector<char> sides(n);
  parallel_for(n, 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3 x = samples.points.row(index(i)), away = h * samples.normals.row(index(i));
      int both = sides_at(x, grid, values);
      if (both != 3) both |= sides_at(x - away, grid, values);
      if (both != 3) both |= sides_at(x + away, grid, values);
      sides[i] = static_cast<char>(both);
    }
  });
  std::vector<std::size_t> lost;
  double area = 0;
  for (std::size_t i = 0; i < n; ++i) {
    area += samples.areas[index(i)];
    if (sides[i] != 3) lost.push_back(i);
  }
  double thin = 0, looked_at = 0, all = 0;
  for (const std::size_t i : lost) all += samples.areas[index(i)];
  std::vector<std::pair<double, double>> found;  // thickness and area
  if (all > share_allowed * area) {
    const std::size_t step = lost.size() / most_measured + 1;
    for (std::size_t k = 0; k < lost.size(); k += step) {
      const Eigen::Index i = index(lost[k]);
      const double sign = sides[lost[k]] == 1 ? 1 : -1;  // of the side without nodes
      const Vec3 x = samples.points.row(i), normal = samples.normals.row(i);
      const double t = std::max(thickness(distance, x, normal, sign, h),
                                thickness(distance, x, -normal, sign, h));
      looked_at += samples.areas[i];
      if (t == 0 || t >= 2 * h) continue;
      found.emplace_back(t, samples.areas[i]);
      thin += samples.areas[i];
    }
  }
  const double share = looked_at > 0 ? thin / looked_at * all / area : 0;
  report.sizes.emplace_back("share of the area at parts thinner than a spacing", share);
  if (share <= share_allowed) return;
  std::sort(found.begin(), found.end());
  double below = 0, thickest = found.front().first;
  for (const auto& [t, a] : found) {
    thickest = t;
    below += a;
    if (below >= thinnest * thin) break;
  }
  const int nodes = *std::max_element(grid.n.begin(), grid.n.end());
  const double needed = std::ceil(slack * h / thickest * (nodes - 1)) + 1;
  report.sizes.emplace_back("resolution that holds the thin parts", needed);
  const double finer = needed / nodes;
  const bool feasible = static_cast<double>(grid.n_nodes()) * finer * finer * finer <= largest_grid;
  report.warn("thin-parts",
              percent_text(share) +
                  " of the surface bounds parts or gaps thinner than the grid's spacing with no "
                  "node in them: contours miss or tear them; " +
                  (feasible ? "option resolution " + number_text(needed) + " would hold them"
                            : "they are down to " + rounded_text(thickest) +
                                  " thick, too thin for a grid of this box: take smaller option "
                                  "bounds about them, or points of `littoral query`"));
}

}  // namespace littoral
