// The windows an edge keeps are the lower envelope of all it was offered.

#include "methods/geodesic/edge_envelopes.h"

#include <gtest/gtest.h>

#include <random>

#include "window_blocks.h"

namespace littoral {
namespace {

Window point_window(double b0, double b1, double x, double y, double behind) {
  Window w;
  w.b0 = b0;
  w.b1 = b1;
  w.x = x;
  w.y = y;
  w.behind = behind;
  w.measure_ends();
  return w;
}

std::vector<Window> kept_by(const WindowList& list) {
  std::vector<Window> kept;
  for (std::size_t i = 0; i < list.windows.size(); ++i) kept.push_back(list.windows[i]);
  return kept;
}

TEST(EdgeEnvelopes, OfTwoPointsTheNearerMayBeSoInTheMiddleOnly) {
  // p from the middle: sqrt(p^2 + 1) = sqrt(p^2 + .01) + .5, squared: .74 = sqrt(p^2 + .01).
  const double r = 0.74, p = std::sqrt(r * r - 0.01);
  for (const bool far_first : {true, false}) {
    EdgeEnvelopes all(test_memory());
    WindowList list;
    const Window far = point_window(0, 4, 2, -1, 0), near = point_window(0, 4, 2, -0.1, 0.5);
    all.insert(list, 4, far_first ? far : near);
    all.insert(list, 4, far_first ? near : far);
    const std::vector<Window> kept = kept_by(list);
    ASSERT_EQ(kept.size(), 3);
    EXPECT_EQ(kept[0].behind, 0);
    EXPECT_EQ(kept[1].behind, 0.5);
    EXPECT_EQ(kept[2].behind, 0);
    EXPECT_NEAR(kept[1].b0, 2 - p, 1e-10);
    EXPECT_NEAR(kept[1].b1, 2 + p, 1e-10);
    EXPECT_EQ(all.n_held(), 3);
    EXPECT_EQ(all.n_taken(), far_first ? 2 : 3);
  }
}

TEST(EdgeEnvelopes, AgainstTheLeastOfAllAtEveryPoint) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> u(0, 1);
  const double length = 3;
  for (int round = 0; round < 300; ++round) {
    EdgeEnvelopes all(test_memory());
    WindowList list;
    std::vector<Window> offered;
    for (int i = 0; i < 25; ++i) {
      double b0 = length * u(random), b1 = length * u(random);
      if (b0 > b1) std::swap(b0, b1);
      Window w = point_window(b0, b1, 5 * u(random) - 1, -2 * u(random) * u(random), u(random));
      if (i % 5 == 4) {
        const double angle = 3.1 * u(random) + 0.02;
        w.parallel = true;
        w.x = std::cos(angle);
        w.y = std::sin(angle);
        w.behind = 2 * u(random);
        w.measure_ends();
      }
      if (i % 7 == 6) w = offered[random() % offered.size()];  // the same again
      w.source = i;
      offered.push_back(w);
      const double least = all.insert(list, length, w);
      double best = std::numeric_limits<double>::infinity();
      for (const Window& kept : kept_by(list))
        if (kept.source == i) best = std::min(best, kept.least());
      EXPECT_EQ(least, best);
    }
    const std::vector<Window> kept = kept_by(list);
    for (std::size_t i = 1; i < kept.size(); ++i) EXPECT_LE(kept[i - 1].b1, kept[i].b0);
    EXPECT_EQ(all.n_held(), double(kept.size()));
    for (int s = 0; s <= 1000; ++s) {
      const double p = length * s / 1000;
      double expected = std::numeric_limits<double>::infinity(), found = expected;
      for (const Window& w : offered)
        if (p >= w.b0 + 1e-9 && p <= w.b1 - 1e-9) expected = std::min(expected, w.at(p));
      for (const Window& w : kept) {
        EXPECT_NEAR(w.d0, w.at(w.b0), 1e-14);
        EXPECT_NEAR(w.d1, w.at(w.b1), 1e-14);
        if (p >= w.b0 && p <= w.b1) found = std::min(found, w.at(p));
      }
      EXPECT_LE(found, expected + 1e-11) << round << " " << p;
    }
  }
}

/// In several batches, from tail to head but for few, as one by one.
TEST(EdgeEnvelopes, BatchesAsOneByOne) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> u(0, 1);
  const double length = 3;
  for (int round = 0; round < 300; ++round) {
    EdgeEnvelopes all(test_memory());
    WindowList lists[2];
    for (int n = 0; n < 4; ++n) {
      WindowBlock batch;
      double least = std::numeric_limits<double>::infinity();
      for (int i = 0; i < 8; ++i) {
        const double b0 = length * std::min(0.9, i / 10. + 0.2 * u(random)),
                     b1 = std::min(length, b0 + length * 0.3 * u(random));
        Window w = point_window(b0, b1, 5 * u(random) - 1, -2 * u(random), i % 3 ? 1 : u(random));
        w.source = 8 * n + i;
        test_blocks().push_back(batch, w);
        all.insert(lists[1], length, w);
        all.settle(batch, length);
      }
      const double found = all.take(lists[0], std::move(batch), length);
      for (const Window& w : kept_by(lists[0]))
        if (w.source >= 8 * n) least = std::min(least, w.least());
      EXPECT_EQ(found, least);
    }
    EXPECT_EQ(all.n_held(), double(lists[0].windows.size() + lists[1].windows.size()));
    const std::vector<Window> kept[2] = {kept_by(lists[0]), kept_by(lists[1])};
    for (std::size_t i = 1; i < kept[0].size(); ++i) EXPECT_LE(kept[0][i - 1].b1, kept[0][i].b0);
    const auto at = [&](int list, double p) {
      double d = std::numeric_limits<double>::infinity();
      for (const Window& w : kept[list])
        if (p >= w.b0 && p <= w.b1) d = std::min(d, w.at(p));
      return d;
    };
    for (int s = 0; s <= 1000; ++s) {
      const double p = length * s / 1000, one = at(1, p), several = at(0, p);
      if (std::isinf(one) || std::isinf(several))
        EXPECT_EQ(one, several) << round << " " << p;
      else
        EXPECT_NEAR(one, several, 1e-11) << round << " " << p;
    }
  }
}

TEST(EdgeEnvelopes, TheSameWindowAgainIsNotTaken) {
  EdgeEnvelopes all(test_memory());
  WindowList list;
  const Window w = point_window(0.5, 2, 1, -1, 0.25);
  EXPECT_EQ(all.insert(list, 3, w), 1.25);
  for (const double nudge : {0., 1e-15, -1e-15}) {
    Window again = w;
    again.behind += nudge;
    again.measure_ends();
    EXPECT_EQ(all.insert(list, 3, again), std::numeric_limits<double>::infinity());
  }
  std::vector<Window> open;
  const auto take = [&](const Window& taken) { open.push_back(taken); };
  EXPECT_EQ(EdgeEnvelopes::least_open(list), 1.25);
  EdgeEnvelopes::take_open(list, take);
  EXPECT_EQ(open.size(), 1);
  EdgeEnvelopes::take_open(list, take);
  EXPECT_EQ(open.size(), 1);
  EXPECT_EQ(EdgeEnvelopes::least_open(list), std::numeric_limits<double>::infinity());
  EXPECT_EQ(all.n_held(), 1);
  all.forget(list);
  EXPECT_EQ(all.n_held(), 0);
}

}  // namespace
}  // namespace littoral
