// L1 integration: closed forms, certificates, both algorithms, bounds and invariances.

#include "solve/network/l1_integration.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "constants.h"
#include "littoral/error.h"
#include "solve/network/flow_interior_point.h"

namespace littoral {
namespace {

using test::infinity;

/// The k x k torus grid graph with random offsets and weights.
L1Integration random_problem(int k, unsigned seed, bool bounded) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(-1, 1);
  L1Integration p;
  p.n = k * k;
  for (int i = 0; i < k; ++i)
    for (int j = 0; j < k; ++j) {
      p.f.insert(p.f.end(), {i * k + j, i * k + j});
      p.g.insert(p.g.end(), {((i + 1) % k) * k + j, i * k + (j + 1) % k});
    }
  const auto m = static_cast<Eigen::Index>(p.f.size());
  p.c.resize(m);
  p.w.resize(m);
  for (Eigen::Index e = 0; e < m; ++e) {
    p.c[e] = u(random);
    p.w[e] = 0.1 + std::abs(u(random));
  }
  if (bounded) {
    // Bounds that some s satisfies: those around the jumps of a known one.
    p.lo = VecX::Constant(m, -infinity);
    p.hi = VecX::Constant(m, infinity);
    VecX s(p.n);
    for (double& value : s) value = u(random);
    for (Eigen::Index e = 0; e < m; e += 3) {
      const double J = p.c[e] + s[p.f[e]] - s[p.g[e]];
      p.lo[e] = std::min(0.0, J);
      p.hi[e] = std::max(0.0, J);
    }
  }
  return p;
}

L1Solution solve(const L1Integration& p, L1Algorithm algorithm = L1Algorithm::automatic) {
  Report report;
  return integrate_l1(p, {static_cast<int>(algorithm)}, {}, report);
}

TEST(L1Integration, IntegratesWhatIsIntegrable) {
  L1Integration p = random_problem(9, 1, false);
  VecX truth(p.n);
  std::mt19937 random(2);
  for (double& value : truth) value = std::uniform_real_distribution<double>(-3, 3)(random);
  for (Eigen::Index e = 0; e < p.n_arcs(); ++e) p.c[e] = truth[p.g[e]] - truth[p.f[e]];
  const L1Solution solution = solve(p);
  EXPECT_LT(solution.primal, 1e-8);
  EXPECT_LT((solution.s - (truth.array() - truth[0]).matrix()).cwiseAbs().maxCoeff(), 1e-8);
}

TEST(L1Integration, TheMedianOnAStar) {
  // Leaf k wants to differ from the centre by k; all arcs pass the same two nodes.
  L1Integration p;
  p.n = 2;
  p.c.resize(5);
  p.w = VecX::Ones(5);
  for (int k = 0; k < 5; ++k) {
    p.f.push_back(0);
    p.g.push_back(1);
    p.c[k] = k * k;
  }
  const L1Solution solution = solve(p);  // s_1 - s_0 = the median of 0 1 4 9 16
  EXPECT_NEAR(solution.s[1] - solution.s[0], 4, 1e-9);
  EXPECT_NEAR(solution.primal, 4 + 3 + 0 + 5 + 12, 1e-8);
}

TEST(L1Integration, ALoopJumpsWhereItIsCheapest) {
  // A ring of ten nodes with turn 1: one jump of 1 on the arc of least weight.
  L1Integration p;
  p.n = 10;
  p.c = VecX::Constant(10, 0.1);
  p.w = VecX::Constant(10, 2);
  p.w[6] = 0.5;
  for (int k = 0; k < 10; ++k) {
    p.f.push_back(k);
    p.g.push_back((k + 1) % 10);
  }
  const L1Solution solution = solve(p);
  EXPECT_NEAR(solution.primal, 0.5, 1e-9);
  EXPECT_NEAR(p.c[6] + solution.s[6] - solution.s[7], 1, 1e-9);
}

TEST(L1Integration, BothAlgorithmsReachTheSameOptimumAndProveIt) {
  for (const bool bounded : {false, true})
    for (const unsigned seed : {3u, 4u, 5u}) {
      const L1Integration p = random_problem(16, seed, bounded);
      const L1Solution a = solve(p, L1Algorithm::simplex),
                       b = solve(p, L1Algorithm::interior_point);
      EXPECT_GT(a.primal, 1);
      EXPECT_LT(std::abs(a.gap()), 1e-9);
      EXPECT_LT(std::abs(b.gap()), 1e-9);
      EXPECT_NEAR(a.primal, b.primal, 1e-9 * a.primal);
      EXPECT_LT(a.infeasibility, 1e-9);
      EXPECT_LT(b.infeasibility, 1e-9);
      EXPECT_GT(b.iterations, 3);
      EXPECT_LT(b.iterations, 40);
      // Complementary slackness: a jump saturates its arc, in its direction.
      for (Eigen::Index e = 0; e < p.n_arcs(); ++e) {
        const double J = p.c[e] + a.s[p.f[e]] - a.s[p.g[e]];
        if (std::abs(J) > 1e-9) {
          EXPECT_NEAR(a.x[e], std::copysign(p.w[e], J), 1e-9);
        }
      }
    }
}

TEST(L1Integration, TheInteriorPointIsNearTheOptimumAndInside) {
  for (const bool bounded : {false, true}) {
    const L1Integration p = random_problem(16, 3, bounded);
    const InteriorPoint point = interior_point(p, 1e-9, {});
    double primal = 0, dual = 0;
    VecX out = VecX::Zero(p.n);
    for (Eigen::Index e = 0; e < p.n_arcs(); ++e) {
      const double J = p.c[e] + point.s[p.f[e]] - point.s[p.g[e]];
      primal += p.w[e] * std::abs(J);
      dual += p.c[e] * point.x[e];
      EXPECT_LT(std::abs(point.x[e]), p.w[e]);
      double flow = point.x[e];
      if (bounded && e % 3 == 0) {
        EXPECT_GT(point.up[e], 0);
        EXPECT_GT(point.down[e], 0);
        EXPECT_LT(J, p.hi[e] + 1e-8);
        EXPECT_GT(J, p.lo[e] - 1e-8);
        dual += (p.c[e] - p.hi[e]) * point.up[e] - (p.c[e] - p.lo[e]) * point.down[e];
        flow += point.up[e] - point.down[e];
      } else {
        EXPECT_EQ(point.up[e], 0);
        EXPECT_EQ(point.down[e], 0);
      }
      out[p.f[e]] += flow;
      out[p.g[e]] -= flow;
    }
    EXPECT_LT(std::abs(primal - dual), 1e-8 * primal);
    EXPECT_LT(out.cwiseAbs().maxCoeff(), 1e-8);
    EXPECT_NEAR(primal, solve(p, L1Algorithm::simplex).primal, 1e-8 * primal);
  }
}

TEST(L1Integration, TheInteriorPointTakesFewSteps) {
  // As s and z go the same share of the way, what they have to satisfy together stays satisfied;
  // otherwise every problem takes about a step more.
  int steps = 0;
  for (const int k : {8, 16, 32})
    for (const unsigned seed : {1u, 2u, 3u, 4u, 5u, 6u})
      steps += interior_point(random_problem(k, seed, false), 1e-9, {}).iterations;
  EXPECT_LE(steps, 204);  // 200 were seen
}

TEST(L1Integration, TheInteriorPointLeavesTheSimplexLittleToDo) {
  // Flows that only approach their bounds would each take a pivot.
  for (const bool bounded : {false, true})
    for (const unsigned seed : {1u, 2u, 3u, 4u}) {
      const L1Integration p = random_problem(32, seed, bounded);
      EXPECT_LT(solve(p, L1Algorithm::interior_point).pivots, 20);  // 1 was seen
      EXPECT_GT(solve(p, L1Algorithm::simplex).pivots, 1000);
    }
}

TEST(L1Integration, BoundsHoldAndCost) {
  const L1Integration bounded = random_problem(12, 8, true);
  L1Integration free = bounded;
  free.lo.resize(0);
  free.hi.resize(0);
  const L1Solution a = solve(bounded), b = solve(free);
  EXPECT_GT(a.primal, b.primal * (1 + 1e-6));
  for (Eigen::Index e = 0; e < bounded.n_arcs(); ++e) {
    const double J = bounded.c[e] + a.s[bounded.f[e]] - a.s[bounded.g[e]];
    EXPECT_LE(J, bounded.hi[e] + 1e-9);
    EXPECT_GE(J, bounded.lo[e] - 1e-9);
  }
}

TEST(L1Integration, BoundsFarAwayFitTheIntegersToo) {
  // Prices of 2^30 times the others leave these few bits, but nothing overflows.
  const L1Integration free = random_problem(12, 8, false);
  const double expected = solve(free).primal;
  for (const double lo : {-infinity, -std::ldexp(1.0, 30)})
    for (const double hi : {infinity, std::ldexp(1.0, 30)}) {
      L1Integration p = free;
      p.lo = VecX::Constant(p.n_arcs(), lo);
      p.hi = VecX::Constant(p.n_arcs(), hi);
      EXPECT_NEAR(solve(p).primal, expected, 0.05 * expected) << lo << " " << hi;
    }
}

TEST(L1Integration, DependsOnNeitherScaleNorOrientation) {
  const L1Integration p = random_problem(12, 9, false);
  const double objective = solve(p).primal;
  L1Integration scaled = p;
  scaled.c *= 1e9;
  scaled.w *= 1e-7;
  EXPECT_NEAR(solve(scaled).primal, 100 * objective, 1e-7 * objective);
  L1Integration turned = p;
  std::swap(turned.f, turned.g);
  turned.c *= -1;
  EXPECT_NEAR(solve(turned).primal, objective, 1e-9 * objective);
}

TEST(L1Integration, PartsHaveTheirOwnZero) {
  L1Integration p;  // two pairs joined by an arc without weight
  p.n = 4;
  p.f = {0, 2, 1};
  p.g = {1, 3, 2};
  p.c = Vec3(1, -2, 7);
  p.w = Vec3(1, 1, 0);
  const L1Solution solution = solve(p);
  EXPECT_NEAR(solution.primal, 0, 1e-9);
  EXPECT_EQ(solution.s[0], 0);
  EXPECT_NEAR(solution.s[1], 1, 1e-9);
  EXPECT_EQ(solution.s[2], 0);
  EXPECT_NEAR(solution.s[3], -2, 1e-9);
}

TEST(L1Integration, RefusesWhatHasNoSolution) {
  L1Integration p;
  p.n = 2;
  p.f = {0, 0};
  p.g = {1, 1};
  p.c = Vec2(0, 5);
  p.w = Vec2(1, 1);
  p.lo = Vec2(0, 0);
  p.hi = Vec2(0, 0);  // s_1 - s_0 would be 0 and 5
  EXPECT_THROW(solve(p), InputError);
  p.lo = p.hi = VecX();
  p.c[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(solve(p), InputError);
  p.c[1] = 0;
  p.g[1] = 0;
  EXPECT_THROW(solve(p), InputError);
}

TEST(L1Integration, StopsWhenAsked) {
  const CancelToken cancel;
  cancel.cancel();
  Report report;
  EXPECT_THROW(integrate_l1(random_problem(20, 1, false), {}, Task(cancel), report), Cancelled);
}

}  // namespace
}  // namespace littoral
