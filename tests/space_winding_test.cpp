// The hierarchical winding number against exact solid angles.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "api/space/sdf.h"
#include "littoral/error.h"
#include "space_helpers.h"
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
  double worst = 0;
  for (Eigen::Index i = 0; i < queries.rows(); ++i) {
    const Vec3 q = queries.row(i);
    worst =
        std::max(worst, std::abs(winding(q) - winding_number_brute_force(soup.points, faces, q)));
  }
  EXPECT_LT(worst, 1e-3);
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
