// Points as tori: the torus itself, fits on surfaces they can represent, and the blended field.

#include "methods/tori/tori.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "api/space/tori_cloud.h"
#include "base/parallel.h"
#include "constants.h"
#include "littoral/error.h"
#include "torus_helpers.h"

namespace littoral {
namespace {

using test::pi;

/// Distance to a torus around the z axis, outside positive (eq. 5.3).
double torus_exact(const Vec3& x, double R, double r) {
  return std::hypot(std::hypot(x[0], x[1]) - R, x[2]) - r;
}

std::vector<Vec3> queries(int n, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1.5, 1.5);
  std::vector<Vec3> out;
  for (int i = 0; i < n; ++i) out.emplace_back(uniform(random), uniform(random), uniform(random));
  return out;
}

/// n points spread evenly over the unit sphere (a Fibonacci spiral).
MatX3 sphere_points(int n) {
  MatX3 points(n, 3);
  for (int i = 0; i < n; ++i) {
    const double z = 1 - (2 * i + 1.0) / n, r = std::sqrt(1 - z * z);
    const double a = pi * (3 - std::sqrt(5.0)) * i;
    points.row(i) << r * std::cos(a), r * std::sin(a), z;
  }
  return points;
}

ToriDistance tori_fitted(const OrientedPoints& cloud, const TorusFit& fit = {}) {
  Report report;
  return ToriDistance(cloud, fit, {}, report);
}

TEST(Torus, IsTheTorusOfItsCurvatures) {
  // Touching at (R + r, 0, 0) from outside: bends away from the normal along both circles.
  const double R = 0.8, r = 0.3;
  Torus torus;
  torus.q = Vec3(R + r, 0, 0);
  torus.n = Vec3::UnitX();
  torus.e1 = Vec3::UnitY();
  torus.k1 = -1 / (R + r);
  torus.k2 = -1 / r;
  torus.rho = 1e300;
  // Curvature k1 is that of the outer equator, of radius R + r; the tube around it is drawn
  // inwards, so that its centre line has radius R.
  for (const Vec3& x : queries(200, 1))
    EXPECT_NEAR(patch_distance<double>(torus, x), torus_exact(x, R, r), 1e-12);
}

TEST(Torus, PlanesCylindersAndSpheresAreOrdinary) {
  Torus torus;  // the plane z = 0
  torus.rho = 1e300;
  for (const Vec3& x : queries(50, 2)) EXPECT_EQ(patch_distance<double>(torus, x), x[2]);
  torus.k2 = -2;  // a cylinder of radius 1/2 around the line (t, 0, -1/2)
  for (const Vec3& x : queries(50, 3))
    EXPECT_NEAR(patch_distance<double>(torus, x), std::hypot(x[1], x[2] + 0.5) - 0.5, 1e-12);
  torus.k1 = -2;  // a sphere
  for (const Vec3& x : queries(50, 4))
    EXPECT_NEAR(patch_distance<double>(torus, x), (x + Vec3(0, 0, 0.5)).norm() - 0.5, 1e-12);
  torus.k1 = torus.k2 = 2;  // the same seen from inside: positive inside
  for (const Vec3& x : queries(50, 5))
    EXPECT_NEAR(patch_distance<double>(torus, x), 0.5 - (x - Vec3(0, 0, 0.5)).norm(), 1e-12);
}

TEST(Tori, FitIsExactOnPlanes) {
  OrientedPoints cloud;
  std::mt19937 random(9);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const Vec3 n = Vec3(1, 2, -0.5).normalized();
  Vec3 s, t;
  tangent_frame(n, s, t);
  cloud.points.resize(400, 3);
  cloud.normals.resize(400, 3);
  for (int i = 0; i < 400; ++i) {
    const double a = uniform(random), b = uniform(random);  // in this order, whatever the compiler
    cloud.points.row(i) = a * s + b * t + 0.25 * n;
    cloud.normals.row(i) = n;
  }
  const ToriDistance tori = tori_fitted(cloud);
  for (double height : {-0.4, 0.0, 0.02, 0.3}) {
    const Vec3 x = 0.1 * s - 0.2 * t + (0.25 + height) * n;
    const auto [phi, gradient] = tori.at(x);
    // Far from a patch its rim enters; near the plane nothing but the plane is seen.
    if (std::abs(height) < 0.05) {
      EXPECT_NEAR(phi, height, 1e-4);  // a thousandth of the spacing
      EXPECT_NEAR((gradient - n).norm(), 0, 1e-2);
    }
    EXPECT_NEAR(phi, height, 0.05 * std::abs(height) + 1e-4);
  }
}

TEST(Tori, FitIsExactOnSpheres) {
  OrientedPoints cloud;
  cloud.points = sphere_points(300);
  cloud.normals = cloud.points;
  const ToriDistance tori = tori_fitted(cloud);
  for (const Torus& torus : tori.tori()) {
    EXPECT_NEAR(torus.k1, -1, 2e-3);  // the ridge pulls curvatures a little towards 0
    EXPECT_NEAR(torus.k2, -1, 2e-3);
  }
  for (const Vec3& x : queries(200, 6))
    EXPECT_NEAR(tori.value(x), x.norm() - 1, 2e-3) << x.transpose();
}

/// Mean error over queries near a torus of radii 1 and 0.4, sampled by n points at random.
double mean_error_on_torus(int n) {
  std::mt19937 random(11);
  const ToriDistance tori = tori_fitted(test::torus_cloud(n, random));
  double error = 0;
  const auto at = queries(2000, 12);
  for (const Vec3& x : at) error += std::abs(tori.value(x) - torus_exact(x, 1, test::tube));
  return error / static_cast<double>(at.size());
}

TEST(Tori, ErrorFallsAtLeastLinearlyWithTheSpacing) {
  const double coarse = mean_error_on_torus(500), fine = mean_error_on_torus(2000);
  EXPECT_LT(coarse, 0.01);
  EXPECT_LT(fine, coarse / 2);  // spacing halves
}

TEST(Tori, GradientIsTheDerivative) {
  OrientedPoints cloud;
  cloud.points = sphere_points(200);
  cloud.normals = cloud.points;
  for (int i = 0; i < 200; ++i) cloud.points.row(i) *= 1 + 0.2 * cloud.points(i, 0);
  const ToriDistance tori = tori_fitted(cloud);
  int compared = 0;
  for (const Vec3& x : queries(100, 13)) {
    const auto [value, gradient] = tori.at(x);
    EXPECT_NEAR(value, tori.value(x), 1e-14);
    const double step = 1e-6;
    Vec3 difference, second;
    for (int d = 0; d < 3; ++d) {
      const Vec3 e = step * Vec3::Unit(d);
      difference[d] = (tori.value(x + e) - tori.value(x - e)) / (2 * step);
      second[d] = tori.value(x + e) + tori.value(x - e) - 2 * tori.value(x);
    }
    if (second.cwiseAbs().maxCoeff() > 1e-9) continue;  // a kink within the step
    EXPECT_NEAR((gradient - difference).norm(), 0, 1e-4);
    ++compared;
  }
  EXPECT_GT(compared, 80);
}

TEST(Tori, SidesAreRightFarBehindAcuteEdges) {
  // A wedge of 20 degrees: two slanted faces, a back, and two triangles as sides.
  const double a = std::tan(pi / 18), depth = 1;
  std::vector<Vec3> points, normals;
  const auto cover = [&](const Vec3& from, const Vec3& u, const Vec3& v, const Vec3& n, auto keep) {
    const int nu = static_cast<int>(u.norm() / 0.04), nv = static_cast<int>(v.norm() / 0.04);
    for (int i = 0; i < nu; ++i)
      for (int j = 0; j < nv; ++j) {
        const Vec3 p = from + (i + 0.5) / nu * u + (j + 0.5) / nv * v;
        if (!keep(p)) continue;
        points.push_back(p);
        normals.push_back(n.normalized());
      }
  };
  const auto all = [](const Vec3&) { return true; };
  const auto inside = [&](const Vec3& p) { return std::abs(p[1]) < a * p[0]; };
  cover(Vec3::Zero(), Vec3(1, a, 0), Vec3(0, 0, depth), Vec3(-a, 1, 0), all);
  cover(Vec3::Zero(), Vec3(1, -a, 0), Vec3(0, 0, depth), Vec3(-a, -1, 0), all);
  cover(Vec3(1, -a, 0), Vec3(0, 2 * a, 0), Vec3(0, 0, depth), Vec3::UnitX(), all);
  for (const double z : {0.0, depth})
    cover(Vec3(0, -a, z), Vec3(1, 0, 0), Vec3(0, 2 * a, 0), Vec3(0, 0, z > 0 ? 1 : -1), inside);
  OrientedPoints wedge;
  wedge.points.resize(static_cast<Eigen::Index>(points.size()), 3);
  wedge.normals.resize(wedge.points.rows(), 3);
  for (std::size_t i = 0; i < points.size(); ++i) {
    wedge.points.row(static_cast<Eigen::Index>(i)) = points[i];
    wedge.normals.row(static_cast<Eigen::Index>(i)) = normals[i];
  }
  const ToriDistance tori = tori_fitted(wedge);
  int wrong = 0, far = 0;
  for (const Vec3& q : queries(4000, 17)) {
    const Vec3 x = q + Vec3(0, 0, 0.5);
    const Vec3 outside(std::max({a * -x[0], x[0] - 1, 0.0}), std::abs(x[1]) - a * x[0],
                       std::max({-x[2], x[2] - depth, 0.0}));
    if (outside.maxCoeff() < 0.2) continue;  // near the surface, or inside
    ++far;
    wrong += tori.value(x) <= 0;
  }
  EXPECT_GT(far, 2000);
  EXPECT_EQ(wrong, 0);
}

TEST(Tori, FlippedPatchesDoNotReachFar) {
  OrientedPoints cloud;
  cloud.points = sphere_points(2000);
  cloud.normals = cloud.points;
  int flipped = 0;
  for (int i = 0; i < 2000; ++i)
    if (cloud.points(i, 0) > std::cos(0.25)) {
      cloud.normals.row(i) *= -1;
      ++flipped;
    }
  ASSERT_GT(flipped, 20);  // more than have a say at a place
  const ToriDistance tori = tori_fitted(cloud);
  for (const double x : {1.4, 2.0, 5.0}) EXPECT_NEAR(tori.value(Vec3(x, 0, 0)), x - 1, 0.02);
  for (const double x : {0.6, 0.2}) EXPECT_NEAR(tori.value(Vec3(x, 0, 0)), x - 1, 0.02);
}

TEST(Tori, AnyNumberOfThreadsGivesTheSameBits) {
  OrientedPoints cloud;
  cloud.points = sphere_points(1000);
  cloud.normals = cloud.points;
  MatX3 at(3000, 3);
  const auto q = queries(3000, 14);
  for (int i = 0; i < 3000; ++i) at.row(i) = q[i];
  set_thread_count(1);
  const VecX one = evaluate(tori_fitted(cloud), at, nullptr, {});
  set_thread_count(3);
  const VecX three = evaluate(tori_fitted(cloud), at, nullptr, {});
  set_thread_count(0);
  EXPECT_TRUE((one.array() == three.array()).all());
}

TEST(Tori, ScaleAndMotionDoNotMatter) {
  OrientedPoints cloud;
  cloud.points = sphere_points(300);
  cloud.normals = cloud.points;
  const ToriDistance tori = tori_fitted(cloud);
  for (double scale : {1e-3, 1e3}) {
    OrientedPoints other = cloud;
    other.points *= scale;
    const ToriDistance scaled = tori_fitted(other);
    for (const Vec3& x : queries(50, 15))
      EXPECT_NEAR(scaled.value(scale * x) / scale, tori.value(x), 1e-9);
  }
  OrientedPoints flipped = cloud;
  flipped.normals *= -1;
  const ToriDistance inward = tori_fitted(flipped);
  for (const Vec3& x : queries(50, 16)) EXPECT_NEAR(inward.value(x), -tori.value(x), 1e-9);
}

TEST(Tori, CloudsOfToriGiveThemBack) {
  OrientedPoints cloud;
  cloud.points = sphere_points(300);
  cloud.normals = cloud.points;
  const ToriDistance tori = tori_fitted(cloud);
  PolygonSoup file = cloud_of_tori(tori.points(), tori.tori());
  ASSERT_TRUE(has_tori(file));
  const ToriDistance again(file.points, tori_of_cloud(file));
  for (const Vec3& x : queries(50, 18)) EXPECT_NEAR(again.value(x), tori.value(x), 1e-12);
  file.scalars.at("torus_rho")[4] = 0;
  EXPECT_THROW(tori_of_cloud(file), InputError);
  file.scalars.erase("torus_rho");
  EXPECT_FALSE(has_tori(file));
}

TEST(Tori, FewDegenerateAndCoincidentPoints) {
  OrientedPoints one;
  one.points.resize(1, 3);
  one.points << 1, 2, 3;
  one.normals.resize(1, 3);
  one.normals << 0, 0, 5;  // of any length
  EXPECT_NEAR(tori_fitted(one).value(Vec3(1.2, 2, 3.5)), 0.5, 1e-12);

  OrientedPoints line;  // collinear points with one normal lie on a plane
  line.points.resize(20, 3);
  line.normals.resize(20, 3);
  for (int i = 0; i < 20; ++i) {
    line.points.row(i) << 0.1 * i, 0, 0;
    line.normals.row(i) << 0, 0, 1;
  }
  EXPECT_NEAR(tori_fitted(line).value(Vec3(0.93, 0.01, 0.05)), 0.05, 1e-6);

  OrientedPoints many;
  many.points = MatX3::Constant(10000, 3, 2.0);
  many.normals = MatX3::Zero(10000, 3);
  many.normals.col(1).setOnes();
  Report report;
  const ToriDistance tori(many, {}, {}, report);
  EXPECT_EQ(tori.size(), 1);
  ASSERT_EQ(report.warnings.size(), 1u);
  EXPECT_NE(report.warnings[0].text.find("9999 points coincide"), std::string::npos);
  EXPECT_NEAR(tori.value(Vec3(2, 2.25, 2)), 0.25, 1e-12);
}

std::string message_for(const OrientedPoints& cloud) {
  try {
    tori_fitted(cloud);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Tori, BadCloudsAreNamed) {
  OrientedPoints cloud;
  EXPECT_NE(message_for(cloud).find("empty"), std::string::npos);
  cloud.points = sphere_points(20);
  EXPECT_NE(message_for(cloud).find("20 points but 0 normals"), std::string::npos);
  cloud.normals = cloud.points;
  cloud.normals.row(7).setZero();
  EXPECT_NE(message_for(cloud).find("point 7 has no normal"), std::string::npos);
  cloud.normals = cloud.points;
  cloud.points(3, 1) = std::nan("");
  EXPECT_NE(message_for(cloud).find("point 3"), std::string::npos);
}

}  // namespace
}  // namespace littoral
