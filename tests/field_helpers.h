#pragma once
// Fields with known distance, and where to ask them.

#include <functional>
#include <random>
#include <utility>
#include <vector>

#include "methods/implicit/pointwise.h"

namespace littoral::test {

/// A field given by a formula.
class Formula final : public PointwiseDistance {
 public:
  explicit Formula(std::function<DistanceSample(const Vec3&)> ask) : ask_(std::move(ask)) {}
  DistanceSample at(const Vec3& x) const override { return ask_(x); }

 private:
  std::function<DistanceSample(const Vec3&)> ask_;
};

/// n points in [-reach, reach]^3.
inline std::vector<Vec3> places(int n, unsigned seed, double reach) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-reach, reach);
  std::vector<Vec3> out;
  for (int i = 0; i < n; ++i) {
    const double x = uniform(random), y = uniform(random);
    out.emplace_back(x, y, uniform(random));
  }
  return out;
}

}  // namespace littoral::test
