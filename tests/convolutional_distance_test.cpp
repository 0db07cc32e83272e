// Distance as sums of kernels: values by their formulas, gradients by differences.

#include "methods/implicit/convolutional_distance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <ostream>

#include "space_helpers.h"

namespace littoral {
namespace {

using MakeKernelSum = std::unique_ptr<const PointwiseDistance> (*)(const OrientedPoints&, double);
using KernelFormula = std::function<double(const OrientedPoints&, double, const Vec3&, double)>;

/// Sum over samples of area times what is added for an offset from one and its normal.
template <class Term>
double sum_over(const OrientedPoints& samples, const Vec3& x, const Term& term) {
  double sum = 0;
  for (Eigen::Index i = 0; i < samples.size(); ++i) {
    const Vec3 d = x - samples.points.row(i).transpose();
    sum += samples.areas[i] * term(d, d.dot(samples.normals.row(i)));
  }
  return sum;
}

struct KernelMethod {
  const char* name;
  MakeKernelSum make;
  KernelFormula formula;  // of samples, lambda, place, and the sign there
};

std::ostream& operator<<(std::ostream& out, const KernelMethod& m) { return out << m.name; }

double screened_winding(const OrientedPoints& samples, double lambda, const Vec3& x) {
  return sum_over(samples, x, [&](const Vec3& d, double plane) {
    const double r = d.norm();
    return (lambda * r + 1) * plane * std::exp(-lambda * r) / (2 * std::acos(-1.0) * r * r * r);
  });
}

double hopf_cole(const OrientedPoints& samples, double lambda, const Vec3& x, double sign) {
  return -sign * std::log(sign * screened_winding(samples, lambda, x)) / lambda;
}

double mean_plane(const OrientedPoints& samples, double lambda, const Vec3& x, double) {
  const auto weight = [&](const Vec3& d) { return std::exp(-lambda * d.norm()); };
  return sum_over(samples, x, [&](const Vec3& d, double plane) { return plane * weight(d); }) /
         sum_over(samples, x, [&](const Vec3& d, double) { return weight(d); });
}

double log_of_sum(const OrientedPoints& samples, double lambda, const Vec3& x, double sign) {
  const double sum =
      sum_over(samples, x, [&](const Vec3& d, double) { return std::exp(-lambda * d.norm()); });
  return -sign * std::log(sum / samples.areas.mean()) / lambda;
}

class ConvolutionalDistance : public testing::TestWithParam<KernelMethod> {
 protected:
  /// Samples of a torus, unevenly spaced.
  static OrientedPoints samples() {
    Report report;
    return sample_faces(test::off_centre_torus(), std::numeric_limits<double>::infinity(), report);
  }

  struct Visited {
    int inside = 0, outside = 0;
  };
  /// check(place, signed distance to the torus) at random places that are not too close to it.
  static Visited visit(int places, const std::function<void(const Vec3&, double)>& check) {
    Visited out;
    const MatX3 all = test::random_points(places, 1.1);
    for (const Vec3 x : all.rowwise()) {
      const double away = test::torus_distance(x - Vec3(0.013, 0.027, 0.031), 0.7, 0.3);
      if (std::abs(away) < 0.08) continue;
      check(x, away);
      ++(away < 0 ? out.inside : out.outside);
    }
    return out;
  }
};

TEST_P(ConvolutionalDistance, IsItsFormula) {
  const OrientedPoints torus = samples();
  for (const double lambda : {3.0, 8.0}) {
    const auto distance = GetParam().make(torus, lambda);
    const Visited n = visit(80, [&](const Vec3& x, double away) {
      const double truth = GetParam().formula(torus, lambda, x, away < 0 ? -1 : 1);
      EXPECT_NEAR(distance->at(x).value, truth, 1e-9 * std::abs(truth));
    });
    EXPECT_GT(n.inside, 3);
    EXPECT_GT(n.outside, 40);
    EXPECT_TRUE(std::isfinite(distance->at(torus.points.row(7)).value));
  }
}

TEST_P(ConvolutionalDistance, HasTheGradientThatDifferencesHave) {
  const OrientedPoints torus = samples();
  for (const double lambda : {3.0, 8.0}) {
    const auto distance = GetParam().make(torus, lambda);
    const Visited n = visit(60, [&](const Vec3& x, double away) {
      const DistanceSample here = distance->at(x);
      for (int k = 0; k < 3; ++k) {
        const Vec3 step = 1e-5 * Vec3::Unit(k);
        const double slope = (distance->value(x + step) - distance->value(x - step)) / 2e-5;
        EXPECT_NEAR(here.gradient[k], slope, 1e-6 * (1 + std::abs(slope))) << away;
      }
    });
    EXPECT_GT(n.inside, 2);
    EXPECT_GT(n.inside + n.outside, 40);
  }
}

INSTANTIATE_TEST_SUITE_P(Kernels, ConvolutionalDistance,
                         testing::Values(KernelMethod{"hopf-cole", hopf_cole_distance, hopf_cole},
                                         KernelMethod{"planar", planar_distance, mean_plane},
                                         KernelMethod{"log-sum-exp", log_sum_exp_distance,
                                                      log_of_sum}));

}  // namespace
}  // namespace littoral
