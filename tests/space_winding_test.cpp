// The hierarchical winding number against exact solid angles.

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <limits>
#include <random>

#include "api/space/sdf.h"
#include "littoral/error.h"
#include "space_helpers.h"
#include "spatial/dipole_moments.h"
#include "spatial/triangulate.h"
#include "spatial/winding_number.h"
#include "test_meshes.h"

namespace littoral {
namespace {

TEST(WindingNumber, ExactSumsAgreeWithBruteForceAlsoOnBrokenSurfaces) {
  PolygonSoup soup = test::octasphere_soup(3);
  soup.face_offsets.resize(soup.face_offsets.size() - 100);  // a hole
  soup.corners.resize(soup.corners.size() - 300);
  std::swap(soup.corners[0], soup.corners[1]);  // a flipped face
  const MatX3i faces = triangles_of(soup);
  const WindingNumber winding(soup.points, faces);
  const MatX3 queries = test::random_points(200, 1.3);
  for (Eigen::Index i = 0; i < queries.rows(); ++i) {
    const Vec3 q = queries.row(i);
    EXPECT_NEAR(winding(q, std::numeric_limits<double>::infinity()),
                winding_number_brute_force(soup.points, faces, q), 1e-12);
  }
}

TEST(WindingNumber, ExpansionStaysWithinItsAccuracy) {
  const PolygonSoup soup = test::torus_soup(60, 40);
  MatX3i faces = triangles_of(soup);
  for (Eigen::Index f = 0; f < faces.rows(); f += 7) std::swap(faces(f, 0), faces(f, 1));
  const WindingNumber winding(soup.points, faces);
  EXPECT_FALSE(winding.exact());
  const MatX3 queries = test::random_points(150, 1.6);
  double worst = 0, sum = 0, worst_sign = 0;
  for (Eigen::Index i = 0; i < queries.rows(); ++i) {
    const Vec3 q = queries.row(i);
    const double exact = winding_number_brute_force(soup.points, faces, q);
    const double error = std::abs(winding(q) - exact);
    worst = std::max(worst, error);
    sum += error;
    worst_sign = std::max(worst_sign, std::abs(winding(q, WindingNumber::sign_accuracy) - exact));
  }
  EXPECT_LT(worst, 1e-3);
  EXPECT_LT(sum / 150, 1e-4);
  EXPECT_LT(worst_sign, 3e-3);
}

/// What DipoleMoments::coefficients say of the field, by the formula at their declaration.
double expanded(const DipoleMoments& moments, const Vec3& r, double unit) {
  static_assert(dipole_degree == 4);
  const auto M = moments.coefficients(unit);
  const Vec3 u = r.normalized();
  const double t = unit / r.norm(), z = u[2], zz = z * z;
  const std::complex<double> along(u[0], u[1]);
  const double q[4][5] = {{z, 1, 0, 0, 0},
                          {zz - 1. / 3, z, 1, 0, 0},
                          {z * (zz - 3. / 5), zz - 1. / 5, z, 1, 0},
                          {zz * (zz - 6. / 7) + 3. / 35, z * (zz - 3. / 7), zz - 1. / 7, z, 1}};
  double sum = 0;
  std::size_t at = 0;
  for (int l = 1; l <= dipole_degree; ++l)
    for (int m = 0; m <= l; ++m) {
      const auto power = std::pow(along, m);
      double term = M[at++] * power.real();
      if (m > 0) term += M[at++] * power.imag();
      sum += std::pow(t, l - 1) * q[l - 1][m] * term;
    }
  return sum / r.squaredNorm();
}

TEST(DipoleMoments, LeaveAnErrorOfTheFourthOrder) {
  const Vec3 r(0.7, -1.1, 0.9), d(0.11, 0.23, -0.17), a(0.3, -0.5, 0.8);
  double before = 0;
  for (const double scale : {1.0, 0.5, 0.25, 0.125}) {
    DipoleMoments moments;
    moments.add(scale * d, a);
    const Vec3 x = r + scale * d;
    const double error = std::abs(expanded(moments, r, 0.3) - a.dot(x) / std::pow(x.norm(), 3));
    if (scale < 0.5) {
      EXPECT_NEAR(before / error, 16, 3) << scale;
    }
    before = error;
  }
}

TEST(DipoleMoments, AboutAnotherCentreAreThoseTakenThere) {
  const MatX3 at = test::random_points(7, 1), areas = test::random_points(14, 1).bottomRows(7);
  const Vec3 shift(0.4, -0.3, 0.2);
  DipoleMoments here, there, moved;
  for (Eigen::Index i = 0; i < at.rows(); ++i) {
    here.add(at.row(i), areas.row(i));
    there.add(Vec3(at.row(i)) + shift, areas.row(i));
  }
  moved.add(here, shift);
  const auto expected = there.coefficients(0.5), found = moved.coefficients(0.5);
  for (std::size_t k = 0; k < expected.size(); ++k)
    EXPECT_NEAR(found[k], expected[k], 1e-10 * (1 + std::abs(expected[k]))) << k;
}

TEST(DipoleMoments, OfATinyClusterAreFinite) {
  DipoleMoments moments;
  moments.add(Vec3(1e-120, 0, 1e-130), Vec3(0, 1e-200, 0));
  for (double c : moments.coefficients(1e-120)) EXPECT_TRUE(std::isfinite(c));
  for (double c : moments.coefficients(0)) EXPECT_TRUE(std::isfinite(c));
}

TEST(WindingNumber, SmoothedIsTheConvolutionWithAGaussian) {
  // Of a ball, in closed form: the share of a normal variable about the point that falls into it.
  const double sigma = 0.15, root = sigma * std::sqrt(2.0), pi = std::acos(-1.0);
  const PolygonSoup ball = test::octasphere_soup(5);
  std::vector<double> radii;
  MatX3 queries(26, 3);
  for (int i = 0; i < 26; ++i) {
    const double r = 0.06 * (i + 0.5), a = 0.4 * i;
    radii.push_back(r);
    queries.row(i) << r * std::cos(a) * 0.6, r * std::sin(a) * 0.6, r * 0.8;
  }
  Report report;
  const VecX smooth = query_winding(ball, queries, {}, {}, report, sigma);
  for (int i = 0; i < 26; ++i) {
    const double r = radii[i], out = (r - 1) / root, in = (r + 1) / root;
    const double exact =
        0.5 * (std::erf(in) - std::erf(out)) -
        sigma / (r * std::sqrt(2 * pi)) * (std::exp(-out * out) - std::exp(-in * in));
    EXPECT_NEAR(smooth[i], exact, 3e-3) << r;
  }
  // Five deviations away nothing has changed, and at a vertex it is finite.
  const VecX sharp = query_winding(ball, queries.topRows(3), {}, {}, report);
  EXPECT_LT((smooth.head(3) - sharp).cwiseAbs().maxCoeff(), 3e-3);
  EXPECT_NEAR(query_winding(ball, ball.points.topRows(1), {}, {}, report, sigma)[0], 0.44, 0.02);
  EXPECT_THROW(query_winding(ball, queries, {}, {}, report, 1e-9), InputError);
}

TEST(WindingNumber, CountsNestedAndFarSurfaces) {
  PolygonSoup soup = test::octasphere_soup(2);
  PolygonSoup inner = soup;
  inner.points *= 0.5;
  const WindingNumber once(soup.points, triangles_of(soup));
  EXPECT_NEAR(once(Vec3(1e3, 0, 0)), 0, 1e-9);
  EXPECT_NEAR(once(Vec3(0.1, 0.2, 0.3)), 1, 1e-9);
  for (int v : inner.corners) soup.corners.push_back(v + inner.n_vertices());
  for (int f = 0; f < inner.n_faces(); ++f)
    soup.face_offsets.push_back(soup.face_offsets.back() + 3);
  MatX3 both(2 * inner.n_vertices(), 3);
  both << soup.points, inner.points;
  EXPECT_NEAR(WindingNumber(both, triangles_of(soup))(Vec3(0.1, 0, 0)), 2, 1e-9);
}

TEST(WindingNumber, OfACloudIsThatOfItsSurfaceAwayFromIt) {
  const OrientedPoints sphere = test::sphere_samples(4);
  const WindingNumber winding(sphere.points, sphere.normals, sphere.areas);
  for (const double r : {0.0, 0.5, 0.8}) EXPECT_NEAR(winding(Vec3(0, r, 0)), 1, 0.02);
  for (const double r : {1.2, 2.0, 50.0}) EXPECT_NEAR(winding(Vec3(0, r, 0)), 0, 0.02);
  EXPECT_TRUE(std::isfinite(winding(sphere.points.row(0))));
}

TEST(WindingNumber, IgnoresFacesThatAreNotFinite) {
  PolygonSoup soup = test::octasphere_soup(1);
  const double before = WindingNumber(soup.points, triangles_of(soup))(Vec3(0.1, 0, 0));
  soup.points.conservativeResize(19, 3);
  soup.points.row(18).setConstant(std::nan(""));
  test::add_triangle(soup, 0, 1, 18);
  EXPECT_EQ(WindingNumber(soup.points, triangles_of(soup))(Vec3(0.1, 0, 0)), before);
}

}  // namespace
}  // namespace littoral
