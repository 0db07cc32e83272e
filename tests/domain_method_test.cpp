// What every method of distance keeps on every discretization: one body for
// all.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numeric>

#include "base/parallel.h"
#include "constants.h"
#include "domain_shapes.h"
#include "heat_helpers.h"

namespace littoral {
namespace {

using test::Domain;
using test::pi;

class OnEveryDomain : public testing::TestWithParam<Domain> {
 protected:
  static constexpr int n = 24;
  static test::Shape sphere() { return test::sphere(GetParam(), n); }

  /// The circle 60 degrees from the north pole, positive to its north.
  static Sources parallel(bool is_signed = true) {
    return test::space_curve(test::circle(0, 0, 0.5, std::sin(pi / 3), 200), is_signed);
  }
  static double colatitude(const test::Shape& s, int v) {
    const Vec3 p = s.soup.points.row(v);
    return std::atan2(std::hypot(p.x(), p.y()), p.z());
  }
  static int topmost(const test::Shape& s) {
    Eigen::Index v = 0;
    s.soup.points.col(2).maxCoeff(&v);
    return static_cast<int>(v);
  }
  static double mean_error(const test::Shape& s, const VecX& phi,
                           const std::function<double(double)>& exact) {
    EXPECT_TRUE(phi.allFinite());
    double sum = 0;
    for (int v = 0; v < phi.size(); ++v) sum += std::abs(phi[v] - exact(colatitude(s, v)));
    return sum / static_cast<double>(phi.size()) / pi;
  }
  static double tolerance() { return GetParam() == Domain::voxels ? 0.012 : 0.006; }
};

TEST_P(OnEveryDomain, SignedCircleWithEveryConstraint) {
  const test::Shape s = sphere();
  for (const OptionValues& options :
       {OptionValues{{"constraint", "none"}}, OptionValues{{"constraint", "zero-set"}},
        OptionValues{{"constraint", "level-sets"}}, OptionValues{{"soft", "100"}}}) {
    const VecX phi = s.distance(parallel(), "signed-heat", options);
    EXPECT_LE(mean_error(s, phi, [](double t) { return pi / 3 - t; }), tolerance());
  }
}

TEST_P(OnEveryDomain, UnsignedCircle) {
  const test::Shape s = sphere();
  for (const char* method : {"signed-heat", "unsigned-heat"}) {
    const VecX phi = s.distance(parallel(false), method);
    EXPECT_LE(mean_error(s, phi, [](double t) { return std::abs(pi / 3 - t); }), 2 * tolerance());
  }
}

TEST_P(OnEveryDomain, Point) {
  const test::Shape s = sphere();
  for (const char* method : {"signed-heat", "unsigned-heat"}) {
    const VecX phi = s.distance(test::vertex_points({topmost(s)}), method);
    EXPECT_LE(mean_error(s, phi, [](double t) { return t; }), 5 * tolerance());
  }
}

TEST_P(OnEveryDomain, MotionScaleAndOrientation) {
  const test::Shape s = sphere();
  const VecX phi = s.distance(parallel(), "signed-heat");
  const double size = phi.cwiseAbs().maxCoeff();
  const Eigen::Matrix3d R = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  for (const double scale : {1e-3, 1.0, 1e3}) {
    test::Shape moved = s;
    const Eigen::RowVector3d shift = scale * Eigen::RowVector3d(3, -2, 5);
    auto move = [&](MatX3& x) { x = ((scale * x * R.transpose()).rowwise() + shift).eval(); };
    move(moved.soup.points);
    moved.soup.normals = (moved.soup.normals * R.transpose()).eval();
    moved.face_normals = (moved.face_normals * R.transpose()).eval();
    Sources sources = parallel();
    move(sources.space_curves[0].points);
    const VecX psi = moved.distance(sources, "signed-heat");
    EXPECT_LE((psi - scale * phi).cwiseAbs().maxCoeff(), 1e-6 * scale * size) << scale;
  }
  const VecX flipped = s.distance(parallel().reversed(), "signed-heat");
  EXPECT_LE((flipped + phi).cwiseAbs().maxCoeff(), 1e-9 * size);
}

TEST_P(OnEveryDomain, Relabelling) {
  const test::Shape s = sphere();
  std::mt19937 random(3);
  std::vector<int> name(s.soup.n_vertices());
  std::iota(name.begin(), name.end(), 0);
  std::shuffle(name.begin(), name.end(), random);
  test::Shape other = s;
  for (int v = 0; v < s.soup.n_vertices(); ++v) {
    other.soup.points.row(name[v]) = s.soup.points.row(v);
    if (s.soup.normals.rows()) other.soup.normals.row(name[v]) = s.soup.normals.row(v);
  }
  for (int& v : other.soup.corners) v = name[v];
  Sources from, to;
  for (int v : {topmost(s), 5}) {
    from.points.push_back(SurfacePoint::at_vertex(v));
    to.points.push_back(SurfacePoint::at_vertex(name[v]));
  }
  const VecX phi = s.distance(from, "unsigned-heat"), psi = other.distance(to, "unsigned-heat");
  for (int v = 0; v < phi.size(); ++v) EXPECT_NEAR(psi[name[v]], phi[v], 1e-7);
}

TEST_P(OnEveryDomain, FarFromTheOrigin) {
  const test::Shape s = sphere();
  test::Shape moved = s;
  const Eigen::RowVector3d shift(2e6, -3e6, 1e6);
  moved.soup.points.rowwise() += shift;
  Sources sources = parallel();
  sources.space_curves[0].points.rowwise() += shift;
  const VecX phi = s.distance(parallel(), "signed-heat"),
             psi = moved.distance(sources, "signed-heat");
  EXPECT_LE((psi - phi).cwiseAbs().maxCoeff(), 1e-5);
}

TEST_P(OnEveryDomain, PointsWithoutAFaceChangeNothing) {
  const test::Shape s = sphere();
  test::Shape more = s;
  const int count = s.soup.n_vertices();
  auto add = [](MatX3& x, const Eigen::RowVector3d& row) {
    if (x.rows() == 0) return;
    x.conservativeResize(x.rows() + 1, 3);
    x.bottomRows(1) = row;
  };
  // In a cloud every other point has neighbours.
  const double nowhere = s.soup.n_faces() ? 7 : std::nan("");
  add(more.soup.points, Eigen::RowVector3d(nowhere, 0, 0));
  add(more.soup.normals, Eigen::RowVector3d(0, 0, 1));
  const VecX phi = s.distance(parallel(), "signed-heat"),
             psi = more.distance(parallel(), "signed-heat");
  EXPECT_LE((psi.head(count) - phi).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_EQ(psi[count], std::numeric_limits<double>::infinity());
}

TEST_P(OnEveryDomain, HeldNormals) {
  const test::Shape s = sphere();
  const VecX phi = s.distance(parallel(), "signed-heat", {{"preserve-normals", "on"}});
  EXPECT_LE(mean_error(s, phi, [](double t) { return pi / 3 - t; }), 2 * tolerance());
}

/// Two spheres, five apart.
test::Shape twins(const test::Shape& s) {
  test::Shape two = s;
  const int half = s.soup.n_vertices();
  auto twice = [](MatX3& x, const Eigen::RowVector3d& shift) {
    const Eigen::Index rows = x.rows();
    x.conservativeResize(2 * rows, 3);
    x.bottomRows(rows) = x.topRows(rows).rowwise() + shift;
  };
  twice(two.soup.points, Eigen::RowVector3d(5, 0, 0));
  twice(two.soup.normals, Eigen::RowVector3d::Zero());
  twice(two.face_normals, Eigen::RowVector3d::Zero());
  for (int f = 0; f < s.soup.n_faces(); ++f) {
    std::vector<int> corners;
    for (int v : s.soup.face(f)) corners.push_back(v + half);
    two.soup.add_face(corners);
  }
  return two;
}

TEST_P(OnEveryDomain, ComponentsAreProblemsOfTheirOwn) {
  const test::Shape s = sphere(), two = twins(s);
  const int half = s.soup.n_vertices();
  Sources both = parallel();
  both.space_curves.push_back(both.space_curves[0]);
  both.space_curves[1].points.rowwise() += Eigen::RowVector3d(5, 0, 0);
  for (const char* constraint : {"none", "zero-set", "level-sets"}) {
    const OptionValues options{{"constraint", constraint}};
    const VecX phi = s.distance(parallel(), "signed-heat", options);
    const VecX psi = two.distance(both, "signed-heat", options);
    EXPECT_LE((psi.head(half) - phi).cwiseAbs().maxCoeff(), 1e-6) << constraint;
    EXPECT_LE((psi.tail(half) - phi).cwiseAbs().maxCoeff(), 1e-6) << constraint;
  }
}

TEST_P(OnEveryDomain, ComponentsWithoutASourceAreInfinite) {
  const test::Shape s = sphere(), two = twins(s);
  const int half = s.soup.n_vertices();
  for (const char* method : {"signed-heat", "unsigned-heat"}) {
    Report report;
    const VecX phi = two.distance(parallel(), method, {}, &report);
    EXPECT_TRUE(phi.head(half).allFinite());
    EXPECT_TRUE((phi.tail(half).array() == std::numeric_limits<double>::infinity()).all());
    EXPECT_THAT(report.unreachable_components, testing::SizeIs(1));
  }
}

TEST_P(OnEveryDomain, SameBitsForAnyNumberOfThreads) {
  set_thread_count(1);
  const VecX one = sphere().distance(parallel(), "signed-heat");
  set_thread_count(3);
  EXPECT_TRUE(sphere().distance(parallel(), "signed-heat") == one);
  set_thread_count(0);
}

INSTANTIATE_TEST_SUITE_P(Domains, OnEveryDomain,
                         testing::Values(Domain::triangles, Domain::polygons, Domain::points,
                                         Domain::voxels));

class WithFaces : public OnEveryDomain {};

TEST_P(WithFaces, PointsInFacesAndOnEdges) {
  const test::Shape s = sphere();
  const SurfaceMesh mesh(s.soup);
  const int f = mesh.n_faces() / 3, e = mesh.n_edges() / 2;
  for (const SurfacePoint& p :
       {SurfacePoint::in_face(f, 0.3, 0.3, 0.4), SurfacePoint::on_edge(e, 0.3)}) {
    Sources sources;
    sources.points.push_back(p);
    const Vec3 at = mesh.position(p).normalized();
    for (const char* method : {"signed-heat", "unsigned-heat"}) {
      const VecX phi = s.distance(sources, method);
      double sum = 0;
      for (int v = 0; v < phi.size(); ++v) {
        const Vec3 q = s.soup.points.row(v);
        sum += std::abs(phi[v] - std::atan2(at.cross(q).norm(), at.dot(q)));
      }
      EXPECT_LE(sum / static_cast<double>(phi.size()) / pi, 5 * tolerance()) << method;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Domains, WithFaces,
                         testing::Values(Domain::triangles, Domain::polygons, Domain::voxels));

class InThePlane : public testing::TestWithParam<Domain> {};

TEST_P(InThePlane, StraightLineAcrossFacesAndBoundary) {
  const test::Shape s = test::square(GetParam(), 20);
  MatX3 line(2, 3);
  line << 0.31, 0, 0, 0.55, 1, 0;
  const Vec3 along = (line.row(1) - line.row(0)).normalized(), left(-along.y(), along.x(), 0);
  for (const bool is_signed : {true, false}) {
    const Sources sources = test::space_curve(line, is_signed);
    const VecX phi = s.distance(sources, "signed-heat");
    double sum = 0;
    for (int v = 0; v < phi.size(); ++v) {
      const double exact = left.dot(s.soup.points.row(v) - line.row(0));
      sum += std::abs(phi[v] - (is_signed ? exact : std::abs(exact)));
    }
    EXPECT_LE(sum / static_cast<double>(phi.size()), is_signed ? 0.008 : 0.03);
  }
}

INSTANTIATE_TEST_SUITE_P(Domains, InThePlane,
                         testing::Values(Domain::triangles, Domain::polygons, Domain::points));

class Refined : public testing::TestWithParam<std::tuple<Domain, double>> {};

TEST_P(Refined, ErrorFallsWithTheSpacing) {
  const auto [domain, order] = GetParam();
  double error[2];
  for (int l = 0; l < 2; ++l) {
    const test::Shape s = test::sphere(domain, 16 << l);
    const VecX phi = s.distance(test::space_curve(test::circle(0, 0, 0.5, std::sin(pi / 3), 400)),
                                "signed-heat");
    error[l] = 0;
    for (int v = 0; v < phi.size(); ++v) {
      const Vec3 p = s.soup.points.row(v);
      error[l] += std::abs(phi[v] - (pi / 3 - std::atan2(std::hypot(p.x(), p.y()), p.z())));
    }
    error[l] /= static_cast<double>(phi.size());
  }
  EXPECT_GE(std::log2(error[0] / error[1]), order);
}

INSTANTIATE_TEST_SUITE_P(Domains, Refined,
                         testing::Values(std::tuple(Domain::triangles, 0.8),
                                         std::tuple(Domain::polygons, 1.5),
                                         std::tuple(Domain::points, 1.5),
                                         std::tuple(Domain::voxels, 0.4)));

}  // namespace
}  // namespace littoral
