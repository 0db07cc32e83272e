// Regularized distance with a penalty of its own in every cell.

#include <gtest/gtest.h>

#include "methods/regularized/marched_start.h"
#include "methods/regularized/weighted_laplacian.h"
#include "regularized_helpers.h"
#include "test_meshes.h"

namespace littoral {
namespace {

/// A sheet of n x n squares, one row of which is squashed and sheared into triangles 500 times as
/// wide as high, with a corner over the middle of a side: u is almost linear along the whole row.
SurfaceMesh with_flat_row(int n) {
  PolygonSoup soup = test::grid_soup(n, n);
  const double h = 1.0 / n;
  for (Eigen::Index v = 0; v < soup.points.rows(); ++v)
    if (soup.points(v, 1) > 0.5 + 0.1 * h)
      soup.points.row(v) += Eigen::RowVector3d(h / 2, h / 500 - h, 0);
  return SurfaceMesh(std::move(soup));
}

TEST(CellPenalties, WeightedLaplacianIsTheProduct) {
  Report report;
  const test::Problem p = test::problem(SurfaceMesh(test::jittered_grid_soup(9, 7, 0.3)),
                                        test::vertex_points({0}), report);
  const Calculus& C = p.ops->scalar;
  const SpRows G = C.G.matrix();
  SplitProblem problem;
  problem.A = C.A;
  problem.G = G;
  const SpRows D = problem.divergence();
  VecX weight(C.A.size()), twice(2 * C.A.size());
  for (Eigen::Index c = 0; c < weight.size(); ++c)
    twice[2 * c] = twice[2 * c + 1] = weight[c] = std::exp(3 * std::sin(7.0 * double(c)));
  const auto K = weighted_laplacian(C.L, D, G, weight, 2, {});
  ASSERT_TRUE(K);
  const MatX expected = MatX(D) * twice.asDiagonal() * MatX(G);
  EXPECT_LE((MatX(*K) - MatX(expected.triangularView<Eigen::Lower>())).norm(),
            1e-12 * expected.norm());
  // A Laplacian with another term beside D G has none.
  SpMat stabilised = C.L;
  stabilised.coeffRef(5, 5) *= 1.01;
  EXPECT_FALSE(weighted_laplacian(stabilised, D, G, weight, 2, {}));
}

TEST(CellPenalties, MarchAndTransportFromASide) {
  // From the side x = 0 of the unit square the distance is x, and 1 - x is transported at x.
  const int n = 20;
  const double h = 1.0 / n;
  const SurfaceMesh mesh(test::grid_soup(n, n));
  Report report;
  const test::Problem p = test::problem(mesh, test::vertex_points({0}), report);
  const Calculus& C = p.ops->scalar;
  const double unit = p.ops->unit;
  const MatX3& points = mesh.points();
  KnownDistances known;
  for (Eigen::Index v = 0; v < points.rows(); ++v)
    if (points(v, 0) < 1e-9) known.emplace(static_cast<int>(v), 0);
  const SpRows G = C.G.matrix();
  const auto start = marched_start(G, C.A, C.M, known, {});
  ASSERT_TRUE(start);
  EXPECT_LE((start->u * unit - points.col(0)).lpNorm<Eigen::Infinity>(), 1e-12);
  double sum = 0;
  for (Eigen::Index c = 0; c < C.A.size(); ++c) {
    const double amount = start->flux.segment<2>(2 * c).norm() * unit;
    Vec3 middle = Vec3::Zero();
    for (SpRows::InnerIterator it(G, 2 * c); it; ++it) middle += points.row(it.col()) / 3;
    EXPECT_NEAR(amount, 1 - middle.x(), 0.4) << c;
    sum += C.A[c] * unit * unit * amount;
  }
  EXPECT_NEAR(sum, 0.5, h);  // work: the mean distance
  // Along the gradient of u.
  const VecX g = C.G.apply(start->u);
  for (Eigen::Index c = 0; c < C.A.size(); ++c)
    EXPECT_NEAR(start->flux.segment<2>(2 * c).dot(g.segment<2>(2 * c)),
                start->flux.segment<2>(2 * c).norm(), 1e-12);
}

TEST(CellPenalties, StartFromWhatIsTransported) {
  const double alpha = 2;
  VecX flux(6), bound(2);
  flux << 0, 0, 0.3, 0.4, 3, 4;  // nothing, less than alpha, more
  bound << 7, 9;
  SplitProblem problem;
  problem.G.resize(10, 1);
  VecX gradient(10), all(10), rest(10);
  gradient << 0, 0, 0.15, 0.2, 0.6, 0.8, 7, 0, 9, 0;
  all << flux, 0, 0, 0, 0;
  rest << 0, 0, 0, 0, 1.8, 2.4, 0, 0, 0, 0;
  start_from(flux, alpha, false, bound, problem);
  EXPECT_LE((problem.near_gradient - gradient).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_LE((problem.near_multipliers - all).cwiseAbs().maxCoeff(), 1e-15);
  start_from(flux, alpha, true, bound, problem);
  EXPECT_LE((problem.near_gradient - gradient).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_LE((problem.near_multipliers - rest).cwiseAbs().maxCoeff(), 1e-15);
  // Without smoothing every gradient has length 1 where anything is transported.
  start_from(flux, 0, false, VecX(), problem);
  gradient << 0, 0, 0.6, 0.8, 0.6, 0.8, 0, 0, 0, 0;
  EXPECT_LE((problem.near_gradient - gradient).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_LE((problem.near_multipliers - all).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(CellPenalties, NothingToMarchOverWhereCellsAreNoTriangles) {
  SpRows G(2, 4);
  for (int d = 0; d < 2; ++d)
    for (int i = 0; i < 4; ++i) G.insert(d, i) = d + i;
  G.makeCompressed();
  EXPECT_FALSE(marched_start(G, VecX::Ones(1), VecX::Ones(4), {{0, 0}}, {}));
}

TEST(CellPenalties, ChainsOfFlatTrianglesAreMetAtOnce) {
  const SurfaceMesh mesh = with_flat_row(24);
  const test::Solved best =
      test::solve(mesh, test::vertex_points({0}), test::with_alpha(0.05, 1e-5));
  const test::Solved quick = test::solve(mesh, test::vertex_points({0}), Regularized());
  EXPECT_EQ(quick.report.status, "converged");
  // 125 iterations and an error of 7.5e-3 with one penalty for all cells.
  EXPECT_LE(quick.report.iterations[0].second, 100);
  EXPECT_LE((quick.u - best.u).lpNorm<Eigen::Infinity>(), 2.5e-3 * best.u.maxCoeff());
  // Few gradients keep the gap above its limit, 0.02, and these are shortened to a quarter of that.
  EXPECT_LE(test::residual(quick.report, "largest gradient over 1"), 0.005);
}

TEST(CellPenalties, SameAnswerAsWithOnePenalty) {
  // The same problem by hand, which has no solve for penalties of cells.
  const SurfaceMesh mesh(test::jittered_grid_soup(16, 16, 0.3));
  const double alpha = 0.05;
  const test::Solved own =
      test::solve(mesh, test::vertex_points({0}), test::with_alpha(alpha, 1e-5));
  Report report;
  const test::Problem p = test::problem(mesh, test::vertex_points({0}), report);
  const Calculus& C = p.ops->scalar;
  const BallQuadraticEnergy energy(2, alpha * std::sqrt(C.A.sum()), 0, VecX());
  SpMat row(1, C.M.size());
  row.insert(0, 0) = 1;
  const auto constrained =
      ConstrainedSystem(C.L, C.component, C.n_components, {}).constrain(row, {});
  SplitProblem one;
  one.b = C.M;
  one.A = C.A;
  one.G = C.G.matrix();
  one.energy = &energy;
  one.solve = [&](const VecX& b, double rho) { return VecX(constrained.solve(b) / rho); };
  AdmmOptions options;
  options.relative = 1e-5;
  options.absolute = 5e-9;
  AdmmState state;
  const AdmmResult result = admm(one, options, state, {});
  EXPECT_TRUE(result.converged);
  EXPECT_LE((result.u * p.ops->unit - own.u).lpNorm<Eigen::Infinity>(), 2e-4 * own.u.maxCoeff());
}

}  // namespace
}  // namespace littoral
