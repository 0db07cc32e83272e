// The hierarchical winding number against exact solid angles.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <random>
#include <vector>

#include "api/space/sdf.h"
#include "base/parallel.h"
#include "littoral/error.h"
#include "space_helpers.h"
#include "spatial/dipole_moments.h"
#include "spatial/triangulate.h"
#include "spatial/winding_kernels.h"
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

MatX3i one_in_seven_reversed(const PolygonSoup& soup) {
  MatX3i faces = triangles_of(soup);
  for (Eigen::Index f = 0; f < faces.rows(); f += 7) std::swap(faces(f, 0), faces(f, 1));
  return faces;
}

TEST(WindingNumber, ExpansionStaysWithinItsAccuracy) {
  const PolygonSoup soup = test::torus_soup(60, 40);
  const MatX3i faces = one_in_seven_reversed(soup);
  const WindingNumber winding(soup.points, faces);
  EXPECT_FALSE(winding.exact());
  const MatX3 queries = test::random_points(150, 1.6);
  double worst = 0, sum = 0, worst_sign = 0;
  for (Eigen::Index i = 0; i < queries.rows(); ++i) {
    const Vec3 q = queries.row(i);
    const double exact = winding_number_brute_force(soup.points, faces, q);
    EXPECT_NEAR(winding(q, std::numeric_limits<double>::infinity()), exact, 1e-12);
    const double error = std::abs(winding(q) - exact);
    worst = std::max(worst, error);
    sum += error;
    worst_sign = std::max(worst_sign, std::abs(winding(q, WindingNumber::sign_accuracy) - exact));
  }
  EXPECT_LT(worst, 2e-4);
  EXPECT_LT(sum / 150, 3e-5);
  EXPECT_LT(worst_sign, 3e-3);
}

/// What DipoleMoments::coefficients say of the field, by the formula at their declaration.
double expanded(const DipoleMoments& moments, const Vec3& r, double unit) {
  static_assert(dipole_degree == 5);
  const auto M = moments.coefficients(unit);
  const Vec3 u = r.normalized();
  const double t = unit / r.norm(), z = u[2], zz = z * z;
  const std::complex<double> along(u[0], u[1]);
  const double q[5][6] = {{z, 1, 0, 0, 0, 0},
                          {zz - 1. / 3, z, 1, 0, 0, 0},
                          {z * (zz - 3. / 5), zz - 1. / 5, z, 1, 0, 0},
                          {zz * (zz - 6. / 7) + 3. / 35, z * (zz - 3. / 7), zz - 1. / 7, z, 1, 0},
                          {z * (zz * (zz - 10. / 9) + 5. / 21), zz * (zz - 2. / 3) + 1. / 21,
                           z * (zz - 1. / 3), zz - 1. / 9, z, 1}};
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

TEST(DipoleMoments, LeaveAnErrorOfTheFifthOrder) {
  const Vec3 r(0.7, -1.1, 0.9), d(0.11, 0.23, -0.17), a(0.3, -0.5, 0.8);
  double before = 0;
  for (const double scale : {1.0, 0.5, 0.25, 0.125}) {
    DipoleMoments moments;
    moments.add(scale * d, a);
    const Vec3 x = r + scale * d;
    const double error = std::abs(expanded(moments, r, 0.3) - a.dot(x) / std::pow(x.norm(), 3));
    if (scale < 0.5) {
      EXPECT_NEAR(before / error, 32, 6) << scale;
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

TEST(WindingKernels, EightExpansionsAreThoseOneAfterTheOther) {
  const MatX3 at = test::random_points(24, 0.2), areas = test::random_points(48, 1).bottomRows(24);
  ClusterLanes lanes{};
  std::vector<DipoleMoments> moments(winding_lanes);
  for (int l = 0; l < winding_lanes; ++l) {
    for (int i = 3 * l; i < 3 * l + 3; ++i) moments[l].add(at.row(i), areas.row(i));
    lanes.x[l] = 0.5f * static_cast<float>(l), lanes.y[l] = 1.25f, lanes.z[l] = -0.75f;
    lanes.radius[l] = 0.25f;
    const auto M = moments[l].coefficients(0.25);
    for (std::size_t k = 0; k < M.size(); ++k)
      lanes.moments[k][l] = static_cast<float>(M[k] / 0.25);
  }
  const MatX3 queries = test::random_points(40, 2);
  int n_near = 0;
  for (Eigen::Index i = 0; i < queries.rows(); ++i) {
    const Eigen::Vector3f q = queries.row(i).transpose().cast<float>();
    unsigned near = 0;
    const float found = winding_kernels().far(lanes, q.data(), 1 / (2.6f * 2.6f), near);
    double sum = 0, size = 0;
    for (int l = 0; l < winding_lanes; ++l) {
      const Vec3 r = Vec3(lanes.x[l], lanes.y[l], lanes.z[l]) - q.cast<double>();
      const bool is_near = r.norm() < 2.6 * 0.25;
      EXPECT_EQ((near >> l) & 1u, is_near ? 1u : 0u);
      n_near += is_near ? 1 : 0;
      const double term = is_near ? 0 : expanded(moments[l], r, 0.25);
      sum += term, size += std::abs(term);
    }
    EXPECT_NEAR(found, sum, 2e-6 * size);
  }
  EXPECT_GT(n_near, 0);
}

/// Eight triangles in both forms; the first is large.
struct BothLanes {
  TriangleLanes wide;
  NarrowTriangleLanes narrow;
  BothLanes() {
    const MatX3 at = test::random_points(8, 0.5), sides = test::random_points(24, 0.15);
    narrow.centre = {0.01, -0.02, 0.03};
    double squared = 0;
    for (int l = 0; l < winding_lanes; ++l)
      for (int c = 0; c < 9; ++c) {
        const double x = at(l, c % 3) + (l == 0 ? 3 : 1) * sides(3 * l + c / 3, c % 3);
        wide.corner[c][l] = x;
        narrow.corner[c][l] = static_cast<float>(x - narrow.centre[c % 3]);
      }
    for (int l = 0; l < winding_lanes; ++l)
      for (int k = 0; k < 3; ++k)
        squared = std::max(
            squared, (corner(l, k) - Eigen::Map<const Vec3>(narrow.centre.data())).squaredNorm());
    narrow.radius = static_cast<float>(std::sqrt(squared));
  }
  Vec3 corner(int l, int k) const {
    return {wide.corner[3 * k][l], wide.corner[3 * k + 1][l], wide.corner[3 * k + 2][l]};
  }
  double angles(const Vec3& q) const {
    AngleLanes out;
    winding_kernels().angles(wide, q.data(), out);
    double sum = 0;
    for (int l = 0; l < winding_lanes; ++l) sum += std::atan2(out.num[l], out.den[l]);
    return sum;
  }
};

TEST(WindingKernels, NarrowAnglesAreThoseInDoublePrecisionOrSaySo) {
  const BothLanes lanes;
  int sure = 0, tried = 0;
  const MatX3 away = test::random_points(2000, 1);
  for (Eigen::Index i = 0; i < away.rows(); ++i)
    for (const double scale : {1.5, 0.3, 0.01, 1e-4, 1e-7}) {
      // About a point of one of the triangles: within it, on a side or at a corner.
      const int l = static_cast<int>(i) % winding_lanes;
      const double u = i % 3 == 0 ? 0 : 0.3, v = i % 5 == 0 ? 0 : 0.5;
      const Vec3 q = lanes.corner(l, 0) + u * (lanes.corner(l, 1) - lanes.corner(l, 0)) +
                     v * (lanes.corner(l, 2) - lanes.corner(l, 0)) + scale * Vec3(away.row(i));
      float sum = 0;
      ++tried;
      if (!winding_kernels().narrow_angles(lanes.narrow, q.data(), sum)) {
        EXPECT_LT(scale, 1) << "far away it knows";
        continue;
      }
      ++sure;
      EXPECT_GT(scale, 1e-5) << "so near it cannot";
      EXPECT_NEAR(sum, lanes.angles(q), 5e-5) << scale;
    }
  EXPECT_GT(sure, tried / 3);
  float sum = 0;
  EXPECT_FALSE(winding_kernels().narrow_angles(lanes.narrow, lanes.corner(2, 1).data(), sum));
}

TEST(WindingKernels, FieldsAtEightPointsAreThoseAtOneAfterTheOther) {
  GroupCluster cluster{0.3f, -0.2f, 0.1f, 0.25f, -1, {}};
  ClusterLanes lanes{};
  lanes.x[0] = cluster.x, lanes.y[0] = cluster.y, lanes.z[0] = cluster.z;
  lanes.radius[0] = cluster.radius;
  for (int l = 1; l < winding_lanes; ++l) lanes.x[l] = 1e9f;
  const MatX3 numbers = test::random_points(12, 1);
  for (int k = 0; k < dipole_coefficients; ++k)
    lanes.moments[k][0] = cluster.moments[k] = static_cast<float>(numbers(k / 3, k % 3));
  MatX3 at = test::random_points(winding_lanes, 1);  // directions
  PointLanes everywhere{}, some{};
  for (int l = 0; l < winding_lanes; ++l) {
    at.row(l) = (0.4 + 0.1 * l) * at.row(l).normalized() +
                Eigen::RowVector3d(cluster.x, cluster.y, cluster.z);
    everywhere.x[l] = some.x[l] = static_cast<float>(at(l, 0));
    everywhere.y[l] = some.y[l] = static_cast<float>(at(l, 1));
    everywhere.z[l] = some.z[l] = static_cast<float>(at(l, 2));
    everywhere.sum[l] = some.sum[l] = 0.5f;
  }
  const float share = 1 / (2.6f * 2.6f);
  winding_kernels().add_field(cluster, everywhere);
  const unsigned asked = 0b10110111u;
  const unsigned near = winding_kernels().add_where_far(cluster, share, asked, some);
  EXPECT_EQ(near, 0b111u);
  for (int l = 0; l < winding_lanes; ++l) {
    const std::array<float, 3> q{some.x[l], some.y[l], some.z[l]};
    unsigned is_near = 0;
    const float alone = winding_kernels().far(lanes, q.data(), 1e9f, is_near);
    EXPECT_NEAR(everywhere.sum[l], 0.5 + double(alone), 1e-5 * (1 + std::abs(alone))) << l;
    (void)winding_kernels().far(lanes, q.data(), share, is_near);
    const bool is_asked = (asked >> l & 1u) != 0, far = is_asked && (is_near & 1u) == 0;
    EXPECT_EQ((near >> l & 1u) != 0, is_asked && !far) << l;
    EXPECT_EQ(some.sum[l], far ? everywhere.sum[l] : 0.5f) << l;
  }
}

// Triangles that close nothing; queries among them, around them and far from them.
TEST(WindingNumber, TogetherIsTheSumWithinItsAccuracy) {
  const int n = 3000;
  const MatX3 centres = test::random_points(n, 1), sides = 0.04 * test::random_points(3 * n, 1);
  MatX3 points(3 * n, 3);
  MatX3i faces(n, 3);
  for (int f = 0; f < n; ++f)
    for (int k = 0; k < 3; ++k) {
      points.row(3 * f + k) = centres.row(f) + sides.row(3 * f + k);
      faces(f, k) = 3 * f + k;
    }
  const WindingNumber winding(points, faces, WindingNumber::Queries::together);
  ASSERT_FALSE(winding.exact());
  const MatX3 places = test::random_points(40000, 1);
  MatX3 queries(40003, 3);
  queries << 0.05 * places.topRows(20000), 1.3 * places.bottomRows(20000), 9, 0, 0, 0, 1e9, 0,
      1e300, 0, 0;
  set_thread_count(1);
  const VecX together = winding.at(queries, Task());
  double sum = 0, largest = 0;
  int n_looked_at = 0;
  for (Eigen::Index i = 0; i < queries.rows(); i += i < 39000 ? 37 : 1) {
    const double error = std::abs(together[i] - winding(queries.row(i), infinity));
    sum += error;
    largest = std::max(largest, error);
    ++n_looked_at;
  }
  EXPECT_LE(largest, 2e-4);
  EXPECT_LE(sum / n_looked_at, 3e-5);
  EXPECT_NEAR(together[40000], winding(queries.row(40000)), 1e-12);
  set_thread_count(4);
  EXPECT_EQ(winding.at(queries, Task()), together);
  set_thread_count(0);
  // A few, and none.
  const VecX few = winding.at(queries.topRows(3), Task());
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(few[i], winding(queries.row(i), infinity), 2e-4);
  EXPECT_EQ(winding.at(MatX3(0, 3), Task()).size(), 0);
  const CancelToken stop;
  stop.cancel();
  EXPECT_THROW(winding.at(queries, Task(stop)), Cancelled);
}

TEST(WindingNumber, TogetherIsExactWhereItIsExactAlone) {
  const PolygonSoup sphere = test::octasphere_soup(3);
  MatX3i faces(sphere.n_faces(), 3);
  for (int f = 0; f < sphere.n_faces(); ++f)
    for (int k = 0; k < 3; ++k) faces(f, k) = sphere.face(f)[k];
  const WindingNumber winding(sphere.points, faces, WindingNumber::Queries::together);
  ASSERT_TRUE(winding.exact());
  const MatX3 queries = test::random_points(500, 1.5);
  const VecX together = winding.at(queries, Task());
  for (int i = 0; i < 500; ++i) EXPECT_EQ(together[i], winding(queries.row(i))) << i;
}

TEST(WindingNumber, WithinATriangleOfASoupHasTheValueOfTheSum) {
  // In single precision queries next to a triangle would be on either side of it.
  const PolygonSoup soup = test::torus_soup(60, 40);
  const MatX3i faces = one_in_seven_reversed(soup);
  const WindingNumber winding(soup.points, faces);
  ASSERT_FALSE(winding.exact());
  for (int f = 0; f < faces.rows(); f += 37)
    for (const double height : {1e-8, -1e-8, 1e-5, -1e-5, 1e-3}) {
      const Vec3 a = soup.points.row(faces(f, 0)), b = soup.points.row(faces(f, 1)),
                 c = soup.points.row(faces(f, 2));
      const Vec3 q = 0.2 * a + 0.3 * b + 0.5 * c + height * (b - a).cross(c - a).normalized();
      EXPECT_NEAR(winding(q), winding_number_brute_force(soup.points, faces, q), 5e-4) << height;
    }
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
