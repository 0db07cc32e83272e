// Unit vectors at all nodes of a grid from few: which are asked, and what the others get.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <set>
#include <vector>

#include "base/task.h"
#include "littoral/report.h"
#include "operators/grid.h"

namespace littoral {
namespace {

struct Sampled {
  Directions Y;
  std::vector<int> asked;  // how often each node was
  double told = 0;         // how many, by the report
};

template <class F>
Sampled sampled_directions(const Grid& grid, const F& flow) {
  Sampled out;
  out.asked.resize(grid.n_nodes());
  std::mutex one_at_a_time;
  Report report;
  out.Y = sample_directions(
      grid,
      [&](const Vec3* places, int n, Flow* flows) {
        const std::lock_guard lock(one_at_a_time);
        for (int i = 0; i < n; ++i) {
          std::array<int, 3> node{};
          for (int a = 0; a < 3; ++a) {
            const double at = (places[i][a] - grid.origin[a]) / grid.spacing[a];
            node[a] = static_cast<int>(std::lround(at));
            EXPECT_NEAR(at, node[a], 1e-9);
          }
          ++out.asked[grid.node(node[0], node[1], node[2])];
          flows[i] = flow(places[i]);
        }
      },
      Task(), report);
  out.told = report.sizes.back().second;
  return out;
}

int n_asked(const Sampled& all) {
  return static_cast<int>(std::count(all.asked.begin(), all.asked.end(), 1));
}

TEST(SampleDirections, FarFromSourcesCornersAndMiddlesOfLargeCellsAreEnoughForOneDirection) {
  const Vec3 y = Vec3(1, -2, 0.5).normalized();
  for (const auto& [n, stride] : {std::pair(std::array{41, 30, 17}, 8),
                                  {{33, 8, 2}, 8},
                                  {{32, 32, 32}, 4},
                                  {{5, 8, 3}, 1},
                                  {{9, 16, 1}, 2}}) {
    const Grid grid{n, Vec3(-1, 0, 2), Vec3(0.1, 0.2, 0.3)};
    const Sampled all = sampled_directions(grid, [&](const Vec3&) { return Flow{y, 1e9}; });
    std::set<std::size_t> expected;
    std::array<std::vector<std::array<int, 2>>, 3> ends;  // of cells, along each axis
    for (std::size_t a = 0; a < 3; ++a)
      for (int low = 0; low < std::max(1, n[a] - 1); low += stride)
        ends[a].push_back({low, std::min(low + stride, n[a] - 1)});
    for (const auto& x : ends[0])
      for (const auto& y_ends : ends[1])
        for (const auto& z : ends[2]) {
          for (int w = 0; w < 8; ++w)
            expected.insert(grid.node(x[w & 1], y_ends[w >> 1 & 1], z[w >> 2]));
          if (stride > 1)
            expected.insert(
                grid.node((x[0] + x[1]) / 2, (y_ends[0] + y_ends[1]) / 2, (z[0] + z[1]) / 2));
        }
    for (std::size_t v = 0; v < grid.n_nodes(); ++v) {
      EXPECT_EQ(all.asked[v], expected.count(v)) << stride << ", " << v;
      EXPECT_LT((all.Y.row(static_cast<Eigen::Index>(v)).transpose() - y.cast<float>()).norm(),
                1e-6f);
    }
    EXPECT_EQ(all.told, static_cast<double>(expected.size()));
  }
}

TEST(SampleDirections, AtSourcesEveryNodeIsAskedOnce) {
  const Grid grid{{19, 12, 30}, Vec3::Zero(), Vec3::Ones()};
  const auto y = [](const Vec3& x) {
    return Vec3(std::sin(x[0]), std::cos(x[1]), x[2]).normalized();
  };
  const Sampled all = sampled_directions(grid, [&](const Vec3& x) { return Flow{y(x), 0}; });
  EXPECT_EQ(n_asked(all), static_cast<int>(grid.n_nodes()));
  for (int k = 0; k < 30; ++k)
    for (int j = 0; j < 12; ++j)
      for (int i = 0; i < 19; ++i)
        EXPECT_EQ(Eigen::Vector3f(all.Y.row(static_cast<Eigen::Index>(grid.node(i, j, k)))),
                  Eigen::Vector3f(y(grid.point(i, j, k)).cast<float>()));
}

/// Away from a point beside or in a grid of 45 x 33 x 23 nodes, its axes in some order.
Sampled about_a_point(const std::array<int, 3>& axes, const Vec3& middle, Grid& grid) {
  const std::array<int, 3> n{45, 33, 23};
  const Vec3 spacing(0.05, 0.06, 0.08);
  Vec3 from;
  for (std::size_t a = 0; a < 3; ++a) {
    grid.n[a] = n[axes[a]];
    grid.spacing[a] = spacing[axes[a]];
    grid.origin[a] = 0;
    from[a] = middle[axes[a]];
  }
  return sampled_directions(grid, [&](const Vec3& x) {
    const double distance = (x - from).norm();
    return Flow{distance > 0 ? Vec3((x - from) / distance) : Vec3::Zero(), distance};
  });
}

TEST(SampleDirections, AreNearTheFieldEverywhereAndAsAccurateAlongEachAxis) {
  int asked_in_first = 0;
  for (const Vec3& middle :
       {Vec3(1.07, 0.93, 0.85), Vec3(-0.4, 0.3, 1.1), Vec3(2.3, 2.1, 0.2), Vec3(-2, -1, -3)}) {
    std::array<int, 3> axes{0, 1, 2};
    Grid first_grid;
    const Sampled first = about_a_point(axes, middle, first_grid);
    EXPECT_LT(n_asked(first), static_cast<int>(first_grid.n_nodes() / 2));
    asked_in_first += n_asked(first);
    do {
      Grid grid;
      const Sampled turned = about_a_point(axes, middle, grid);
      EXPECT_EQ(turned.told, n_asked(turned));
      EXPECT_EQ(*std::max_element(turned.asked.begin(), turned.asked.end()), 1);
      double sum = 0;
      for (int k = 0; k < 23; ++k)
        for (int j = 0; j < 33; ++j)
          for (int i = 0; i < 45; ++i) {
            const std::array<int, 3> node{i, j, k};
            const std::size_t here = first_grid.node(i, j, k);
            const std::size_t there = grid.node(node[axes[0]], node[axes[1]], node[axes[2]]);
            EXPECT_EQ(turned.asked[there], first.asked[here]);
            const Eigen::Vector3f y = turned.Y.row(static_cast<Eigen::Index>(there));
            Vec3 back;
            for (std::size_t a = 0; a < 3; ++a) back[axes[a]] = y[static_cast<Eigen::Index>(a)];
            const Vec3 x = first_grid.point(i, j, k);
            const double off = (back - (x - middle).normalized()).norm();
            EXPECT_LT(off, first.asked[here] ? 1e-6 : 0.1) << x.transpose();
            sum += off;
            EXPECT_LT(
                (back.cast<float>() - first.Y.row(static_cast<Eigen::Index>(here)).transpose())
                    .norm(),
                1e-5f);
            if (!first.asked[here]) {
              EXPECT_NEAR(y.norm(), 1, 1e-5);
            }
          }
      EXPECT_LT(sum / static_cast<double>(grid.n_nodes()), 0.008);
    } while (std::next_permutation(axes.begin(), axes.end()));
  }
  EXPECT_GT(asked_in_first, 1000);
}

}  // namespace
}  // namespace littoral
