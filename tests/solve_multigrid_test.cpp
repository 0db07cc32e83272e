// Poisson problems by multigrid against a factorization.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "heat_helpers.h"
#include "littoral/error.h"
#include "solve/multigrid/banded_multigrid.h"
#include "solve/multigrid/multigrid.h"
#include "solve/poisson/poisson.h"
#include "test_meshes.h"

namespace littoral {
namespace {

using namespace test;

struct Surface {
  IntrinsicTriangulation T;
  Operators ops;
};

Surface surface(const PolygonSoup& soup) {
  Report report;
  const SurfaceMesh mesh(soup);
  IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
  Operators ops = triangle_operators(T);
  return {std::move(T), std::move(ops)};
}

Poisson poisson(const Calculus& C, PoissonSolver solver) {
  return {C.L, C.component, C.n_components, {}, {}, solver};
}

/// Something that sums to 0 over every component.
VecX right_hand_side(const Calculus& C) {
  VecX u(C.M.size());
  for (Eigen::Index i = 0; i < u.size(); ++i)
    u[i] = std::sin(0.37 * double(i)) + std::cos(3e-4 * double(i));
  return times_symmetric(C.L, u);
}

double range(const VecX& x) { return x.maxCoeff() - x.minCoeff(); }

/// A needle mesh: a grid 20 times longer than wide.
PolygonSoup needles(int n) {
  PolygonSoup soup = jittered_grid_soup(n, n, 0.2);
  soup.points.col(0) *= 20;
  return soup;
}

/// Two grids and a vertex that no face uses.
PolygonSoup apart(int n) {
  PolygonSoup soup = grid_soup(n, n), out = soup;
  const auto V = soup.points.rows();
  out.points.resize(2 * V + 1, 3);
  out.points << soup.points, soup.points.rowwise() + Eigen::RowVector3d(2, 0, 0), 9, 9, 9;
  for (int f = 0; f < soup.n_faces(); ++f) {
    const auto p = soup.face(f);
    add_triangle(out, p[0] + int(V), p[1] + int(V), p[2] + int(V));
  }
  return out;
}

void expect_same(const PolygonSoup& soup, double tolerance, int iterations = 50) {
  const Surface S = surface(soup);
  const Calculus& C = S.ops.scalar;
  const VecX b = right_hand_side(C);
  Report direct, iterative;
  const VecX x = poisson(C, PoissonSolver::direct).solve(b, direct);
  const VecX y = poisson(C, PoissonSolver::multigrid).solve(b, iterative);
  EXPECT_EQ(iterative.status, "converged");
  EXPECT_LT((x - y).cwiseAbs().maxCoeff(), tolerance * range(x));
  EXPECT_LT(iterative.iterations.at(0).second, iterations);
}

TEST(Multigrid, SolvesAsTheFactorDoes) {
  expect_same(octasphere_soup(7), 1e-8);
  expect_same(jittered_grid_soup(200, 200, 0.3), 1e-8);
}

TEST(Multigrid, SolvesNeedleTriangles) {
  expect_same(needles(160), 1e-7, 60);
  expect_same(needles(320), 1e-7, 60);  // two coarser levels
}

TEST(Multigrid, SolvesSeveralComponents) { expect_same(apart(130), 1e-8); }

TEST(Multigrid, NeedsNoMoreIterationsOnLargerMeshes) {
  double before = 0;
  for (const int n : {160, 320}) {
    const Surface S = surface(jittered_grid_soup(n, n, 0.2));
    Report report;
    const VecX b = right_hand_side(S.ops.scalar);
    poisson(S.ops.scalar, PoissonSolver::multigrid).solve(b, report);
    const double iterations = report.iterations.at(0).second;
    EXPECT_LT(iterations, 40);
    if (before > 0) {
      EXPECT_LT(iterations, 1.6 * before);
    }
    before = iterations;
  }
}

TEST(Multigrid, WeaklyCoupledUnknownsGoWithANeighbour) {
  // A chain of which every fifth unknown hangs on by a thread.
  constexpr int n = 40;
  Triplets entries;
  const auto couple = [&](int i, int j, double by) {
    entries.emplace_back(i, j, -by);
    entries.emplace_back(j, i, -by);
    entries.emplace_back(i, i, by);
    entries.emplace_back(j, j, by);
  };
  for (int i = 0; i < n; ++i) entries.emplace_back(i, i, 1);
  for (int i = 0; i + 1 < n; ++i) couple(i, i + 1, i % 5 == 0 || i % 5 == 4 ? 1e-4 : 1);
  SpRows A(n + 1, n + 1);  // the last is coupled to nothing
  A.setFromTriplets(entries.begin(), entries.end());
  const SpRows P = smoothed_aggregation(A, 0.1, {});
  const int* begin = P.outerIndexPtr();
  for (int i = 0; i < n; ++i) EXPECT_GT(begin[i + 1], begin[i]) << i;
  EXPECT_EQ(begin[n + 1], begin[n]);
}

TEST(Multigrid, EntriesOfARowMayBeInAnyOrder) {
  const Surface S = surface(needles(40));  // couplings of all strengths
  const SpRows A = full_rows(S.ops.scalar.L);
  SpRows turned = A;
  for (int i = 0; i < A.rows(); ++i) {
    const int begin = A.outerIndexPtr()[i], end = A.outerIndexPtr()[i + 1];
    std::reverse(turned.innerIndexPtr() + begin, turned.innerIndexPtr() + end);
    std::reverse(turned.valuePtr() + begin, turned.valuePtr() + end);
  }
  const SpRows P = smoothed_aggregation(A, 0.08, {}), Q = smoothed_aggregation(turned, 0.08, {});
  ASSERT_EQ(P.cols(), Q.cols());
  EXPECT_LT(P.cols(), A.rows() / 2);
  EXPECT_LE((MatX(P) - MatX(Q)).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(Multigrid, MeetsConstraintsAsTheFactorDoes) {
  // A circle across faces, so that rows hold two or three unknowns each.
  Report report;
  const SurfaceMesh mesh(jittered_grid_soup(170, 170, 0.2));
  const auto p = problem(mesh, space_curve(circle(0.5, 0.5, 0, 0.3, 200)), report);
  const Calculus& C = p.ops->scalar;
  const VecX b = right_hand_side(C);
  const Poisson direct = poisson(C, PoissonSolver::direct);
  const Poisson iterative = poisson(C, PoissonSolver::multigrid);
  LevelRows rows{p.terms.A, std::vector<int>(p.terms.group.size(), 0), {1}};
  const VecX x = direct.solve_levels(b, rows, {}, report);
  const VecX y = iterative.solve_levels(b, rows, {}, report);
  EXPECT_LT((x - y).cwiseAbs().maxCoeff(), 1e-7 * range(x));
  EXPECT_LT((rows.A * y).cwiseAbs().maxCoeff(), 1e-8 * range(x));

  // Two halves, the second at a level of its own.
  for (std::size_t r = 0; r < rows.group.size(); ++r) rows.group[r] = 2 * r > rows.group.size();
  rows.anchor = {1, 0};
  const VecX x2 = direct.solve_levels(b, rows, {}, report);
  const VecX y2 = iterative.solve_levels(b, rows, {}, report);
  EXPECT_LT((x2 - y2).cwiseAbs().maxCoeff(), 1e-7 * range(x2));

  for (const double weight : {1e-2, 1.0, 1e3}) {
    const VecX w = VecX::Constant(p.terms.A.rows(), weight);
    const VecX x3 = direct.solve_soft(b, p.terms.A, w, {}, report);
    const VecX y3 = iterative.solve_soft(b, p.terms.A, w, {}, report);
    EXPECT_LT((x3 - y3).cwiseAbs().maxCoeff(), 1e-7 * range(x3)) << weight;
  }
  EXPECT_EQ(report.status, "converged");
}

TEST(Multigrid, GivesTheSameBitsForAnyNumberOfThreads) {
  const Surface S = surface(octasphere_soup(7));
  const VecX b = right_hand_side(S.ops.scalar);
  VecX x[2];
  Report report;
  for (const int threads : {1, 2}) {
    set_thread_count(threads);
    x[threads - 1] = poisson(S.ops.scalar, PoissonSolver::multigrid).solve(b, report);
  }
  set_thread_count(0);
  EXPECT_TRUE(x[0] == x[1]);
}

TEST(Multigrid, StopsWhenAsked) {
  const Surface S = surface(grid_soup(160, 160));
  const CancelToken stop;
  const Task task(stop);
  const Poisson P = poisson(S.ops.scalar, PoissonSolver::multigrid);
  const VecX b = right_hand_side(S.ops.scalar);
  stop.cancel();
  Report report;
  EXPECT_THROW(P.solve(b, report, task), Cancelled);
  EXPECT_THROW(Multigrid(SpMat(S.ops.scalar.L), task), Cancelled);
}

TEST(Multigrid, TakesMemoryLikeTheNumberOfUnknowns) {
  double before = 0;
  for (const int n : {200, 400}) {
    const Surface S = surface(grid_soup(n, n));
    const double per_unknown = Multigrid(SpMat(S.ops.scalar.L), {}).nonzeros() /
                               static_cast<double>(S.ops.scalar.M.size());
    if (before > 0) {
      EXPECT_LT(per_unknown, 1.2 * before);
    }
    before = per_unknown;
  }
}

}  // namespace
}  // namespace littoral
