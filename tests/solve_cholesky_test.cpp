// The sparse factorization against dense algebra: structure, orders, patches, threads, cancelling.

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <limits>
#include <memory>
#include <numeric>
#include <random>
#include <thread>

#include "base/parallel.h"
#include "base/parallel_forest.h"
#include "dense_solves.h"
#include "heat_helpers.h"
#include "littoral/error.h"
#include "solve/direct/cholesky.h"
#include "solve/poisson/poisson.h"
#include "test_meshes.h"

namespace littoral {
namespace {

/// The lower triangle of a positive definite matrix on a random graph of several components.
template <class Scalar>
Eigen::SparseMatrix<Scalar> random_matrix(int n, int edges, std::mt19937& random) {
  std::uniform_real_distribution<double> u(-1, 1);
  std::vector<Eigen::Triplet<Scalar>> entries;
  for (int i = 0; i < n; ++i) entries.emplace_back(i, i, 8.0 + u(random));
  for (int k = 0; k < edges; ++k) {
    const int i = static_cast<int>(random() % n), j = static_cast<int>(random() % n);
    if (i == j || i % 3 != j % 3) continue;
    Scalar z = u(random);
    if constexpr (!std::is_same_v<Scalar, double>) z += Scalar(0, u(random));
    entries.emplace_back(std::max(i, j), std::min(i, j), z / 2.0);
    entries.emplace_back(i, i, 1.0);
    entries.emplace_back(j, j, 1.0);
  }
  Eigen::SparseMatrix<Scalar> A(n, n);
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
}

template <class Scalar>
void expect_solves(int n, int edges, std::mt19937& random) {
  using Dense = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
  const auto lower = random_matrix<Scalar>(n, edges, random);
  const Eigen::SparseMatrix<Scalar> full = lower.template selfadjointView<Eigen::Lower>();
  const Dense exact = Dense::Random(n, 3), b = Dense(full) * exact;
  Ordering shuffled(n);
  std::iota(shuffled.begin(), shuffled.end(), 0);
  std::shuffle(shuffled.begin(), shuffled.end(), random);
  for (const Ordering& order : {Ordering(), shuffled}) {
    const Cholesky<Scalar> factor(lower, {}, order);
    EXPECT_LE((factor.solve(b) - exact).cwiseAbs().maxCoeff(), 1e-12) << n << " " << edges;
    EXPECT_LE((factor.solve(b.col(1)) - exact.col(1)).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST(Cholesky, AgreesWithDenseOnRandomGraphs) {
  std::mt19937 random(11);
  for (int n : {1, 2, 3, 7, 40, 150, 400})
    for (int density : {0, 1, 3, 8}) {
      expect_solves<double>(n, n * density, random);
      expect_solves<Complex>(n, n * density, random);
    }
}

/// M + L of an octasphere, big enough for several tasks.
SpMat sphere_matrix(int level) {
  const SurfaceMesh mesh(test::octasphere_soup(level));
  Report report;
  const auto p = test::problem(mesh, test::vertex_points({3}), report);
  SpMat K = p.ops->scalar.L;
  for (int i = 0; i < K.rows(); ++i) K.coeffRef(i, i) += p.ops->scalar.M[i];
  return K;
}

TEST(Cholesky, OneThreadOrTwoGiveTheSameBits) {
  const SpMat K = sphere_matrix(6);
  const auto E = std::make_shared<const Elimination>(K, dissection(K, {}));
  EXPECT_GT(E->n_tasks(), 8);
  const MatX b = MatX::Random(K.rows(), 2);
  MatX first;
  for (int threads : {1, 2, 3}) {
    set_thread_count(threads);
    const MatX x = Cholesky<double>(K, E, {}).solve(b);
    if (threads == 1) first = x;
    EXPECT_TRUE(x == first) << threads;
  }
  set_thread_count(0);
  EXPECT_LE((K.selfadjointView<Eigen::Lower>() * first - b).cwiseAbs().maxCoeff(), 1e-10);
}

TEST(Cholesky, APatchedFactorHasTheBitsOfANewOne) {
  SpMat K = sphere_matrix(5);
  const auto E = std::make_shared<const Elimination>(K, dissection(K, {}));
  const Cholesky<double> base(K, E, {}, true);
  const VecX b = VecX::Random(K.rows());
  const VecX before = base.solve(b);
  std::mt19937 random(3);
  for (int round = 0; round < 3; ++round) {
    SpMat changed = K;
    std::vector<int> touched;
    for (int k = 0; k < 20; ++k) {
      touched.push_back(static_cast<int>(random() % K.rows()));
      changed.coeffRef(touched.back(), touched.back()) += 1e4;
    }
    EXPECT_TRUE(base.patched(changed, touched, {}).solve(b) ==
                Cholesky<double>(changed, E, {}).solve(b));
  }
  EXPECT_TRUE(base.solve(b) == before);
}

/// Blocks of a factor so large that they lie together: patches share them and leave them alone.
TEST(Cholesky, ALargeFactorIsPatchedToo) {
  std::mt19937 random(9);
  const int n = 3000;
  const SpMat lower = random_matrix<double>(n, 60000, random);
  const Cholesky<double> alone(lower, {});
  ASSERT_GT(8 * alone.nonzeros(), double(1 << 22));
  const Cholesky<double> base(lower, alone.structure(), {}, true);
  const Eigen::MatrixXd b = Eigen::MatrixXd::Random(n, 1), x = base.solve(b);
  EXPECT_TRUE(alone.solve(b) == x);
  EXPECT_LE((lower.selfadjointView<Eigen::Lower>() * x - b).cwiseAbs().maxCoeff(), 1e-12);
  SpMat changed = lower;
  changed.coeffRef(5, 5) += 1;
  const Cholesky<double> patched = base.patched(changed, {5}, {});
  EXPECT_TRUE(patched.solve(b) == Cholesky<double>(changed, base.structure(), {}).solve(b));
  EXPECT_FALSE(patched.solve(b) == x);
  EXPECT_TRUE(base.solve(b) == x);
}

TEST(Cholesky, WhatIsIndefiniteByRoundOffIsRaisedByTheLeastShareThatHelps) {
  // 1 and 1 + d beside each other have the eigenvalue -d; raised by a share s it is s - d.
  const auto pair = [](double d) {
    SpMat A(3, 3);
    A.insert(0, 0) = A.insert(1, 1) = 1;
    A.insert(1, 0) = 1 + d;
    A.insert(2, 2) = 4;
    A.makeCompressed();
    return A;
  };
  const auto raised = [&](double d) {
    const SpMat A = pair(d);
    return raised_cholesky(A, std::make_shared<const Elimination>(A, Ordering{0, 1, 2}, Task()),
                           {});
  };
  EXPECT_EQ(raised(-0.5).raised, 0);
  EXPECT_DOUBLE_EQ(raised(1e-13).raised, 1e-12);
  EXPECT_DOUBLE_EQ(raised(1e-11).raised, 1e-10);
  const RaisedCholesky<double> made = raised(1e-9);
  EXPECT_DOUBLE_EQ(made.raised, 1e-8);
  const VecX x = made.factor.solve(VecX(Vec3(1, 1, 4)));  // (1, 1) / (2 + s + d), 1 / (1 + s)
  EXPECT_LE((x - Vec3(0.5, 0.5, 1)).cwiseAbs().maxCoeff(), 2e-8);
  EXPECT_THROW(raised(1e-7), SolveError);
}

TEST(SymmetricRows, ResidualsAreThoseOfTheWholeMatrix) {
  const SpMat K = sphere_matrix(4);
  const VecX x = VecX::LinSpaced(K.rows(), -1, 2), b = VecX::LinSpaced(K.rows(), 3, 4);
  const VecX known = b - K.selfadjointView<Eigen::Lower>() * x;
  EXPECT_LE((SymmetricRows(K).residual(K, x, b) - known).cwiseAbs().maxCoeff(), 1e-13);
}

TEST(Cholesky, SparseRightHandSidesAndWantedUnknownsGiveTheSameBits) {
  const SpMat K = sphere_matrix(5);
  const Cholesky<double> factor(K, {});
  VecX b = VecX::Zero(K.rows());
  b[7] = 1;
  b[K.rows() / 2] = -3;
  const VecX shifted = factor.solve(b + VecX::Constant(K.rows(), 1e-300));  // no zeros
  const VecX x = factor.solve(b);
  EXPECT_LE((x - shifted).cwiseAbs().maxCoeff(), 1e-15);
  std::vector<char> wanted(static_cast<std::size_t>(K.rows()), 0);
  for (std::size_t i = 3; i < wanted.size(); i += 501) wanted[i] = 1;
  const VecX some = factor.solve(b, wanted);
  for (std::size_t i = 3; i < wanted.size(); i += 501)
    EXPECT_EQ(some[Eigen::Index(i)], x[Eigen::Index(i)]);
}

TEST(Cholesky, ARightSideCorrectedOnTheWayIsSolvedAsIfItHadBeenKnown) {
  const SpMat K = sphere_matrix(6);
  const Cholesky<double> factor(K, {});
  const MatX b = MatX::Random(K.rows(), 2);
  const std::vector<int> at{9, 3, 700, 701, static_cast<int>(K.rows()) - 1};
  for (const int rounds : {0, 1, 3}) {
    MatX known = b;
    for (int round = 1; round <= rounds; ++round) {
      const MatX x = factor.solve(known);
      for (const int i : at) known.row(i) += round * (x.row(i).array() + 1).matrix();
    }
    const MatX expected = factor.solve(known);
    MatX first;
    for (const int threads : {1, 2, 3}) {
      set_thread_count(threads);
      int round = 0;
      const MatX x = factor.solve_corrected(b, at, rounds, [&](const MatX& x_at) {
        return MatX(++round * (x_at.array() + 1).matrix());
      });
      EXPECT_EQ(round, rounds);
      if (threads == 1) first = x;
      EXPECT_TRUE(x == first) << threads;
    }
    set_thread_count(0);
    EXPECT_LE((first - expected).cwiseAbs().maxCoeff(), 1e-11 * expected.cwiseAbs().maxCoeff());
    EXPECT_TRUE(rounds > 0 || first == expected);
  }
}

TEST(Cholesky, UnknownsBetweenNodesFollowTheirNodes) {
  const SurfaceMesh mesh(test::octasphere_soup(5));
  Report report;
  const auto p = test::problem(mesh, test::vertex_points({3}), report);
  const Ordering nodes = dissection(p.ops->scalar.L, {});
  const Ordering order = between_nodes(nodes, p.ops->vector.ends.matrix());
  std::vector<char> seen(order.size(), 0);
  for (int i : order) seen[i] = 1;
  EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), p.ops->vector.n);
  const SpMatC L = p.ops->vector.L({});
  const Elimination shared(L, order);
  const Elimination own(L, dissection(L, {}));
  EXPECT_LT(shared.flops(), 1.1 * own.flops());
}

TEST(Cholesky, DissectionKeepsAStripNarrow) {
  const SurfaceMesh mesh(test::grid_soup(2000, 2));
  Report report;
  const auto p = test::problem(mesh, test::vertex_points({3}), report);
  const SpMat& L = p.ops->scalar.L;
  EXPECT_LT(Elimination(L, dissection(L, {})).values(), 40.0 * static_cast<double>(L.rows()));
}

TEST(Cholesky, AnAbandonedFactorizationDisturbsNoLaterOne) {
  const SpMat K = sphere_matrix(6);
  const VecX b = VecX::Random(K.rows());
  const VecX expected = Cholesky<double>(K, {}).solve(b);
  for (int round = 0; round < 3; ++round) {
    const CancelToken cancel;
    std::thread other([cancel] {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      cancel.cancel();
    });
    EXPECT_THROW(
        {
          for (;;) Cholesky<double>(K, Task(cancel));
        },
        Cancelled);
    EXPECT_TRUE(Cholesky<double>(K, {}).solve(b) == expected) << round;
    other.join();
  }
}

TEST(Poisson, ConstraintsOnTheSharedFactorAgreeWithANewFactor) {
  const SurfaceMesh mesh(test::octasphere_soup(4));
  Report report;
  const auto p =
      test::problem(mesh, test::space_curve(1.1 * test::circle(0, 0, 0.5, 0.8, 60)), report);
  const Calculus& C = p.ops->scalar;
  const Poisson poisson(C.L, C.component, C.n_components, {});
  VecX b = VecX::Random(C.L.rows());
  b.array() -= b.mean();
  const VecX x = poisson.solve_levels(
      b, {p.terms.A, std::vector<int>(p.terms.group.size(), 0), {1}}, {}, report);
  EXPECT_LE((p.terms.A * x).cwiseAbs().maxCoeff(), 1e-11);
  // Optimal: the force L x - b is a combination of the rows.
  const VecX force = times_symmetric(C.L, x) - b;
  const MatX At = MatX(p.terms.A.transpose());
  const VecX y = test::dense_solve(At, force);
  EXPECT_LE((At * y - force).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(Poisson, UnknownsHeldAtZeroTakeOnePassThroughTheFactor) {
  const SurfaceMesh mesh(test::octasphere_soup(4));
  Report report;
  const auto p = test::problem(mesh, test::vertex_points({3}), report);
  const Calculus& C = p.ops->scalar;
  const std::vector<int> held{5, 6, 40};
  SpMat A(3, C.L.rows());
  for (int r = 0; r < 3; ++r) A.insert(r, held[r]) = 1;
  const VecX b = VecX::Random(C.L.rows());
  Report steps;
  const VecX x =
      Poisson(C.L, C.component, C.n_components, {}).solve_levels(b, {A, {0, 0, 0}, {1}}, {}, steps);
  EXPECT_LE((A * x).cwiseAbs().maxCoeff(), 1e-12 * (x.maxCoeff() - x.minCoeff()));
  VecX force = times_symmetric(C.L, x) - b;  // at the rows alone
  for (const int i : held) force[i] = 0;
  EXPECT_LE(force.cwiseAbs().maxCoeff(), 1e-11);
  ASSERT_FALSE(steps.iterations.empty());
  EXPECT_EQ(steps.iterations[0].first, "constraint steps");
  EXPECT_EQ(steps.iterations[0].second, 1);  // what a second one adds is known before x is
}

TEST(Parallel, EveryThreadFlushesSubnormalsAsItsCallerDoes) {
  const volatile double tiny = std::numeric_limits<double>::min();
  const auto flushes = [&] { return tiny / 4 == 0; };
  std::vector<char> seen(64, 0);
  const auto all_flush = [&] {
    std::fill(seen.begin(), seen.end(), 0);
    parallel_for(seen.size(), 1, [&](std::size_t i, std::size_t) {
      std::this_thread::sleep_for(std::chrono::microseconds(100));  // so that no thread does all
      seen[i] = flushes();
    });
    const auto in_loop = std::count(seen.begin(), seen.end(), 1);
    std::fill(seen.begin(), seen.end(), 0);
    parallel_forest(std::vector<int>(seen.size(), -1), Walk::from_leaves, [&](int i) {
      std::this_thread::sleep_for(std::chrono::microseconds(100));
      seen[i] = flushes();
    });
    const auto in_forest = std::count(seen.begin(), seen.end(), 1);
    EXPECT_EQ(in_loop, in_forest);
    return static_cast<std::size_t>(in_loop);
  };
  set_thread_count(4);
  EXPECT_EQ(all_flush(), 0U);
  {
    const FlushSubnormals flush;
    EXPECT_EQ(all_flush(), seen.size());
  }
  EXPECT_EQ(all_flush(), 0U);
  set_thread_count(0);
}

TEST(Parallel, ForestsRunChildrenFirstOrParentsFirst) {
  const std::vector<int> parent = {2, 2, 6, 5, 5, 6, -1, 8, -1};
  for (int threads : {1, 2, 4})
    for (Walk walk : {Walk::from_leaves, Walk::from_roots}) {
      set_thread_count(threads);
      std::vector<std::atomic<int>> when(parent.size());
      std::atomic<int> clock{1};
      parallel_forest(parent, walk, [&](int i) { when[i] = clock++; });
      for (std::size_t i = 0; i < parent.size(); ++i) {
        EXPECT_GT(when[i], 0);
        if (parent[i] < 0) continue;
        EXPECT_EQ(when[i] < when[parent[i]], walk == Walk::from_leaves);
      }
      EXPECT_THROW(parallel_forest(parent, walk,
                                   [](int i) {
                                     if (i == 5) throw InputError("five");
                                   }),
                   InputError);
    }
  set_thread_count(0);
}

}  // namespace
}  // namespace littoral
