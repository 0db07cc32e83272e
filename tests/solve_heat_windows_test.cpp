// Heat window by window against renormalised passes on one factorization.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <random>

#include "base/parallel.h"
#include "heat_helpers.h"
#include "solve/direct/hermitian_rows.h"
#include "solve/heat/heat_system.h"
#include "test_meshes.h"

namespace littoral {
namespace {

SpMatC heat_matrix(const VectorDiffusion& V, double t) {
  SpMatC A = V.L({}) * Complex(t);
  for (int i = 0; i < V.n; ++i) A.coeffRef(i, i) += V.M[i] > 0 ? V.M[i] : 1.0;
  A.makeCompressed();
  return A;
}

VecXc as_complex(const VecX& X) {
  VecXc z(X.size() / 2);
  for (Eigen::Index i = 0; i < z.size(); ++i) z[i] = {X[2 * i], X[2 * i + 1]};
  return z;
}

VecX directions(const VectorDiffusion& V, const ScaledField<Complex>& field) {
  ScaledField<double> pairs{VecX(2 * field.x.size()), field.layer, field.scale};
  for (Eigen::Index i = 0; i < field.x.size(); ++i) {
    pairs.x[2 * i] = field.x[i].real();
    pairs.x[2 * i + 1] = field.x[i].imag();
  }
  const CellField Y = cell_field(V.to_cells, pairs);
  EXPECT_TRUE(Y.log_length.array().isFinite().all());
  return Y.Y;
}

struct Both {
  VecX windows, passes;
  double n_windows = 0, n_passes = 0;
};

Both solve_both(const VectorDiffusion& V, const VecX& X0, double time_scale) {
  const double t = time_scale * V.h * V.h;
  const auto A = std::make_shared<const SpMatC>(heat_matrix(V, t));
  const Ordering order = dissection(*A, {});
  Report report;
  Both both;
  const auto field = HeatWindows<Complex>(rows_of<Complex>(A, 1), V.M, order)
                         .solve(nonzero_blocks(as_complex(X0), 1), V.piece, {}, report);
  EXPECT_TRUE(field.has_value());
  if (!field) return both;
  both.n_windows = report.iterations.back().second;
  both.windows = directions(V, *field);
  const HeatSystem<Complex> system(A, 1, V.M, SolveHint::many_rhs, {}, order);
  both.passes = directions(V, system.solve(as_complex(X0), V.piece, {}, report));
  both.n_passes = report.iterations.back().second;
  return both;
}

/// Largest difference of two fields of directions, and its mean.
std::pair<double, double> difference(const VecX& a, const VecX& b) {
  double largest = 0, sum = 0;
  for (Eigen::Index c = 0; c < a.size() / 2; ++c) {
    const double d = (a.segment<2>(2 * c) - b.segment<2>(2 * c)).norm();
    largest = std::max(largest, d);
    sum += d;
  }
  return {largest, sum / std::max(1.0, double(a.size() / 2))};
}

TEST(HeatWindows, AgreeWithPassesAcrossManyWindows) {
  // A long strip: 700 cells, so that heat at time scale 1 spans more than one pass.
  PolygonSoup strip = test::grid_soup(700, 4);
  strip.points.col(0) *= 700 / 4;  // square cells
  const SurfaceMesh mesh(strip);
  Report report;
  for (int end : {0, 350}) {
    const auto p = test::problem(mesh, test::vertex_points({end}), report);
    for (double scale : {0.25, 1.0, 16.0}) {
      const Both both = solve_both(p.ops->vector, p.terms.vectors(p.ops->vector.n), scale);
      const auto [largest, mean] = difference(both.windows, both.passes);
      EXPECT_LE(mean, 1e-12) << scale;
      EXPECT_LE(largest, 1e-9) << scale;
      EXPECT_GE(both.n_windows, scale < 2 ? 5 : 1);
    }
  }
}

/// Places along a line, numbered at random, with two unknowns each that are turned against those
/// of the next: 2 + s on the diagonal and -1 between neighbours but for the turns, so that the
/// answer to 1 at one end is known (a hyperbolic sine).
struct TurnedChain {
  explicit TurnedChain(int n, double s) : decay(2 * std::asinh(std::sqrt(s) / 2)), number(n) {
    std::mt19937 random(7);
    std::iota(number.begin(), number.end(), 0);
    std::shuffle(number.begin(), number.end(), random);
    std::uniform_real_distribution<double> angle(0, 6);
    for (int k = 0; k < n; ++k) turn.emplace_back(Eigen::Rotation2Dd(angle(random)).matrix());
    std::vector<Eigen::Triplet<double>> entries;
    for (int k = 0; k < n; ++k) {
      for (int i = 0; i < 2; ++i) entries.emplace_back(2 * number[k] + i, 2 * number[k] + i, 2 + s);
      if (k + 1 == n) continue;
      const Eigen::Matrix2d between = -turn[k] * turn[k + 1].transpose();
      for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j) {
          const int row = 2 * number[k] + i, column = 2 * number[k + 1] + j;
          entries.emplace_back(std::max(row, column), std::min(row, column), between(i, j));
        }
    }
    A.resize(2 * n, 2 * n);
    A.setFromTriplets(entries.begin(), entries.end());
  }
  /// At place k, for a source of (1, 0) in the own frame of place 0.
  Vec2 exact(int k) const {
    const double n = double(number.size());
    return turn[k] * Vec2(std::sinh((n - k) * decay) / std::sinh((n + 1) * decay), 0);
  }

  double decay;
  std::vector<int> number;
  std::vector<Eigen::Matrix2d> turn;
  SpMat A;
};

TEST(HeatWindows, BlocksOfTwoUnknownsAreSolvedAcrossWindows) {
  const int n = 250;
  for (const double s : {0.5, 1.0}) {
    const TurnedChain chain(n, s);
    Ordering order(n);
    std::iota(order.begin(), order.end(), 0);
    const VecX M = VecX::Constant(n, s);
    const HeatWindows<double> windows(rows_of(std::make_shared<const SpMat>(chain.A), 2), M, order);
    VecX b = VecX::Zero(2 * n);
    b.segment<2>(2 * chain.number[0]) = chain.turn[0].col(0);
    Report report;
    const auto field = windows.solve(nonzero_blocks(b, 2), std::vector<int>(n, 0), {}, report);
    ASSERT_TRUE(field.has_value());
    EXPECT_GE(report.iterations.back().second, 4);  // windows
    for (int k = 0; k < n; ++k) {
      const int i = chain.number[k];
      double scale = 1;
      for (int p = 0; p <= field->layer[i]; ++p) scale *= field->scale[p];
      const Vec2 expected = chain.exact(k), found = scale * field->x.segment<2>(2 * i);
      EXPECT_LE((found - expected).norm(), 1e-10 * expected.norm()) << k;
    }
  }
}

TEST(HeatWindows, BlocksOfTwoUnknownsThatAreHeldAreHeld) {
  // Held in the middle: on both sides the answer decays as towards an end far away.
  const int n = 201, middle = 100;
  const TurnedChain chain(n, 1);
  Ordering order(n);
  std::iota(order.begin(), order.end(), 0);
  const VecX M = VecX::Ones(n);
  const HeatWindows<double> windows(rows_of(std::make_shared<const SpMat>(chain.A), 2), M, order);
  VecX held = VecX::Zero(2 * n);
  held.segment<2>(2 * chain.number[middle]) = chain.turn[middle].col(0);
  const VecX b = windows.source_prescribing(held, {});
  // (2 + s) x_0 - x_1 - x_-1 with x_1 = exp(-decay): 2 sinh(decay).
  for (int k = 0; k < n; ++k) {
    const Vec2 expected =
        k == middle ? Vec2(2 * std::sinh(chain.decay) * chain.turn[k].col(0)) : Vec2(0, 0);
    EXPECT_LE((b.segment<2>(2 * chain.number[k]) - expected).norm(), 1e-12) << k;
  }
}

TEST(HeatWindows, AgreeWithPassesOnStretchedTriangles) {
  // 175 times as high as wide, so that heat decays over many more of them in one direction than in
  // the other, and turned, so that edges run across.
  Report report;
  for (const double shear : {0.0, 0.4}) {
    PolygonSoup strip = test::grid_soup(700, 4);
    strip.points.col(0) += shear * strip.points.col(1);
    const SurfaceMesh mesh(strip);
    const auto p = test::problem(mesh, test::vertex_points({0}), report);
    const Both both = solve_both(p.ops->vector, p.terms.vectors(p.ops->vector.n), 1e-4);
    const auto [largest, mean] = difference(both.windows, both.passes);
    EXPECT_LE(mean, 1e-12) << shear;
    EXPECT_LE(largest, 1e-8) << shear;
    EXPECT_GE(both.n_windows, 3) << shear;
  }
}

TEST(HeatWindows, LeaveOutBlocksThatNothingReaches) {
  // A chain with rows of the identity at both ends, as those of nodes held at 0: on what is
  // between, the answer is that of a chain cut there.
  const int n = 300;
  const double w = 0.2, decay = 2 * std::asinh(0.5 / std::sqrt(w));
  Triplets entries;
  for (int k = 0; k < n; ++k) {
    const bool held = k == 0 || k == n - 1;
    entries.emplace_back(k, k, held ? 1 : 1 + 2 * w);
    if (k + 1 < n) entries.emplace_back(k + 1, k, held || k + 2 == n ? 0 : -w);
  }
  SpMat A(n, n);
  A.setFromTriplets(entries.begin(), entries.end());
  const VecX M = VecX::Ones(n);
  Ordering order(n);
  std::iota(order.begin(), order.end(), 0);
  const HeatWindows<double> windows(rows_of(std::make_shared<const SpMat>(A), 1), M, order);
  VecX b = VecX::Zero(n);
  b[1] = 1;
  Report report;
  const auto field = windows.solve(nonzero_blocks(b, 1), std::vector<int>(n, 0), {}, report);
  ASSERT_TRUE(field.has_value());
  EXPECT_EQ(field->layer[0], -1);
  EXPECT_EQ(field->layer[n - 1], -1);
  for (int k = 1; k + 1 < n; ++k) {
    double scale = 1;
    for (int p = 0; p <= field->layer[k]; ++p) scale *= field->scale[p];
    const double expected = std::sinh((n - 1 - k) * decay) / std::sinh((n - 1) * decay) / w;
    EXPECT_LE(std::abs(scale * field->x[k] - expected), 1e-10 * expected) << k;
  }
}

/// Masses so much larger than the matrix's that distances are far too long.
struct Misjudged {
  Report report;
  SurfaceMesh mesh{test::grid_soup(700, 4)};
  test::Problem p = test::problem(mesh, test::vertex_points({0}), report);
  const VectorDiffusion& V = p.ops->vector;
  double t = V.h * V.h;
  std::shared_ptr<const SpMatC> A = std::make_shared<const SpMatC>(heat_matrix(V, t));
  VecX M = 1e6 * V.M;
};

TEST(HeatWindows, NoticeMisjudgedDistances) {
  Misjudged m;
  auto& [report, mesh, p, V, t, A, M] = m;
  const HeatWindows<Complex> windows(rows_of<Complex>(A, 1), M, dissection(*A, {}));
  const VecXc b = as_complex(p.terms.vectors(p.ops->vector.n));
  EXPECT_FALSE(windows.solve(nonzero_blocks(b, 1), V.piece, {}, report).has_value());
}

TEST(HeatWindows, MatricesGivenByRowsAreFactoredWhereDistancesAreMisjudged) {
  Misjudged m;
  auto& [report, mesh, p, V, t, A, M] = m;
  const Ordering order = dissection(*A, {});
  const VecXc b = as_complex(p.terms.vectors(V.n));
  const HeatSystem<Complex> factored(A, 1, M, SolveHint::many_rhs, {}, order);
  const HeatSystem<Complex> by_rows(rows_of<Complex>(A, 1), M, order);
  ASSERT_EQ(by_rows.factor(), nullptr);
  const auto expected = factored.solve(b, V.piece, {}, report);
  const auto found = by_rows.solve(b, V.piece, {}, report);
  EXPECT_EQ(report.iterations.back().first, "heat passes");
  EXPECT_LE(difference(directions(V, found), directions(V, expected)).first, 1e-12);
}

TEST(HeatWindows, AgreeOnLoopsPointsAndFrontsThatMeet) {
  const SurfaceMesh mesh(test::octasphere_soup(5));
  Report report;
  Sources loops = test::space_curve(test::circle(0, 0, 0.99, 0.14, 60));
  loops.space_curves.push_back({test::circle(0, 0, -0.99, 0.14, 60), true, "other"});
  Sources mixed = test::space_curve(test::circle(0, 0, 0.6, 0.8, 100));
  mixed.points.push_back(SurfacePoint::at_vertex(5));
  for (const Sources& sources : {loops, mixed, test::vertex_points({0, 1, 77, 400})}) {
    const auto p = test::problem(mesh, sources, report);
    const Both both = solve_both(p.ops->vector, p.terms.vectors(p.ops->vector.n), 1);
    const auto [largest, mean] = difference(both.windows, both.passes);
    EXPECT_LE(mean, 1e-12);
    EXPECT_LE(largest, 1e-8);  // on the ridge between two sources the directions nearly cancel
  }
}

TEST(HeatWindows, DisconnectedPartsOfDifferentStrengthAreAllReached) {
  PolygonSoup soup = test::octasphere_soup(4);
  const PolygonSoup other = test::octasphere_soup(3);
  const int n = soup.n_vertices();
  MatX3 points(n + other.n_vertices(), 3);
  points << soup.points, (1e-3 * other.points).rowwise() + Vec3(3, 0, 0).transpose();
  soup.points = points;
  for (int f = 0; f < other.n_faces(); ++f) {
    const auto c = other.face(f);
    test::add_triangle(soup, n + c[0], n + c[1], n + c[2]);
  }
  const SurfaceMesh mesh(soup);
  Report report;
  const auto p = test::problem(mesh, test::vertex_points({0, n + 7}), report);
  const Both both = solve_both(p.ops->vector, p.terms.vectors(p.ops->vector.n), 1);
  EXPECT_LE(difference(both.windows, both.passes).second, 1e-12);
}

TEST(HeatWindows, PartsSideBySideGiveTheSameBitsForAnyNumberOfThreads) {
  // From the middle heat goes both ways: two parts of a window, each half as long as the first one.
  PolygonSoup strip = test::grid_soup(700, 4);
  strip.points.col(0) *= 700 / 4;
  const SurfaceMesh mesh(strip);
  Report report;
  const auto p = test::problem(mesh, test::vertex_points({350}), report);
  const VectorDiffusion& V = p.ops->vector;
  const auto A = std::make_shared<const SpMatC>(heat_matrix(V, 0.25 * V.h * V.h));
  const HeatWindows<Complex> windows(rows_of<Complex>(A, 1), V.M, dissection(*A, {}));
  const auto source = nonzero_blocks(as_complex(p.terms.vectors(V.n)), 1);
  std::optional<ScaledField<Complex>> one;
  for (const int threads : {1, 2, 3}) {
    set_thread_count(threads);
    auto field = windows.solve(source, V.piece, {}, report);
    set_thread_count(0);
    ASSERT_TRUE(field.has_value());
    if (!one)
      one = std::move(field);
    else {
      EXPECT_TRUE(field->x == one->x) << threads;
      EXPECT_EQ(field->layer, one->layer) << threads;
      EXPECT_EQ(field->scale, one->scale) << threads;
    }
  }
  EXPECT_GE(report.iterations.back().second, 5);
}

TEST(HeatWindows, HeldVectorsAreHeld) {
  const SurfaceMesh mesh(test::octasphere_soup(4));
  Report report;
  const auto p = test::problem(mesh, test::space_curve(test::circle(0, 0, 0.5, 0.87, 60)), report);
  const VectorDiffusion& V = p.ops->vector;
  const VecXc held = as_complex(normalize(p.terms.vectors(V.n)));
  const double t = V.h * V.h;
  const auto A = std::make_shared<const SpMatC>(heat_matrix(V, t));
  const HeatSystem<Complex> system(A, 1, V.M, SolveHint::many_rhs, {});
  const auto field = system.solve_prescribed(held, V.piece, {}, report);
  double worst = 0, residual = 0;
  int one = 0;  // the field has one layer, in units of its own: make a held vector one long
  while (held[one] == 0.0) ++one;
  const VecXc x = field.x / std::abs(field.x[one]);
  const VecXc Ax = A->selfadjointView<Eigen::Lower>() * x;
  for (int i = 0; i < V.n; ++i) {
    EXPECT_EQ(field.layer[i], 0);
    if (held[i] != 0.0)
      worst = std::max(worst, std::abs(x[i] - held[i]));
    else
      residual = std::max(residual, std::abs(Ax[i]));
  }
  EXPECT_LE(worst, 1e-13);
  EXPECT_LE(residual, 1e-14);
}

}  // namespace
}  // namespace littoral
