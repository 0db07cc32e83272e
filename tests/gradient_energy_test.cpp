// Proximal steps of energies in the unit ball, beside the best of very many vectors.

#include "solve/optimization/gradient_energy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "solve/optimization/bounded_values.h"

namespace littoral {
namespace {

/// phi(z) + rho/2 |z - w|^2.
double objective(const GradientEnergy& energy, double rho, const Vec2& w, const Vec2& z) {
  return energy.value(0, z.data()) + 0.5 * rho * (z - w).squaredNorm();
}

void expect_least(const GradientEnergy& energy, double rho, const Vec2& w) {
  Vec2 z;
  energy.prox(0, rho, w.data(), z.data());
  EXPECT_LE(z.norm(), 1 + 1e-12);
  const double least = objective(energy, rho, w, z);
  constexpr int radii = 60, angles = 180;
  for (int i = 0; i <= radii; ++i)
    for (int k = 0; k < angles; ++k) {
      const double r = double(i) / radii, turn = 2 * std::numbers::pi * k / angles;
      const Vec2 other = r * Vec2(std::cos(turn), std::sin(turn));
      EXPECT_LE(least, objective(energy, rho, w, other) + 1e-10) << w.transpose();
    }
}

TEST(GradientEnergy, ProximalStepsAreTheLeastInTheBall) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0.1, 3);
  for (int round = 0; round < 20; ++round) {
    MatX3 frame(2, 3);
    for (double& x : frame.reshaped()) x = normal(random);
    const Vec3 first = frame.row(0).normalized();
    frame.row(0) = first;
    frame.row(1) =
        (frame.row(1).transpose() - first * first.dot(frame.row(1).transpose())).normalized();
    const Vec2 w(1.5 * normal(random), 1.5 * normal(random)), v(normal(random), normal(random));
    const double a = uniform(random), b = uniform(random), rho = uniform(random);
    expect_least(BallMaxNormEnergy(a, frame), rho, w);
    expect_least(BallQuadraticEnergy(2, a, b, v), rho, w);
    expect_least(BallQuadraticEnergy(2, a, 0, {}), rho, w);
  }
}

/// Many cells at once are the cells one by one, to the last bit.
TEST(GradientEnergy, StepsOfManyCellsAreThoseOfEach) {
  std::mt19937 random(6);
  std::normal_distribution<double> normal;
  const auto expect_same = [&](const GradientEnergy& energy, int dim, Eigen::Index cells) {
    VecX w(dim * cells), rho(cells), all = VecX::Constant(dim * cells, 7), one = all;
    for (double& x : w) x = 2 * normal(random);
    for (double& x : rho) x = std::exp(normal(random));
    w.head(dim).setZero();
    const Eigen::Index first = 1, count = cells - 2;  // neither from the first nor to the last
    energy.prox_all(first, count, dim, rho.data() + first, w.data() + dim * first,
                    all.data() + dim * first);
    for (Eigen::Index c = first; c < first + count; ++c)
      energy.prox(c, rho[c], w.data() + dim * c, one.data() + dim * c);
    EXPECT_EQ(all, one) << dim;
  };
  for (const int dim : {1, 2, 3}) {
    constexpr Eigen::Index cells = 9, bounds = 4;
    const BallQuadraticEnergy ball(dim, 0.7, 0, {});
    VecX v(dim * cells);
    for (double& x : v) x = normal(random);
    v.segment(2 * dim, dim).setZero();
    expect_same(ball, dim, cells);
    expect_same(BallQuadraticEnergy(dim, 0.7, 1.2, v), dim, cells);
    const VecX bound = VecX::Constant(bounds, 0.5);
    expect_same(BoundedEnergy(ball, dim, cells, {1, -1, 1, -1}, bound), dim, cells + bounds);
    expect_same(BoundedEnergy(ball, dim, 0, {1, -1, 1, -1}, bound), dim, bounds);
  }
}

}  // namespace
}  // namespace littoral
