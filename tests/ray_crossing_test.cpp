// Windows on their way through a triangle: many at once as one by one, and what leaves a vertex.

#include "methods/geodesic/ray_crossing.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>

#include "test_meshes.h"
#include "window_blocks.h"

namespace littoral {
namespace {

/// The lower envelope on an edge of points below it, some with parallel rays among them.
WindowBlock crossing_windows(std::mt19937& random, double length, int n) {
  std::uniform_real_distribution<double> u(0, 1);
  EdgeEnvelopes all(test_memory());
  WindowList list;
  const bool same_behind = random() % 2 == 0;
  for (int i = 0; i < n; ++i) {
    Window w;
    w.b1 = length;
    w.x = length * (3 * u(random) - 1);
    w.y = -1 - 0.1 * u(random);
    w.behind = same_behind ? 0 : 0.1 * u(random);
    if (random() % 16 == 0) {
      const double angle = 1 + u(random);
      w.parallel = true;
      w.x = std::cos(angle);
      w.y = std::sin(angle);
      w.behind += 1;
    }
    w.source = i;
    w.measure_ends();
    all.insert(list, length, w);
  }
  for (std::size_t i = 0; i < list.windows.size(); ++i) {  // gaps, as beside a vertex that shades
    if (random() % 4 != 0) continue;
    Window w = list.windows[i];
    w.b1 -= u(random) * (w.b1 - w.b0);
    w.measure_ends();
    list.windows.set(i, w);
  }
  return std::move(list.windows);
}

/// All numbers that a bundle has found out, but for what it may leave unset.
std::vector<double> found_numbers(const RayColumns& c, int first, int last) {
  std::vector<double> out;
  for (int i = first; i < last; ++i) {
    for (const double* column :
         {c.apex0, c.apex1, c.to0, c.to1, c.to_d0, c.to_d1, c.to_x, c.to_y, c.to_behind})
      out.push_back(column[i]);
    for (const std::int64_t* column : {c.covers, c.goes, c.ends}) out.push_back(double(column[i]));
    if (i + 1 == last) break;
    out.push_back(double(c.follows[i]));
    for (const double* column : {c.cut, c.cut_first, c.cut_second}) out.push_back(column[i]);
    out.push_back(double(c.meets[i]));
  }
  return out;
}

struct CrossedTriangle {
  double length;
  TriangleAbove above;
  RayExit exit;
  EdgeEnds ends;
};

CrossedTriangle crossed_triangle(std::mt19937& random) {
  std::uniform_real_distribution<double> u(0, 1);
  const double length = 0.5 + u(random);
  const TriangleAbove above{length, Complex(length * (1.5 * u(random) - 0.25), 0.3 + u(random))};
  const bool right = random() % 2 == 0, from_apex = random() % 2 == 0;
  const double side = std::abs(above.apex - (right ? length : 0.0));
  const double far = random() % 2 == 0 ? 100 : 1.5;  // ends that cut nothing, or something
  return {length, above, RayExit(above, side, right, from_apex),
          EdgeEnds(far + u(random), far + u(random), side)};
}

TEST(RayCrossing, KernelsOfAnyWidthGiveTheSameBits) {
  if (ray_kernels().leave_through == plain_ray_kernels.leave_through)
    GTEST_SKIP() << "this processor has one width only";
  std::mt19937 random(1);
  for (int round = 0; round < 2000; ++round) {
    const CrossedTriangle t = crossed_triangle(random);
    const WindowBlock windows = crossing_windows(random, t.length, 1 + round % 30);
    const int n = int(windows.size()), first = int(random() % std::size_t(n)),
              last = first + 1 + int(random() % std::size_t(n - first));
    std::vector<double> found[2];
    for (const bool plain : {true, false}) {
      RayBundle rays(plain ? plain_ray_kernels : ray_kernels());
      rays.use(windows);
      rays.look_at(t.above, 1e-9 * t.length);
      rays.see_where_to({t.above.apex.real(), t.above.apex.imag(), 0.45 * t.length, 0.55 * t.length,
                         1.3, 1, 1e-12, round % 3 == 0 ? 1 : Window::deep + 1});
      rays.leave(t.above, t.exit, t.ends, first, last);
      found[plain] = found_numbers(rays.columns(), first, last);
      const WindowKernels& kernels = plain ? plain_window_kernels : window_kernels();
      found[plain].push_back(kernels.least(windows, std::size_t(first), std::size_t(last)));
      found[plain].push_back(kernels.all_whole(windows, t.ends));
      WindowBlock batch = test_blocks().take(std::size_t(last - first));
      rays.put(first, last, t.exit.turned(), 3, batch);
      for (std::size_t i = 0; i < batch.size(); ++i) {
        const Window w = batch[i];
        for (const double number : {w.b0, w.b1, w.d0, w.d1, w.x, w.y, w.behind})
          found[plain].push_back(number);
        found[plain].push_back(double(WindowTag::of(w)));
      }
    }
    ASSERT_EQ(found[0].size(), found[1].size());
    for (std::size_t i = 0; i < found[0].size(); ++i) {
      // Numbers of windows that do not go there may be none.
      if (std::isnan(found[0][i]) && std::isnan(found[1][i])) continue;
      ASSERT_EQ(std::bit_cast<std::uint64_t>(found[0][i]),
                std::bit_cast<std::uint64_t>(found[1][i]))
          << round << ": number " << i << " of " << found[0].size();
    }
  }
}

TEST(RayCrossing, WindowsThatLeaveSayWhichEndsReachThemSooner) {
  std::mt19937 random(6);
  std::array<int, 8> seen{};
  for (int round = 0; round < 2000; ++round) {
    const CrossedTriangle t = crossed_triangle(random);
    const WindowBlock windows = crossing_windows(random, t.length, 20);
    for (const RayKernels* kernels : {&plain_ray_kernels, &ray_kernels()}) {
      RayBundle rays(*kernels);
      rays.use(windows);
      rays.look_at(t.above, 1e-9 * t.length);
      const double crossing = t.exit.right ? -1 : 2 * t.length;
      rays.see_where_to({t.above.apex.real(), t.above.apex.imag(), crossing, crossing, infinity,
                         infinity, 0, Window::deep + 1});
      rays.leave(t.above, t.exit, t.ends, 0, rays.size());
      const RayColumns& c = rays.columns();
      for (int i = 0; i < rays.size(); ++i) {
        if (!(c.goes[i] & (t.exit.right ? 2 : 1))) continue;
        const Window w = rays.left_as(i, 0);
        const EdgeEnds& e = t.ends;
        const std::int64_t sooner = (w.d0 > e.tail + w.b0 + e.tail_slack ? 1 : 0) |
                                    (w.d1 > e.head + (e.length - w.b1) + e.head_slack ? 2 : 0) |
                                    (w.b1 - w.b0 > e.narrow() ? 0 : 4);
        ASSERT_EQ(c.ends[i], sooner) << round << " " << i;
        ++seen[std::size_t(sooner)];
      }
    }
  }
  for (const int sooner : {0, 1, 2}) EXPECT_GT(seen[std::size_t(sooner)], 100) << sooner;
}

/// What the kernels say of two neighbours is what comparing the two finds.
TEST(RayCrossing, KernelsCutNeighboursWhereComparingThemDoes) {
  std::mt19937 random(2);
  int n_cut = 0, n_before_end = 0, n_apart = 0, n_put = 0;
  for (int round = 0; round < 3000; ++round) {
    const CrossedTriangle t = crossed_triangle(random);
    const WindowBlock windows = crossing_windows(random, t.length, 20);
    RayBundle rays;
    rays.use(windows);
    rays.look_at(t.above, 1e-9 * t.length);
    const double crossing = t.exit.right ? -1 : 2 * t.length;
    rays.see_where_to({t.above.apex.real(), t.above.apex.imag(), crossing, crossing, infinity,
                       infinity, 0, Window::deep + 1});
    const RayColumns& c = rays.columns();
    rays.leave(t.above, t.exit, t.ends, 0, rays.size());
    for (int i = 0; i + 1 < rays.size(); ++i) {
      const std::int64_t side = t.exit.right ? 2 : 1;
      const int before = t.exit.turned() ? i + 1 : i, after = t.exit.turned() ? i : i + 1;
      if (!(c.goes[i] & c.goes[i + 1] & side) || (c.ends[i] | c.ends[i + 1]) != 0 ||
          c.meets[i] == unclear)
        continue;
      const Window o = rays.left_as(before, 0), w = rays.left_as(after, 0);
      WindowBlock batch, both;
      test_blocks().push_back(batch, o);
      test_blocks().push_back(batch, w);
      EdgeEnvelopes envelopes(test_memory());
      ASSERT_TRUE(envelopes.settle(batch, t.ends.length)) << round;
      if (c.meets[i] == apart) {
        ++n_apart;
        EXPECT_EQ(batch[0].b1, o.b1);
        EXPECT_EQ(batch[1].b0, w.b0);
        continue;
      }
      if (!(c.cut[i] - o.b0 > t.ends.narrow())) continue;  // left to the comparison
      if (c.follows[i]) {                                  // what is put is cut there
        ++n_put;
        test_blocks().make_room(both, 2);
        rays.put(i, i + 2, t.exit.turned(), 7, both);
        EXPECT_EQ(both[0].b1, c.cut[i]);
        EXPECT_EQ(both[0].d1, c.cut_first[i]);
        EXPECT_EQ(both[1].b0, c.cut[i]);
        EXPECT_EQ(both[1].d0, c.cut_second[i]);
        EXPECT_EQ(both[1].b1, w.b1);
        EXPECT_EQ(both[0].x, o.x);
        EXPECT_EQ(both[1].behind, w.behind);
        EXPECT_EQ(both[0].source, o.source);
        EXPECT_EQ(both[1].page, 7);
        EXPECT_EQ(both[1].depth, w.depth);
        EXPECT_EQ(both[1].parallel, w.parallel);
        EXPECT_TRUE(both[1].open);
      }
      ++n_cut;
      // They are equally far there, or the first is nearer all the way to its end.
      const double here = c.cut[i], slack = 2 * slack_share * (o.at(here) + t.ends.length);
      EXPECT_LE(o.at(here), w.at(here) + slack) << round;
      if (here < o.b1) {
        EXPECT_NEAR(o.at(here), w.at(here), slack) << round;
      }
      EXPECT_NEAR(here, batch[0].b1, 1e-6) << round;
      n_before_end += here < o.b1;
      EXPECT_EQ(c.cut_first[i], o.at(here));
      EXPECT_EQ(c.cut_second[i], w.at(here));
    }
  }
  EXPECT_GT(n_cut, 1000);
  EXPECT_GT(n_before_end, n_cut / 2);
  EXPECT_GT(n_apart, 200);
  EXPECT_GT(n_put, n_cut / 2);
}

/// Windows that neither an end of their edge cuts nor anything else sets apart go on where they
/// lie.
TEST(RayCrossing, WholeAreWindowsThatNothingChanges) {
  for (const WindowKernels* kernels : {&plain_window_kernels, &window_kernels()})
    for (const std::size_t odd_one : {0, 3, 4, 8}) {
      WindowBlock windows;
      for (int i = 0; i < 9; ++i) {
        Window w;
        w.b0 = 0.1 * i;
        w.b1 = 0.1 * (i + 1);
        w.x = 0.5;
        w.y = -1 - 0.01 * std::abs(i - 4);
        w.page = 1;
        w.measure_ends();
        test_blocks().push_back(windows, w);
      }
      const EdgeEnds far(2, 2, 1);
      EXPECT_TRUE(kernels->all_whole(windows, far));
      EXPECT_FALSE(kernels->all_whole(windows, EdgeEnds(0.9, 2, 1)));
      EXPECT_FALSE(kernels->all_whole(windows, EdgeEnds(2, 0.9, 1)));
      EXPECT_EQ(kernels->least(windows, 0, 9), 1);
      EXPECT_EQ(kernels->least(windows, 5, 9), windows[5].d0);
      EXPECT_EQ(kernels->least(windows, 2, 2), infinity);
      const Window good = windows[odd_one];
      Window bad = good;
      bad.page = 0;
      windows.set(odd_one, bad);
      EXPECT_FALSE(kernels->all_whole(windows, far));
      bad = good;
      bad.open = false;
      windows.set(odd_one, bad);
      EXPECT_FALSE(kernels->all_whole(windows, far));
      bad = good;
      bad.b1 = bad.b0;
      windows.set(odd_one, bad);
      EXPECT_FALSE(kernels->all_whole(windows, far));
      windows.set(odd_one, good);
      EXPECT_TRUE(kernels->all_whole(windows, far));
    }
}

/// Eight equilateral triangles around vertex 0, and one more beyond each outer edge.
PolygonSoup saddle_soup() {
  const double r2 = 3 / (2 + std::numbers::sqrt2), r = std::sqrt(r2), h = std::sqrt(1 - r2);
  PolygonSoup soup;
  soup.points.resize(17, 3);
  soup.points.row(0).setZero();
  for (int i = 0; i < 16; ++i) {
    const double angle = std::numbers::pi / 8 * i;
    if (i % 2 == 0)
      soup.points.row(1 + i) << r * std::cos(angle), r * std::sin(angle), i % 4 == 0 ? h : -h;
    else
      soup.points.row(1 + i) << 2 * r * std::cos(angle), 2 * r * std::sin(angle), 0;
  }
  for (int i = 0; i < 16; i += 2) {
    const int next = 1 + (i + 2) % 16;
    test::add_triangle(soup, 0, 1 + i, next);
    test::add_triangle(soup, next, 1 + i, 2 + i);
  }
  return soup;
}

/// Rays that cross it are left out where they are later than it: it must not seem sooner.
TEST(RayCrossing, WinnersAreKnownToTheSeventhDigitAndNotSooner) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> exponent(-320, 37);
  for (int i = 0; i < 10'000; ++i) {
    const double distance = std::pow(10, exponent(random));
    const double known = double(PolyhedralSearch::Winner::of(distance, 0.3).distance);
    EXPECT_GE(known, distance);
    EXPECT_LE(known, distance * (1 + 1.2e-7) + 1.2e-38);
  }
  EXPECT_EQ(PolyhedralSearch::Winner::of(0.5, 0.25).distance, 0.5F);
  EXPECT_EQ(PolyhedralSearch::Winner::of(1e300, 0.25).distance,
            std::numeric_limits<float>::infinity());
  EXPECT_EQ(PolyhedralSearch::Winner::of(0.5, 0.25).crossing, 0.25F);
}

/// With a turn of 8 pi / 3 around the vertex paths bend into the 2 pi / 3 opposite to where they
/// come from: from half a turn on, in both senses.
TEST(RayCrossing, PathsThatBendLeaveBehindTheVertex) {
  const SurfaceMesh mesh(saddle_soup());
  Report report;
  const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
  const double third = std::numbers::pi / 3, turn = 8 * third, side = T.length(0, 0);
  for (int from = 0; from < 8; ++from)
    for (const double share : {0.0, 0.1, 0.5, 0.8, 1.0}) {
      PolyhedralSearch search(T);
      ASSERT_EQ(search.pages.bends[0], PolyhedralPages::behind);
      search.distance[0] = 2 * side;
      search.nearest[0] = 7;
      const auto across = search.pages.around(0);
      ASSERT_EQ(across.size(), 8U);
      // Angles from the first edge of the fan on; the leg where a side starts comes first.
      const auto angle_at = [&](double s) {
        return std::atan((s - 0.5) / (0.5 * std::numbers::sqrt3)) + third / 2;
      };
      const int arrival_side = across[from];
      const auto leg = [&](int of) {  // which edge of the fan a side's start is
        return (T.faces(of / 3, of % 3) - 1) / 2;
      };
      ASSERT_EQ(T.faces(arrival_side / 3, (arrival_side % 3 + 1) % 3),
                1 + 2 * (leg(arrival_side) + 1) % 16);
      search.arrival[0] = {arrival_side, share};
      const double arrives = third * leg(arrival_side) + angle_at(share);
      RayCrossing crossing(search);
      crossing.leave_vertex(0);
      double covered = 0;
      for (const RayCrossing::Batch& batch : crossing.batches()) {
        for (std::size_t i = 0; i < batch.windows.size(); ++i) {
          const Window w = batch.windows[i];
          EXPECT_EQ(w.source, 7);
          EXPECT_EQ(w.behind, 2 * side);
          // The side that this edge is of the fan.
          const int of = *std::find_if(across.begin(), across.end(), [&](int s) {
            return T.side_edge(s / 3, s % 3) == batch.edge;
          });
          const bool along = T.along(of / 3, of % 3) > 0;
          const double s0 = along ? w.b0 / side : 1 - w.b1 / side,
                       s1 = along ? w.b1 / side : 1 - w.b0 / side;
          covered += angle_at(s1) - angle_at(s0);
          for (const double s : {s0, s1}) {
            const double away = std::fmod(third * leg(of) + angle_at(s) - arrives + 2 * turn, turn);
            EXPECT_GE(away, std::numbers::pi - 2e-6) << from << " " << share;
            EXPECT_LE(away, turn - std::numbers::pi + 2e-6) << from << " " << share;
          }
        }
      }
      EXPECT_NEAR(covered, turn - 2 * std::numbers::pi, 4e-6) << from << " " << share;
    }
}

}  // namespace
}  // namespace littoral
