#pragma once
// Clouds on a torus.

#include <cmath>
#include <random>

#include "sources/space/oriented_points.h"

namespace littoral::test {

constexpr double tube = 0.4;  // radius; the other is 1

/// n points at random, evenly by area, on the torus about z, with their normals.
inline OrientedPoints torus_cloud(int n, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(0, 1);
  const double turn = 2 * std::acos(-1.0);
  OrientedPoints cloud;
  cloud.points.resize(n, 3);
  cloud.normals.resize(n, 3);
  for (int i = 0; i < n;) {
    const double u = turn * uniform(random), v = turn * uniform(random);
    if (uniform(random) > (1 + tube * std::cos(v)) / (1 + tube)) continue;
    const Vec3 normal(std::cos(v) * std::cos(u), std::cos(v) * std::sin(u), std::sin(v));
    cloud.normals.row(i) = normal;
    cloud.points.row(i++) = Vec3(std::cos(u), std::sin(u), 0) + tube * normal;
  }
  return cloud;
}

}  // namespace littoral::test
