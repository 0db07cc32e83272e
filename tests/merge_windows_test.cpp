// Windows made one by a tolerance: what that does to distances on the edge, and on whole meshes.

#include "methods/geodesic/merge_windows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include "base/parallel.h"
#include "geodesic_helpers.h"
#include "methods/geodesic/window_kernels.h"
#include "window_blocks.h"

namespace littoral {
namespace {

Window rays(double x, double y, double behind, double b0, double b1) {
  Window w;
  w.x = x;
  w.y = y;
  w.behind = behind;
  w.b0 = b0;
  w.b1 = b1;
  w.source = 3;
  w.page = 0;
  w.measure_ends();
  return w;
}

WindowBlock block_of(const std::vector<Window>& windows) {
  WindowBlock block;
  for (const Window& w : windows) test_blocks().push_back(block, w);
  return block;
}

/// n neighbours on [0, 1], each from an image that lies a little beside the one before it and is as
/// near where the two meet.
std::vector<Window> chain(std::mt19937& random, int n, double beside) {
  std::uniform_real_distribution<double> u(-1, 1);
  std::vector<double> ends{0, 1};
  while (int(ends.size()) <= n) ends.push_back(0.5 * (u(random) + 1));
  std::sort(ends.begin(), ends.end());
  std::vector<Window> out{rays(u(random), -3 - 2 * u(random), 1, ends[0], ends[1])};
  for (int i = 1; i < n; ++i) {
    const Window& last = out.back();
    Window w =
        rays(last.x + beside * u(random), last.y + beside * u(random), 0, ends[i], ends[i + 1]);
    w.behind = last.d1 - w.at(ends[i]);
    w.measure_ends();
    out.push_back(w);
  }
  return out;
}

const Window& at(const std::vector<Window>& windows, double p) {
  for (const Window& w : windows)
    if (p <= w.b1) return w;
  return windows.back();
}

TEST(MergeWindows, PiecesOfOneWindowAreThatWindow) {
  std::mt19937 random(1);
  for (int n = 4; n < 40; ++n) {
    const std::vector<Window> pieces = chain(random, n, 0);
    WindowBlock all = block_of(pieces);
    EXPECT_LE(merge_windows(all, 1, 1e-9, 0), 1e-12);
    ASSERT_EQ(all.size(), 1u);
    EXPECT_EQ(all[0].b0, 0);
    EXPECT_EQ(all[0].b1, 1);
    for (double p : {0.0, 0.3, 1.0})
      EXPECT_NEAR(all[0].at(p, 2), pieces[0].at(p, 2), 1e-6);  // far beyond the edge, too
  }
}

TEST(MergeWindows, ChangeNoDistanceByMoreThanTheySayAndCoverWhatTheyReplace) {
  std::mt19937 random(2);
  int before = 0, after = 0;
  for (int k = 0; k < 500; ++k) {
    const std::vector<Window> old = chain(random, 4 + k % 20, 1e-3);
    WindowBlock all = block_of(old);
    const double tolerance = k % 2 ? 1e-5 : 1e-4, error = k % 3 ? 0 : 1e-5;
    const double changed = merge_windows(all, 1, tolerance, error);
    std::vector<Window> made;
    double most = 0;
    for (std::size_t i = 0; i < all.size(); ++i) made.push_back(all[i]);
    for (const Window& w : old) most = std::max({most, w.d0, w.d1});
    EXPECT_LE(changed, tolerance * most);
    EXPECT_EQ(made.front().b0, 0);
    EXPECT_EQ(made.back().b1, 1);
    for (std::size_t i = 1; i < made.size(); ++i) EXPECT_EQ(made[i].b0, made[i - 1].b1);
    for (int i = 0; i <= 1000; ++i) {
      const double p = 1e-3 * i;
      EXPECT_NEAR(at(old, p).at(p), at(made, p).at(p), changed + 1e-14) << k << " " << p;
    }
    for (const Window& w : made) {  // its outermost rays lean outward at least as much
      EXPECT_LE(w.slope(w.b0), at(old, w.b0 + 1e-12).slope(w.b0) + 1e-12);
      EXPECT_GE(w.slope(w.b1), at(old, w.b1).slope(w.b1) - 1e-12);
    }
    before += int(old.size());
    after += int(made.size());
  }
  EXPECT_LT(after, before / 2);
}

TEST(MergeWindows, PairsAreFoundAtOnceAsOneByOne) {
  std::mt19937 random(4);
  std::uniform_int_distribution<int> die(0, 11);
  int joined = 0, all = 0;
  for (int k = 0; k < 300; ++k) {
    std::vector<Window> windows = chain(random, 2 + k % 150, k % 2 ? 1e-3 : 1e-2);
    for (Window& w : windows) switch (die(random)) {
        case 0:
          w.source = 4;
          break;
        case 1:
          w.page = 1;
          break;
        case 2:
          w.open = false;
          break;
        case 3:
          w.b1 -= 1e-2 * (w.b1 - w.b0);
          break;
        case 4:
          w.depth = 7;
          break;
        case 5:
          w.parallel = true;
          break;
        default:
          break;
      }
    const WindowBlock block = block_of(windows);
    for (const Joining& how : {Joining{1e-12, 1e-4, 0}, {1e-12, 1e-4, 1e-4}, {1e-2, 1e-5, 0}})
      for (std::size_t first = 0; first + 1 < windows.size(); first += 64) {
        const std::uint64_t pairs = window_kernels().pairs(block, first, how);
        EXPECT_EQ(plain_window_kernels.pairs(block, first, how), pairs);
        for (std::size_t i = first; i < std::min(first + 64, windows.size() - 1); ++i, ++all) {
          double changed = 0;
          const bool one = one_of(block, i, i + 2, how, changed).has_value();
          EXPECT_EQ(pairs >> (i - first) & 1, one ? 1u : 0u) << k << " " << i;
          joined += one;
        }
      }
  }
  EXPECT_GT(joined, all / 10);
  EXPECT_LT(joined, all / 2);
}

TEST(MergeWindows, LeaveAloneWhatIsNotOfOneKind) {
  std::mt19937 random(3);
  const std::vector<Window> whole = chain(random, 8, 0);
  const auto left = [&](const auto& change, double tolerance = 1e-3, double error = 0) {
    std::vector<Window> windows = whole;
    for (std::size_t i = 0; i < windows.size(); i += 2) change(windows[i]);
    WindowBlock all = block_of(windows);
    EXPECT_EQ(merge_windows(all, 1, tolerance, error), 0);
    return all.size();
  };
  EXPECT_EQ(left([](Window& w) { w.source = 4; }), 8u);
  EXPECT_EQ(left([](Window& w) { w.page = 1; }), 8u);
  EXPECT_EQ(left([](Window& w) { w.open = false; }), 8u);
  EXPECT_EQ(left([](Window& w) {
              w.b0 += 1e-3 * (w.b1 - w.b0);
              w.b1 -= 1e-3 * (w.b1 - w.b0);
            }),
            8u);
  EXPECT_EQ(left([](Window& w) {
              w.parallel = true;
              w.x = 0.6;
              w.y = 0.8;
            }),
            8u);
  const auto nothing = [](Window&) {};
  EXPECT_EQ(left(nothing, 0), 8u);
  EXPECT_EQ(left(nothing, 1e-6, 1), 8u);  // all that is allowed is spent
}

/// Values and windows with a tolerance, checked against those without.
void expect_within(const SurfaceMesh& mesh, const Sources& sources, double fewer) {
  Report report;
  const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
  const TriangleSources on = triangle_sources(mesh, T, place_sources(mesh, sources, report));
  const auto windows = [](const Report& r) { return r.iterations.back().second; };
  Report exactly;
  const VecX exact = exact_polyhedral(T, on, {}, exactly).distance;
  for (const double tolerance : {1e-7, 1e-5, 1e-3}) {
    Report with;
    const ExactDistance merged = exact_polyhedral(T, on, {}, with, {0, tolerance});
    const double said = with.residuals.back().second;
    EXPECT_LE(said, tolerance);
    for (Eigen::Index v = 0; v < exact.size(); ++v) {
      if (!(exact[v] < infinity)) {
        EXPECT_EQ(merged.distance[v], infinity);
        continue;
      }
      EXPECT_NEAR(merged.distance[v], exact[v], (tolerance + 1e-11) * exact[v]) << v;
    }
    if (tolerance == 1e-3) {
      EXPECT_LT(windows(with), fewer * windows(exactly));
      EXPECT_GT(said, 0);
    }
  }
}

TEST(ExactWithATolerance, IsThatNear) {
  PolygonSoup bumps = test::octasphere_soup(5);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> u(-1, 1);
  for (Eigen::Index v = 0; v < bumps.points.rows(); ++v)
    bumps.points.row(v) *= 1 + 0.1 * std::sin(5 * bumps.points(v, 0)) + 1e-3 * u(random);
  const SurfaceMesh mesh(bumps);
  expect_within(mesh, test::vertex_points({0}), 0.6);
  expect_within(mesh, test::vertex_points({17, 1203}), 0.6);
  expect_within(mesh, test::space_curve(test::circle(0, 0, 0.6, 0.8, 100)), 0.9);
}

TEST(ExactWithATolerance, HasTheSameBitsOnAnyNumberOfThreads) {
  const SurfaceMesh mesh(test::octasphere_soup(6));
  Report report;
  const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
  const TriangleSources on =
      triangle_sources(mesh, T, place_sources(mesh, test::vertex_points({3}), report));
  const int threads = requested_thread_count();
  set_thread_count(1);
  const VecX one = exact_polyhedral(T, on, {}, report, {0, 1e-5}).distance;
  set_thread_count(3);
  const VecX three = exact_polyhedral(T, on, {}, report, {0, 1e-5}).distance;
  set_thread_count(threads);
  EXPECT_EQ(one, three);
}

}  // namespace
}  // namespace littoral
