// Proximal steps of energies in the unit ball, beside the best of very many vectors.

#include "solve/optimization/gradient_energy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

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

}  // namespace
}  // namespace littoral
