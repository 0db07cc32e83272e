// Heat window by window against renormalised passes on one factorization.

#include <gtest/gtest.h>

#include <numeric>

#include "heat_helpers.h"
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
  const VecX size = decay_lengths(V.M, t);
  const Ordering order = dissection(*A, {});
  Report report;
  Both both;
  const auto field = HeatWindows<Complex>(A, 1, size, order)
                         .solve(nonzero_blocks(as_complex(X0), 1), V.piece, {}, report);
  EXPECT_TRUE(field.has_value());
  if (!field) return both;
  both.n_windows = report.iterations.back().second;
  both.windows = directions(V, *field);
  const HeatSystem<Complex> system(A, 1, size, SolveHint::many_rhs, {}, order);
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

TEST(HeatWindows, PairsOfRealsAreComplexNumbers) {
  PolygonSoup strip = test::grid_soup(300, 4);
  strip.points.col(0) *= 300 / 4;  // square cells
  const SurfaceMesh mesh(strip);
  Report report;
  const auto p = test::problem(mesh, test::vertex_points({0, 150}), report);
  const VectorDiffusion& V = p.ops->vector;
  const double t = V.h * V.h;
  const auto A = std::make_shared<const SpMatC>(heat_matrix(V, t));
  Triplets entries;  // a + i b as a, -b / b, a
  for (int j = 0; j < V.n; ++j)
    for (SpMatC::InnerIterator it(*A, j); it; ++it) {
      const int i = static_cast<int>(it.row());
      entries.emplace_back(2 * i, 2 * j, it.value().real());
      entries.emplace_back(2 * i + 1, 2 * j + 1, it.value().real());
      entries.emplace_back(2 * i + 1, 2 * j, it.value().imag());
      if (i != j) entries.emplace_back(2 * i, 2 * j + 1, -it.value().imag());
    }
  const auto R = std::make_shared<SpMat>(2 * V.n, 2 * V.n);
  R->setFromTriplets(entries.begin(), entries.end());
  const VecX size = decay_lengths(V.M, t), X0 = p.terms.vectors(V.n);
  const Ordering order = dissection(*A, {});
  const auto pairs =
      HeatWindows<double>(R, 2, size, order).solve(nonzero_blocks(X0, 2), V.piece, {}, report);
  ASSERT_TRUE(pairs.has_value());
  EXPECT_GE(pairs->scale.size(), 2u);
  const auto field = HeatWindows<Complex>(A, 1, size, order)
                         .solve(nonzero_blocks(as_complex(X0), 1), V.piece, {}, report);
  ASSERT_TRUE(field.has_value());
  ASSERT_EQ(pairs->layer, field->layer);
  const VecXc x = as_complex(pairs->x);
  for (int i = 0; i < V.n; ++i)
    EXPECT_LE(std::abs(x[i] / pairs->scale[0] - field->x[i] / field->scale[0]),
              1e-9 * std::abs(field->x[i] / field->scale[0]));
}

TEST(HeatWindows, NoticeMisjudgedDistances) {
  // Triangles 175 times as high as wide: heat decays over many more of them than their areas say.
  const SurfaceMesh mesh(test::grid_soup(700, 4));
  Report report;
  const auto p = test::problem(mesh, test::vertex_points({0}), report);
  const VectorDiffusion& V = p.ops->vector;
  const double t = V.h * V.h;
  const auto A = std::make_shared<const SpMatC>(heat_matrix(V, t));
  const HeatWindows<Complex> windows(A, 1, decay_lengths(V.M, t), dissection(*A, {}));
  const VecXc b = as_complex(p.terms.vectors(p.ops->vector.n));
  EXPECT_FALSE(windows.solve(nonzero_blocks(b, 1), V.piece, {}, report).has_value());
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

TEST(HeatWindows, HeldVectorsAreHeld) {
  const SurfaceMesh mesh(test::octasphere_soup(4));
  Report report;
  const auto p = test::problem(mesh, test::space_curve(test::circle(0, 0, 0.5, 0.87, 60)), report);
  const VectorDiffusion& V = p.ops->vector;
  const VecXc held = as_complex(normalize(p.terms.vectors(V.n)));
  const double t = V.h * V.h;
  const auto A = std::make_shared<const SpMatC>(heat_matrix(V, t));
  const VecX size = decay_lengths(V.M, t);
  const HeatSystem<Complex> system(A, 1, size, SolveHint::many_rhs, {});
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
