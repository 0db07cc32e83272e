// Points as tori: the fast sums against plain ones, derivatives, clouds with wrong points, the
// learned fit, and clouds that can hardly be used.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <span>

#include "field_helpers.h"
#include "littoral/error.h"
#include "methods/tori/tori.h"
#include "sources/space/likely_outliers.h"
#include "torus_helpers.h"

namespace littoral {
namespace {

using test::places;
using test::tube;

double on_torus(const Vec3& x) { return std::hypot(std::hypot(x[0], x[1]) - 1, x[2]) - tube; }

OrientedPoints torus_cloud(int n, unsigned seed) {
  std::mt19937 random(seed);
  return test::torus_cloud(n, random);
}

ToriDistance fitted(const OrientedPoints& cloud, const TorusFit& fit = {},
                    ToriPrecision precision = ToriPrecision::full,
                    ToriOutliers outliers = ToriOutliers::keep) {
  Report report;
  return ToriDistance(cloud, fit, {}, report, precision, outliers);
}

double mean_error(const ToriDistance& tori) {
  double sum = 0;
  const auto at = places(2000, 3, 1.5);
  for (const Vec3& x : at) sum += std::abs(tori.value(x) - on_torus(x));
  return sum / static_cast<double>(at.size());
}

/// Some normals point the wrong way, in patches and alone; some points lie anywhere.
OrientedPoints damaged_cloud() {
  OrientedPoints cloud = torus_cloud(3000, 5);
  std::mt19937 random(6);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int i = 0; i < 3000; ++i) {
    if (cloud.points(i, 0) > 1.3 || i % 29 == 0) cloud.normals.row(i) *= -1;
    if (i % 101 == 0)
      for (int d = 0; d < 3; ++d) cloud.points(i, d) = uniform(random);
  }
  return cloud;
}

TEST(ToriFast, SumsAsPlainSumsDo) {
  for (const bool damaged : {false, true}) {
    const OrientedPoints cloud = damaged ? damaged_cloud() : torus_cloud(3000, 1);
    const double rounding = damaged ? 1e-4 : 2e-6;  // more where tori contradict each other
    const ToriDistance full = fitted(cloud), single = fitted(cloud, {}, ToriPrecision::single);
    for (const double reach : {1.5, 1e3})
      for (const Vec3& x : places(3000, 2, reach)) {
        const double plain = full.value_by_plain_sums(x);
        ASSERT_NEAR(full.value(x), plain, 1e-13 * (1 + reach)) << x.transpose();
        ASSERT_NEAR(single.value(x), plain, rounding * (1 + reach)) << x.transpose();
      }
  }
}

TEST(ToriFast, FewPointsAndPlacesOnPoints) {
  for (const int n : {1, 2, 3, 11, 12, 13}) {
    const OrientedPoints cloud = torus_cloud(n, 7);
    const ToriDistance full = fitted(cloud), single = fitted(cloud, {}, ToriPrecision::single);
    for (int i = 0; i < n; ++i) {
      const Vec3 x = cloud.points.row(i);
      EXPECT_NEAR(full.value(x), 0, 0.3);
      EXPECT_NEAR(full.value(x), full.value_by_plain_sums(x), 1e-13);
      EXPECT_NEAR(single.value(x), full.value(x), 1e-6);
      EXPECT_TRUE(full.at(x).gradient.allFinite());
    }
  }
}

TEST(ToriFast, StableFarAwayAndInside) {
  const ToriDistance tori = fitted(torus_cloud(2000, 8));
  for (const double distance : {1e2, 1e4, 1e8, 1e12}) {
    const Vec3 x = distance * Vec3(0.6, 0.48, 0.64);
    EXPECT_NEAR(tori.value(x) / distance, on_torus(x) / distance, 1e-3 / distance + 1e-12);
    const auto [value, gradient] = tori.at(x);
    EXPECT_NEAR(value, tori.value(x), 1e-12 * distance);
    EXPECT_NEAR((gradient - x.normalized()).norm(), 0, 0.05);
  }
  for (const double angle : {0.1, 1.7, 4.0})  // the circle that everything inside is farthest in
    EXPECT_NEAR(tori.value(Vec3(std::cos(angle), std::sin(angle), 0)), -tube, 2e-3);
}

TEST(ToriFast, GradientAndLaplacianAreDerivatives) {
  const ToriDistance tori = fitted(torus_cloud(2000, 9));
  int asked = 0, agree = 0;
  const double step = 1e-7;
  for (const Vec3& x : places(600, 10, 1.5)) {
    if (std::abs(on_torus(x)) > 0.3) continue;
    const Jet jet = tori.jet(x);
    EXPECT_NEAR(jet.value, tori.value(x), 1e-13);
    double laplacian = 0;
    Vec3 gradient;
    for (int d = 0; d < 3; ++d) {
      const Vec3 e = step * Vec3::Unit(d);
      const Jet up = tori.jet(x + e), down = tori.jet(x - e);
      gradient[d] = (up.value - down.value) / (2 * step);
      laplacian += (up.gradient[d] - down.gradient[d]) / (2 * step);
    }
    ++asked;  // all but those next to a place where neighbours change
    agree += (jet.gradient - gradient).norm() < 1e-6 &&
             std::abs(jet.laplacian - laplacian) < 1e-5 * (5 + std::abs(laplacian));
  }
  EXPECT_GT(asked, 100);
  EXPECT_GT(agree, 0.98 * asked);
}

TEST(ToriFast, GradientsByLanesAreThoseOfPlainSums) {
  for (const bool damaged : {false, true}) {
    const OrientedPoints cloud = damaged ? damaged_cloud() : torus_cloud(3000, 1);
    const ToriDistance full = fitted(cloud), single = fitted(cloud, {}, ToriPrecision::single);
    int asked = 0, agree = 0, agree_in_single = 0;
    for (const double reach : {1.5, 1e3})
      for (const Vec3& x : places(2000, 12, reach)) {
        const DistanceSample found = full.at(x), rough = single.at(x);
        const Jet plain = full.jet(x);
        EXPECT_EQ(found.value, full.value(x));
        EXPECT_EQ(rough.value, single.value(x));
        ++asked;  // all but those where the side turns on a last digit, or x is on a torus' axis
        agree += (found.gradient - plain.gradient).norm() < 1e-9 * (1 + plain.gradient.norm());
        agree_in_single += (rough.gradient - plain.gradient).norm() < 1e-2;
      }
    EXPECT_GT(agree, 0.998 * asked);
    EXPECT_GT(agree_in_single, (damaged ? 0.95 : 0.998) * asked);
  }
}

TEST(ToriFast, SlopesOfPatchesAreThoseOfJets) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  int beyond = 0, within = 0;
  for (int round = 0; round < 2000; ++round) {
    Torus torus;  // q, n and e1 are the axes'
    torus.k1 = round % 5 == 0 ? 0 : uniform(random);
    torus.k2 = round % 7 == 0 ? 0 : 2 * uniform(random);
    torus.rho = 0.3;
    const Vec3 x(uniform(random), uniform(random), uniform(random));
    const std::array<Jet, 3> at{Jet::coordinate(x, 0), Jet::coordinate(x, 1),
                                Jet::coordinate(x, 2)};
    const Jet expected = patch_distance<Jet>(torus, at);
    const PatchSlope<double> found =
        patch_slope<double>(torus.k1, torus.k2, torus.rho, x[0], x[1], x[2]);
    EXPECT_NEAR(found.g, expected.value, 1e-14);
    EXPECT_LT((Vec3(found.along, found.across, found.normal) - expected.gradient).norm(),
              1e-10 * (1 + expected.gradient.norm()))
        << torus.k1 << " " << torus.k2 << " at " << x.transpose();
    (std::abs(expected.gradient.norm() - 1) < 1e-12 ? within : beyond) += 1;
  }
  EXPECT_GT(beyond, 100);
  EXPECT_GT(within, 100);
}

TEST(ToriFast, LaplacianOfASphereIsTwiceItsCurvature) {
  Torus sphere;
  sphere.q = Vec3(0, 0, 1);
  sphere.k1 = sphere.k2 = -1;
  sphere.rho = 1e100;
  const Vec3 x(0.3, -0.2, 1.4);
  const std::array<Jet, 3> at{Jet::coordinate(x, 0), Jet::coordinate(x, 1), Jet::coordinate(x, 2)};
  const Jet phi = patch_distance<Jet>(sphere, at);
  EXPECT_NEAR(phi.value, x.norm() - 1, 1e-14);
  EXPECT_NEAR((phi.gradient - x.normalized()).norm(), 0, 1e-14);
  EXPECT_NEAR(phi.laplacian, 2 / x.norm(), 1e-12);
}

TEST(ToriFast, OutliersAreLeftOut) {
  OrientedPoints cloud = torus_cloud(2000, 11);
  const double clean = mean_error(fitted(cloud));
  std::mt19937 random(12);
  std::uniform_real_distribution<double> uniform(-1.5, 1.5);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 200; ++i) {
    for (int d = 0; d < 3; ++d) cloud.points(i, d) = uniform(random);
    for (int d = 0; d < 3; ++d) cloud.normals(i, d) = normal(random);
    cloud.normals.row(i).normalize();
  }
  const double kept = mean_error(fitted(cloud));
  const double dropped = mean_error(fitted(cloud, {}, ToriPrecision::full, ToriOutliers::drop));
  EXPECT_GT(kept, 0.1);
  EXPECT_LT(dropped, 0.01);
  EXPECT_LT(dropped, clean + 0.01);
  Report report;
  const OrientedPoints good = torus_cloud(2000, 13);
  EXPECT_GE(without_outliers(good, {}, report).size(), 1995);
  // Nothing agrees with anything: nothing is left out.
  OrientedPoints chaos = cloud;
  chaos.points = cloud.points.topRows(200).eval();
  chaos.normals = cloud.normals.topRows(200).eval();
  EXPECT_EQ(without_outliers(chaos, {}, report).size(), 200);
  EXPECT_NE(report.warnings.back().text.find("too few points agree"), std::string::npos);
}

TEST(TorusFit, WeightsArePowersOfTheDistance) {
  const OrientedPoints cloud = torus_cloud(300, 21);
  const PointTree tree(cloud.points);
  std::array<Neighbour, 9> near;
  for (int i = 0; i < 20; ++i) {
    ASSERT_EQ(tree.nearest(cloud.points.row(i), 9, near.data()), 9);
    const double scale = std::sqrt(near[8].squared_distance);
    for (const double exponent : {1, 2, 3}) {
      TorusFit fit, beside;
      fit.weight_exponent = exponent;
      beside.weight_exponent = exponent + 1e-9;
      const std::span<const Neighbour> others = std::span(near).subspan(1);
      const HeightPolynomial a = fit_heights(fit, cloud, i, others, scale),
                             b = fit_heights(beside, cloud, i, others, scale);
      EXPECT_NEAR(a.a00 / scale, b.a00 / scale, 1e-7);
      EXPECT_NEAR(a.a20 * scale, b.a20 * scale, 1e-7);
      EXPECT_NEAR(a.normal_residual, b.normal_residual, 1e-7);
    }
  }
}

TEST(LearnedFit, ComesWithTheLibraryAndFitsAsWell) {
  const TorusFit learned = TorusFit::by(LearnedFit::built_in());
  const double closed = mean_error(fitted(torus_cloud(1000, 14)));
  EXPECT_LT(mean_error(fitted(torus_cloud(1000, 14), learned)), 3 * closed + 1e-3);
  // Better than the closed form on a cloud with flipped normals.
  OrientedPoints cloud = torus_cloud(1000, 15);
  for (int i = 0; i < 1000; i += 40) cloud.normals.row(i) *= -1;
  EXPECT_LT(mean_error(fitted(cloud, learned)), 0.7 * mean_error(fitted(cloud)));
  // Fewer points than it looks at: the closed form.
  const OrientedPoints few = torus_cloud(10, 16);
  const ToriDistance a = fitted(few, learned), b = fitted(few);
  for (const Vec3& x : places(20, 17, 1.5)) EXPECT_EQ(a.value(x), b.value(x));
}

TEST(LearnedFit, RotationAndScaleDoNotMatter) {
  const TorusFit learned = TorusFit::by(LearnedFit::built_in());
  const OrientedPoints cloud = torus_cloud(800, 18);
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(1.1, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
  OrientedPoints turned = cloud;
  turned.points = 1e3 * cloud.points * turn.transpose();
  turned.normals = cloud.normals * turn.transpose();
  const ToriDistance a = fitted(cloud, learned), b = fitted(turned, learned);
  for (const Vec3& x : places(100, 19, 1.5))
    EXPECT_NEAR(b.value(1e3 * turn * x) / 1e3, a.value(x), 1e-5);
}

std::string message_for(const std::string& weights) {
  try {
    LearnedFit::parse(weights, "w.txt");
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(LearnedFit, BadWeightsAreNamed) {
  EXPECT_NE(message_for("").find("w.txt: not the weights"), std::string::npos);
  EXPECT_NE(message_for("littoral-torus-fit 2\n").find("does not begin"), std::string::npos);
  EXPECT_NE(message_for("littoral-torus-fit 1\n24 9\n").find("not 24 x 8"), std::string::npos);
  EXPECT_NE(message_for("littoral-torus-fit 1\n24 8\n0 0").find("ends early"), std::string::npos);
  for (const char* bad : {"nan", "inf", "1e9", "one", "1e-999x"})
    EXPECT_NE(message_for("littoral-torus-fit 1\n24 8\n0 " + std::string(bad)).find("no number"),
              std::string::npos);
  std::string zeros = "littoral-torus-fit 1\n# nothing learned\n";
  for (const auto& [rows, columns] : {std::pair{24, 8}, {24, 48}, {24, 48}, {2, 24}, {2, 24}}) {
    zeros += std::to_string(rows) + " " + std::to_string(columns) + "\n";
    for (int i = 0; i < rows * (columns + 1); ++i) zeros += "0 ";
  }
  EXPECT_EQ(message_for(zeros), "no error");
  EXPECT_NE(message_for(zeros + "0").find("more follows"), std::string::npos);
}

TEST(ToriBadInput, NormalsOfAnyLength) {
  OrientedPoints cloud = torus_cloud(500, 20);
  const ToriDistance expected = fitted(cloud);
  for (int i = 0; i < 500; ++i) cloud.normals.row(i) *= i % 2 ? 1e-200 : 1e200;
  const ToriDistance tori = fitted(cloud);
  for (const Vec3& x : places(100, 21, 1.5)) EXPECT_NEAR(tori.value(x), expected.value(x), 1e-9);
}

TEST(ToriBadInput, NormalsThatAreNotNumbers) {
  OrientedPoints cloud = torus_cloud(50, 22);
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    OrientedPoints broken = cloud;
    broken.normals(9, 2) = bad;
    EXPECT_THROW(fitted(broken), InputError);
  }
}

TEST(ToriBadInput, CollinearPointsWithNormalsAllAround) {
  OrientedPoints line;
  line.points.resize(60, 3);
  line.normals.resize(60, 3);
  for (int i = 0; i < 60; ++i) {
    line.points.row(i) << 0.1 * i, 0, 0;
    line.normals.row(i) << 0, std::cos(2.4 * i), std::sin(2.4 * i);
  }
  for (const auto& fit :
       {TorusFit::exact(), TorusFit::noisy(), TorusFit::by(LearnedFit::built_in())}) {
    const ToriDistance tori = fitted(line, fit);
    for (const Vec3& x : places(200, 23, 3)) {
      const auto [value, gradient] = tori.at(x);
      EXPECT_TRUE(std::isfinite(value) && gradient.allFinite());
      EXPECT_LE(std::abs(value), 20.0);
    }
  }
}

TEST(ToriBadInput, AMillionCoincidentPoints) {
  OrientedPoints many;
  many.points = MatX3::Constant(1000000, 3, 2.0);
  many.normals = MatX3::Zero(1000000, 3);
  many.normals.col(1).setOnes();
  many.points.row(17) << 2, 2, 3;  // and another one
  Report report;
  const ToriDistance tori(many, {}, {}, report);
  EXPECT_EQ(tori.size(), 2);
  EXPECT_NE(report.warnings.at(0).text.find("999998 points coincide"), std::string::npos);
  EXPECT_NEAR(tori.value(Vec3(2, 2.25, 2)), 0.25, 1e-12);
  many.points.row(17) << 2, 2, 2;  // normals that cancel all over
  many.normals.topRows(500000) *= -1;
  EXPECT_THROW(ToriDistance(many, {}, {}, report), InputError);
}

}  // namespace
}  // namespace littoral
