// Linear solvers against dense algebra; progress, cancellation, threads and options.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

#include "base/parallel.h"
#include "dense_solves.h"
#include "heat_helpers.h"
#include "littoral/error.h"
#include "test_meshes.h"

namespace littoral {
namespace {

using Dense = Eigen::MatrixXd;

SpMat lower_of(const Dense& A) {
  return A.triangularView<Eigen::Lower>().toDenseMatrix().sparseView();
}

/// The weighted Laplacian of a random connected graph.
Dense random_laplacian(int n, std::mt19937& random) {
  std::uniform_real_distribution<double> weight(0.1, 2);
  Dense L = Dense::Zero(n, n);
  auto join = [&](int i, int j) {
    const double w = weight(random);
    L(i, i) += w;
    L(j, j) += w;
    L(i, j) -= w;
    L(j, i) -= w;
  };
  for (int i = 1; i < n; ++i) join(i, static_cast<int>(random() % i));
  for (int k = 0; k < n; ++k) {
    const int i = static_cast<int>(random() % n), j = static_cast<int>(random() % n);
    if (i != j) join(i, j);
  }
  return L;
}

VecX random_balanced(int n, std::mt19937& random) {
  std::uniform_real_distribution<double> u(-1, 1);
  VecX b(n);
  for (double& v : b) v = u(random);
  return b.array() - b.mean();
}

/// Rows of barycentric weights; the last two depend on the ones before.
Dense random_rows(int rows, int n, std::mt19937& random) {
  std::uniform_real_distribution<double> u(0, 1);
  Dense A = Dense::Zero(rows, n);
  for (int r = 0; r + 2 < rows; ++r) {
    const double t = u(random);
    A(r, random() % n) += t;
    A(r, random() % n) += 1 - t;
  }
  A.row(rows - 2) = A.row(0);
  A.row(rows - 1) = 0.5 * A.row(0) + 0.5 * A.row(1);
  return A;
}

/// min 1/2 x L x - b x subject to A x = B c by the dense KKT matrix, whose rows may depend on each
/// other.
VecX dense_levels(const Dense& L, const VecX& b, const Dense& A, const Dense& B) {
  const Eigen::Index n = L.rows(), m = A.rows(), g = B.cols();
  Dense K = Dense::Zero(n + g + m, n + g + m);
  K.topLeftCorner(n, n) = L;
  K.block(n + g, 0, m, n) = A;
  K.block(n + g, n, m, g) = -B;
  K.rightCols(m) = K.bottomRows(m).transpose().eval();
  VecX rhs = VecX::Zero(n + g + m);
  rhs.head(n) = b;
  return test::dense_solve(K, rhs).topRows(n);
}

TEST(HeatSolve, PoissonWithoutConstraints) {
  std::mt19937 random(1);
  for (int n : {2, 5, 30}) {
    const Dense L = random_laplacian(n, random);
    const VecX b = random_balanced(n, random);
    Report report;
    const VecX x = Poisson(lower_of(L), std::vector<int>(n, 0), 1, {}).solve(b, report);
    EXPECT_EQ(x[0], 0);
    EXPECT_LE((L * x - b).cwiseAbs().maxCoeff(), 1e-11);
  }
}

TEST(HeatSolve, ZeroSetWithDependentRows) {
  std::mt19937 random(2);
  for (int n : {6, 12, 40}) {
    const Dense L = random_laplacian(n, random), A = random_rows(5, n, random);
    const VecX b = random_balanced(n, random);
    Report report;
    const VecX x = Poisson(lower_of(L), std::vector<int>(n, 0), 1, {})
                       .solve_levels(b, {A.sparseView(), std::vector<int>(5, 0), {1}}, {}, report);
    EXPECT_LE((A * x).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_LE((x - dense_levels(L, b, A, Dense::Zero(5, 0))).cwiseAbs().maxCoeff(), 1e-7);
  }
}

TEST(HeatSolve, LevelSetsWithDependentRows) {
  std::mt19937 random(3);
  for (int n : {12, 25, 40}) {
    const Dense L = random_laplacian(n, random);
    Dense A(10, n), B = Dense::Zero(10, 1);
    A << random_rows(5, n, random), random_rows(5, n, random);
    B.bottomRows(5).setOnes();
    const VecX b = random_balanced(n, random);
    Report report;
    const LevelRows rows{A.sparseView(), {0, 0, 0, 0, 0, 1, 1, 1, 1, 1}, {1, 0}};
    const VecX x =
        Poisson(lower_of(L), std::vector<int>(n, 0), 1, {}).solve_levels(b, rows, {}, report);
    EXPECT_LE((x - dense_levels(L, b, A, B)).cwiseAbs().maxCoeff(), 1e-7);
  }
}

TEST(HeatSolve, OneRowAComponentFixesTheConstantAlone) {
  std::mt19937 random(5);
  const int n = 30, half = 18;  // two components
  Dense L = Dense::Zero(n, n);
  L.topLeftCorner(half, half) = random_laplacian(half, random);
  L.bottomRightCorner(n - half, n - half) = random_laplacian(n - half, random);
  std::vector<int> component(n, 0);
  std::fill(component.begin() + half, component.end(), 1);
  const Poisson poisson(lower_of(L), component, 2, {});
  for (const bool balanced : {true, false}) {
    VecX b(n);
    b << random_balanced(half, random), random_balanced(n - half, random);
    if (!balanced) b.array() += 0.1;
    Dense row = Dense::Zero(2, n);  // of the second component, the first; their sums are not 1
    row(0, half) = 2;
    row(0, n - 1) = 1;
    row(1, 3) = 0.25;
    const Dense twice = (Dense(4, n) << row, row).finished();  // dependent: the general way
    const VecX value = Eigen::Vector2d(0.7, -3), values = (VecX(4) << value, value).finished();
    Report report, slow_report;
    const VecX x = poisson.solve_levels(b, {row.sparseView(), {0, 0}, {1}, value}, {}, report);
    const VecX slow =
        poisson.solve_levels(b, {twice.sparseView(), {0, 0, 0, 0}, {1}, values}, {}, slow_report);
    EXPECT_LE((row * x - value).cwiseAbs().maxCoeff(), 1e-13);
    EXPECT_LE((x - slow).cwiseAbs().maxCoeff(), 1e-8);
    const VecX force = L * x - b;  // a combination of the rows
    EXPECT_LE((force + row.transpose() *
                           Eigen::Vector2d(b.tail(n - half).sum() / 3, b.head(half).sum() / 0.25))
                  .cwiseAbs()
                  .maxCoeff(),
              1e-12);
    const auto steps = [](const Report& r) {
      return std::count_if(r.iterations.begin(), r.iterations.end(),
                           [](const auto& loop) { return loop.first == "constraint steps"; });
    };
    EXPECT_EQ(steps(report), 0);  // the factor is used as it is
    ASSERT_EQ(steps(slow_report), 1);
    for (const auto& [loop, count] : slow_report.iterations)
      EXPECT_TRUE(loop != "constraint steps" || count <= 3) << count;  // 2 were seen
  }
}

/// A chain of unknowns, one spring to its neighbours each, in two pieces.
TEST(HeatSolve, LongChainsDecayAsTheyMustOnAnyNumberOfThreads) {
  const int n = 70'000, cut = 40'000;
  const double t = 9;
  Triplets entries;
  for (int i = 0; i < n; ++i) {
    const bool first = i == 0 || i == cut, last = i == cut - 1 || i == n - 1;
    entries.emplace_back(i, i, 1 + t * (2 - first - last));
    if (!last) entries.emplace_back(i + 1, i, -t);
  }
  SpMat A(n, n);
  A.setFromTriplets(entries.begin(), entries.end());
  std::vector<int> piece(n, 0);
  std::fill(piece.begin() + cut, piece.end(), 1);
  const VecX M = VecX::Ones(n);
  const HeatSystem<double> system(std::make_shared<const SpMat>(A), 1, M, SolveHint::many_rhs, {});
  VecX b = VecX::Zero(n);
  b[0] = 5;
  b[n - 1] = 1e-3;
  std::vector<ScaledField<double>> fields;
  for (const int threads : {1, 3}) {
    set_thread_count(threads);
    Report report;
    fields.push_back(system.solve(b, piece, {}, report));
  }
  set_thread_count(0);
  EXPECT_EQ(fields[0].x, fields[1].x);
  EXPECT_EQ(fields[0].layer, fields[1].layer);
  EXPECT_EQ(fields[0].scale, fields[1].scale);
  const double ratio = 1 + 1 / (2 * t) - std::sqrt(1 / t + 1 / (4 * t * t));
  std::vector<double> sum(1, 0);
  for (const double s : fields[0].scale) sum.push_back(sum.back() + std::log(s));
  const auto log_at = [&](int i) {
    return std::log(fields[0].x[i]) + sum[static_cast<std::size_t>(fields[0].layer[i]) + 1];
  };
  EXPECT_GT(fields[0].scale.size(), 10);
  for (const int i : {1, 500, 12345, 30000})
    EXPECT_NEAR(log_at(i) - log_at(0), i * std::log(ratio), 1e-9 * i);
  for (const int i : {1, 500, 12345, 25000})
    EXPECT_NEAR(log_at(n - 1 - i) - log_at(n - 1), i * std::log(ratio), 1e-9 * i);
  const std::vector<double> largest = largest_of_pieces(nonzero_blocks(b, 1), piece);
  EXPECT_EQ(largest, (std::vector<double>{5, 1e-3}));
}

TEST(HeatSolve, SoftConstraints) {
  std::mt19937 random(4);
  const int n = 20;
  const Dense L = random_laplacian(n, random), A = random_rows(6, n, random);
  const VecX b = random_balanced(n, random), w = VecX::LinSpaced(6, 1, 100);
  Report report;
  const VecX x = Poisson(lower_of(L), std::vector<int>(n, 0), 1, {})
                     .solve_soft(b, A.sparseView(), w, {}, report);
  const Dense K = L + A.transpose() * w.asDiagonal() * A;
  EXPECT_LE((x - test::dense_solve(K, b)).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(HeatSolve, CholeskyAgreesWithDense) {
  std::mt19937 random(5);
  const int n = 50;
  const Dense A = random_laplacian(n, random) + 0.1 * Dense::Identity(n, n);
  Dense b(n, 2);
  b << random_balanced(n, random), random_balanced(n, random);
  const Cholesky<double> factor(lower_of(A), {});
  EXPECT_LE((A * factor.solve(b) - b).cwiseAbs().maxCoeff(), 1e-11);

  Eigen::MatrixXcd H = A.cast<Complex>();
  H(1, 0) += Complex(0, 0.05);
  H(0, 1) -= Complex(0, 0.05);
  const SpMatC lower = H.triangularView<Eigen::Lower>().toDenseMatrix().sparseView();
  const Cholesky<Complex> complex_factor(lower, {});
  const Eigen::MatrixXcd c = b.cast<Complex>() * Complex(1, 2);
  EXPECT_LE((H * complex_factor.solve(c) - c).cwiseAbs().maxCoeff(), 1e-10);
}

TEST(HeatSolve, IndefiniteMatricesAreErrors) {
  Dense A = Dense::Identity(4, 4);
  A(2, 2) = -1;
  EXPECT_THROW(Cholesky<double>(lower_of(A), {}), SolveError);
  EXPECT_THROW(Cholesky<Complex>(lower_of(A).cast<Complex>(), {}), SolveError);
}

TEST(HeatTask, ProgressNeverFallsAndEndsAtOne) {
  const SurfaceMesh mesh(test::octasphere_soup(4));
  Report report;
  const auto p = test::problem(mesh, test::vertex_points({3}), report);
  std::vector<double> seen;
  Task task(CancelToken(), [&](double fraction, const std::string&) { seen.push_back(fraction); });
  const Task build = task.stage(0.5, "build"), solve = task.stage(0.5, "solve");
  const SignedHeatSolver heat(p.ops, 1, build);
  heat.solve(p.terms, {1}, solve, report);
  task.checkpoint(1);
  ASSERT_GT(seen.size(), 4u);
  EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
  EXPECT_GE(seen.front(), 0);
  EXPECT_EQ(seen.back(), 1);
}

TEST(HeatTask, CancelledBeforeItStarts) {
  const SurfaceMesh mesh(test::octasphere_soup(2));
  Report report;
  const auto p = test::problem(mesh, test::vertex_points({3}), report);
  const CancelToken cancel;
  cancel.cancel();
  EXPECT_THROW(SignedHeatSolver(p.ops, 1, Task(cancel)), Cancelled);
  EXPECT_THROW(SignedHeatSolver(p.ops, 1).solve(p.terms, {1}, Task(cancel), report), Cancelled);
  EXPECT_THROW(UnsignedHeatSolver(p.ops, {}, Task(cancel)), Cancelled);
}

TEST(HeatTask, CancelledFromAnotherThread) {
  const SurfaceMesh mesh(test::octasphere_soup(6));
  Report report;
  const auto p = test::problem(mesh, test::vertex_points({3}), report);
  const CancelToken cancel;
  std::thread other([cancel] {
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    cancel.cancel();
  });
  EXPECT_THROW(
      {
        for (;;) SignedHeatSolver(p.ops, 1, Task(cancel)).solve(p.terms, {1}, Task(cancel), report);
      },
      Cancelled);
  other.join();
}

TEST(HeatParallel, CoversTheRangeOnceAndRethrowsTheFirstError) {
  for (int threads : {1, 2, 3}) {
    set_thread_count(threads);
    std::vector<std::atomic<int>> touched(1001);
    parallel_for(1001, 10, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) ++touched[i];
    });
    for (const auto& count : touched) EXPECT_EQ(count, 1);
    try {
      parallel_for(100, 10, [](std::size_t begin, std::size_t) {
        if (begin >= 30) throw InputError("piece " + std::to_string(begin));
      });
      ADD_FAILURE() << "nothing thrown";
    } catch (const InputError& error) {
      EXPECT_STREQ(error.what(), "piece 30") << threads;
    }
  }
  set_thread_count(0);
}

TEST(HeatOptions, ErrorsNameTheOption) {
  using testing::HasSubstr;
  SignedHeat options;
  const auto& table = signed_heat_options();
  const auto message = [&](const char* name, const char* value) -> std::string {
    try {
      table.set(options, name, value);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_THAT(message("timescale", "1"), HasSubstr("unknown option 'timescale'"));
  EXPECT_THAT(message("timescale", "1"), HasSubstr("time-scale"));
  for (const char* bad : {"", "x", "1x", " 1", "0x1p3"})
    EXPECT_THAT(message("time-scale", bad), HasSubstr("not a number")) << bad;
  for (const char* bad : {"-1", "1e7", "inf", "nan"})
    EXPECT_THAT(message("time-scale", bad), HasSubstr("outside 0 to")) << bad;
  EXPECT_THAT(message("constraint", "hard"), HasSubstr("level-sets"));
  EXPECT_THAT(message("preserve-normals", "maybe"), HasSubstr("on or off"));
  EXPECT_EQ(options.time_scale, SignedHeat().time_scale);
  EXPECT_EQ(message("time-scale", "2.5"), "accepted");
  EXPECT_EQ(options.time_scale, 2.5);
}

}  // namespace
}  // namespace littoral
