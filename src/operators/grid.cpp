#include "operators/grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

#include "base/index.h"
#include "base/parallel.h"

namespace littoral {

VecX grid_divergence(const Grid& grid, const Directions& Y, const Task& task) {
  const int nx = grid.n[0], ny = grid.n[1], nz = grid.n[2];
  VecX b(grid.n_nodes());
  parallel_for(nz, 4, [&](std::size_t begin, std::size_t end) {
    task.checkpoint();
    for (int k = begin; k < index(end); ++k)
      for (int j = 0; j < ny; ++j)
        for (int i = 0; i < nx; ++i) {
          const Eigen::Index at = grid.node(i, j, k);
          const std::array<int, 3> place{i, j, k};
          Eigen::Index step = 1;
          double sum = 0;
          for (int a = 0; a < 3; ++a) {
            const std::size_t s = a;
            double flux = 0;  // through the edge before the node, minus that through the one after
            if (place[s] > 0) flux += 0.5 * (double(Y(at, a)) + Y(at - step, a));
            if (place[s] + 1 < grid.n[s]) flux -= 0.5 * (double(Y(at, a)) + Y(at + step, a));
            sum += flux / grid.spacing[a];
            step *= grid.n[s];
          }
          b[at] = sum;
        }
  });
  return b;
}

GridRows grid_rows(const Grid& grid, const MatX3& points, const VecX& weights,
                   const std::vector<int>& part, const std::vector<double>& value) {
  struct Place {
    std::size_t cell;
    int part;
    Eigen::Index point;
  };
  std::vector<Place> places;
  const auto lower = [&](Eigen::Index p, std::array<int, 3>& low, Vec3& t) {
    for (int a = 0; a < 3; ++a) {
      const int n = grid.n[a];
      const double u = (points(p, a) - grid.origin[a]) / grid.spacing[a];
      if (!(u >= 0 && u <= n - 1)) return false;
      low[a] = std::clamp(static_cast<int>(u), 0, std::max(0, n - 2));
      t[a] = u - low[a];
    }
    return true;
  };
  std::array<int, 3> low{};
  Vec3 t = Vec3::Zero();
  for (Eigen::Index p = 0; p < points.rows(); ++p)
    if (lower(p, low, t))
      places.push_back({grid.node(low[0], low[1], low[2]), part.empty() ? 0 : part[p], p});
  std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
    return std::tie(a.cell, a.part, a.point) < std::tie(b.cell, b.part, b.point);
  });
  // Row by row, as they are stored: there are so many columns that sorting by them takes long.
  std::vector<int> row_begin{0}, columns;
  std::vector<double> row_weight, row_value, coefficients;
  std::vector<int> row_part;
  for (std::size_t from = 0, to = 0; from < places.size(); from = to) {
    std::array<double, 8> sum{};
    double total = 0, valued = 0;
    for (to = from; to < places.size() && places[to].cell == places[from].cell &&
                    places[to].part == places[from].part;
         ++to) {
      const Eigen::Index p = places[to].point;
      lower(p, low, t);
      for (std::size_t c = 0; c < 8; ++c)
        sum[c] += weights[p] * (c & 1 ? t[0] : 1 - t[0]) * (c & 2 ? t[1] : 1 - t[1]) *
                  (c & 4 ? t[2] : 1 - t[2]);
      total += weights[p];
      if (!value.empty()) valued += weights[p] * value[p];
    }
    for (int c = 0; c < 8; ++c)  // in the order of the nodes
      if (sum[c] != 0) {
        columns.push_back(static_cast<int>(
            grid.node(low[0] + (c & 1), low[1] + (c >> 1 & 1), low[2] + (c >> 2))));
        coefficients.push_back(sum[c] / total);
      }
    row_begin.push_back(int_size(columns));
    row_weight.push_back(total);
    row_value.push_back(total > 0 ? valued / total : 0);
    if (!part.empty()) row_part.push_back(places[from].part);
  }
  GridRows rows;
  rows.part = std::move(row_part);
  rows.weight = Eigen::Map<const VecX>(row_weight.data(), row_weight.size());
  rows.value = Eigen::Map<const VecX>(row_value.data(), row_value.size());
  rows.A =
      Eigen::Map<const decltype(rows.A)>(rows.weight.size(), grid.n_nodes(), int_size(columns),
                                         row_begin.data(), columns.data(), coefficients.data());
  return rows;
}

}  // namespace littoral
