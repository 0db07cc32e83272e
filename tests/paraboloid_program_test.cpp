// Interior-point method for paraboloids over elements: programs whose optimum is known.

#include "solve/optimization/paraboloid_program.h"

#include <gtest/gtest.h>

#include "solve/optimization/paraboloid_rows.h"

namespace littoral {
namespace {

using Program = ParaboloidProgram<6, 2>;
using SmallSolver = ParaboloidSolver<6, 2>;

/// Slopes along unknowns i and j, value unknown k.
Program::Point point(int k, int i, int j) {
  return {Program::Row::Unit(k), {Program::Row::Unit(i), Program::Row::Unit(j)}};
}

/// One element: x1 + 2 x4 under x0 >= |T (x1, x2)|^2 / 4, x0 <= 1, x3 >= |T (x4, x5)|^2 / 4, x3 <=
/// 4. For the identity x = (1, 2, 0, 4, 4, 0).
Program two_disks() {
  Program program;
  program.c = VecX::Zero(6);
  program.c[1] = 1;
  program.c[4] = 2;
  program.transform = {Program::Transform::Identity()};
  program.weight = {1};
  program.points = {point(0, 1, 2), point(3, 4, 5)};
  program.samples = {{0, 0, 1}, {0, 1, 1}};
  program.caps = {{0, 1, Program::Row::Unit(0)}, {0, 4, Program::Row::Unit(3)}};
  return program;
}

SmallSolver one_element() { return SmallSolver(6, {{0, 1, 2, 3, 4, 5}}, Task()); }

ParaboloidResult solved(const Program& program, double tolerance = 1e-9,
                        const SmallSolver::Inserter& insert = {}) {
  return one_element().solve(program, VecX::Constant(6, 0.1), {tolerance, 100}, insert, Task());
}

void expect_near(const VecX& x, const VecX& known, double tolerance) {
  EXPECT_LT((x - known).cwiseAbs().maxCoeff(), tolerance) << x.transpose();
}

TEST(ParaboloidProgram, RowsAgreeWithGradientsWrittenOut) {
  using At = paraboloid::RowAt<6, 2>;
  const Program::Row x = (Program::Row() << 3, 1, -2, 0.5, 2, 1).finished();
  const Program::Row dx = (Program::Row() << -1, 2, 1, 0.3, -0.7, 4).finished();
  const Program::Point p{Program::Row::LinSpaced(6, -1, 2),
                         {Program::Row::LinSpaced(6, 2, 5), Program::Row::Unit(3)}};
  const Program::Transform T = (Program::Transform() << 0.5, 2, -1, 3).finished();
  Eigen::Matrix<double, 2, 6> TG;
  TG << p.g[0].transpose(), p.g[1].transpose();
  TG = T * TG;
  const Program::Row a = p.q - 0.5 * TG.transpose() * (TG * x);
  const At at{p, T};
  const At::Small y = at.slopes(x), dy = at.slopes(dx);
  EXPECT_NEAR(at.value(7, x), 7 + p.q.dot(x) - 0.25 * (TG * x).squaredNorm(), 1e-12);
  EXPECT_NEAR(at.slope(y, dx, dy), a.dot(dx), 1e-12);
  Program::Row sum = x;
  at.add_gradient(-2, y, sum);
  at.add(0.5, dy, sum);
  expect_near(sum, x - 2 * a + 0.5 * p.q + TG.transpose() * dy, 1e-12);
  for (int d = 0; d < 2; ++d) expect_near(at.slope_row(d), TG.row(d).transpose(), 1e-12);
}

TEST(ParaboloidProgram, StepsEndWhereTheFirstRowDoes) {
  // s + t b - t^2 bend, s + t ds and z + t dz of three rows; the least zero of each kind counts.
  paraboloid::Steps steps;
  paraboloid::Row<2> r;
  r.s = 2, r.z = 1, r.exact = true;
  steps.add(r, {1, 0.1});  // positive up to 11.7
  EXPECT_EQ(steps.to_primal, 2);
  steps.add(r, {1, 3});  // zero at 1
  EXPECT_NEAR(steps.to_primal, 1, 1e-15);
  r.exact = false;
  steps.add(r, {100, 0, -4, -0.8});
  EXPECT_NEAR(steps.to_primal, 0.5, 1e-15);
  EXPECT_NEAR(steps.to_dual, 1.25, 1e-15);
  steps.add(r, {0, 0, 1, -4});
  EXPECT_NEAR(steps.to_primal, 0.5, 1e-15);
  EXPECT_NEAR(steps.to_dual, 0.25, 1e-15);
  EXPECT_EQ(steps.primal(), 0.99 * 0.5);
}

TEST(ParaboloidProgram, RowsAreInsertedBehindThoseOfTheirElements) {
  using Rows = paraboloid::ParaboloidRows<6, 2>;
  Program program = two_disks();
  program.transform.assign(3, Program::Transform::Identity());
  program.samples = {{0, 0, 1}, {0, 1, 2}, {2, 0, 3}};
  program.caps = {{1, 5, Program::Row::Unit(0)}};
  Rows rows(program, 0);
  const auto sizes = [&] {
    std::vector<double> all;
    for (const auto& origin : rows.origin) all.push_back(origin.size);
    return all;
  };
  EXPECT_EQ(sizes(), (std::vector<double>{1, 2, 5, 3}));
  EXPECT_EQ(rows.bound_of(rows.row[2]), 5);
  paraboloid::Row<2> r;
  r.point = 1;
  rows.insert({{0, r, {10}}, {0, r, {11}}, {2, r, {12}}});
  EXPECT_EQ(rows.first, (std::vector<int>{0, 4, 5, 7}));
  EXPECT_EQ(sizes(), (std::vector<double>{1, 2, 10, 11, 5, 3, 12}));
  std::vector<int> points;
  for (const auto& row : rows.row) points.push_back(row.point);
  EXPECT_EQ(points, (std::vector<int>{0, 1, 1, 1, 2, 0, 1}));
}

TEST(ParaboloidProgram, FindsTheRimOfTwoDisks) {
  const ParaboloidResult result = solved(two_disks());
  EXPECT_TRUE(result.converged);
  expect_near(result.x, (VecX(6) << 1, 2, 0, 4, 4, 0).finished(), 1e-6);
  EXPECT_NEAR(result.objective, 10, 1e-7);
  EXPECT_LE(result.gap, 1e-8);
  EXPECT_EQ(result.samples, 2U);
}

TEST(ParaboloidProgram, TransformsActOnTheSlopes) {
  Program program = two_disks();
  program.transform[0] << 0, 2, 1, 0;  // x1^2 + 4 x2^2
  expect_near(solved(program).x, (VecX(6) << 1, 2, 0, 4, 4, 0).finished(), 1e-6);
  program.transform[0] << 2, 0, 0, 1;  // 4 x1^2 + x2^2
  expect_near(solved(program).x, (VecX(6) << 1, 1, 0, 4, 2, 0).finished(), 1e-6);
}

TEST(ParaboloidProgram, TheGapBoundsTheDistanceFromTheOptimum) {
  for (double tolerance : {1e-2, 1e-4, 1e-6}) {
    const ParaboloidResult result = solved(two_disks(), tolerance);
    EXPECT_TRUE(result.converged);
    EXPECT_LE(std::abs(result.objective - 10), 20 * tolerance * 10);
  }
  // Of iterates, too, once the dual residual is small: what is missing is at most both together.
  int seen = 0;
  for (int most = 1; most < 25; ++most) {
    const ParaboloidResult r =
        one_element().solve(two_disks(), VecX::Constant(6, 0.1), {1e-12, most}, {}, Task());
    if (r.dual_residual > 0.2) continue;
    EXPECT_LE(10 - r.objective, (r.gap + r.dual_residual) * r.objective + 1e-9) << most;
    ++seen;
  }
  EXPECT_GE(seen, 5);
}

TEST(ParaboloidProgram, SamplesThatAreStillMissingAreCounted) {
  // Each round finds that a little less is allowed than the samples so far say.
  double slope = 1;
  const ParaboloidResult result = solved(two_disks(), 1e-9, [&](const VecX&, double) {
    Program::Point p = point(0, 1, 2);
    p.g[0] *= slope += 0.1;
    return std::vector<Program::Inserted>{{0, p, 1}};
  });
  EXPECT_FALSE(result.converged);
  EXPECT_EQ(result.missing, 1U);
}

TEST(ParaboloidProgram, InsertedSamplesHold) {
  // Where x1 > 1 a sample is inserted that allows no more than that.
  const ParaboloidResult result = solved(two_disks(), 1e-9, [](const VecX& x, double share) {
    std::vector<Program::Inserted> found;
    if (x[1] > 1 + share * 1e-6) {
      Program::Point p = point(0, 1, 2);
      p.g[0] *= 2;
      found.push_back({0, p, 1});
    }
    return found;
  });
  EXPECT_TRUE(result.converged);
  expect_near(result.x, (VecX(6) << 1, 1, 0, 4, 4, 0).finished(), 1e-5);
  EXPECT_GE(result.samples, 3U);
}

TEST(ParaboloidProgram, SaysThatItHasNotConverged) {
  const ParaboloidResult result =
      one_element().solve(two_disks(), VecX::Constant(6, 0.1), {1e-9, 3}, {}, Task());
  EXPECT_FALSE(result.converged);
  EXPECT_GT(result.gap, 1e-9);
  EXPECT_TRUE(result.x.allFinite());
}

TEST(ParaboloidProgram, LengthsMayHaveAnySize) {
  for (double size : {1e-6, 1e6}) {
    Program program = two_disks();
    for (auto& cap : program.caps) cap.bound *= size * size;
    for (auto& sample : program.samples) sample.tau *= size * size;
    const VecX x0 = VecX::Constant(6, 0.1 * size * size);
    const ParaboloidResult result = one_element().solve(program, x0, {1e-9, 100}, {}, Task());
    EXPECT_TRUE(result.converged);
    EXPECT_NEAR(result.x[1] / size, 2, 1e-5);
    EXPECT_NEAR(result.x[4] / size, 4, 1e-5);
  }
}

}  // namespace
}  // namespace littoral
