// The contract of the operators, on meshes of every kind.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "domain/cloud/cloud_surface.h"
#include "domain/mesh/polygon_surface.h"
#include "domain_shapes.h"
#include "heat_helpers.h"
#include "operators/nodal.h"
#include "operators/triangles.h"
#include "sources/surface/surface_points.h"
#include "sources/surface/triangle_sources.h"
#include "test_meshes.h"

namespace littoral {
namespace {

/// A band with a half twist: not orientable, so frames cannot all agree.
PolygonSoup moebius_soup(int n, int width) {
  PolygonSoup soup;
  soup.points.resize(n * (width + 1), 3);
  const double turn = 2 * std::acos(-1.0);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j <= width; ++j) {
      const double u = turn * i / n, s = 0.4 * (2.0 * j / width - 1);
      const double r = 1 + s * std::cos(u / 2);
      soup.points.row(i * (width + 1) + j) << r * std::cos(u), r * std::sin(u), s * std::sin(u / 2);
    }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < width; ++j) {
      const int w = width + 1, last = i + 1 == n;
      const int a = i * w + j, b = a + 1;
      const int c = last ? width - j : a + w, d = last ? width - j - 1 : b + w;
      test::add_triangle(soup, a, c, d);
      test::add_triangle(soup, a, d, b);
    }
  return soup;
}

PolygonSoup some_flipped(PolygonSoup soup) {
  for (int f = 0; f < soup.n_faces(); f += 7)
    std::swap(soup.corners[3 * f], soup.corners[3 * f + 1]);
  return soup;
}

PolygonSoup with_degenerate_faces() {
  PolygonSoup soup = test::jittered_grid_soup(6, 6, 0.3);
  test::add_triangle(soup, 0, 1, 2);   // collinear
  test::add_triangle(soup, 3, 3, 10);  // a vertex repeated
  test::add_triangle(soup, 0, 1, 8);   // a third face at an edge
  return soup;
}

struct CheckedMesh {
  const char* name;
  PolygonSoup soup;
  MatX3 face_normals{0, 3};  // of voxels
};

CheckedMesh on(test::Domain domain, const char* name) {
  test::Shape shape = test::sphere(domain, 10);
  return {name, shape.soup, shape.face_normals};
}

Operators operators_of(const CheckedMesh& mesh, Report& report) {
  const SurfaceMesh surface(mesh.soup);
  if (mesh.face_normals.rows())
    return nodal_operators(voxel_surface(surface, mesh.face_normals, report));
  if (!surface.n_faces())
    return nodal_operators(cloud_surface(surface.points(), mesh.soup.normals, report));
  if (!surface.is_triangle_mesh()) return nodal_operators(polygon_surface(surface, report));
  return triangle_operators(intrinsic_triangulation(surface, report));
}

std::ostream& operator<<(std::ostream& out, const CheckedMesh& mesh) { return out << mesh.name; }

class HeatOperators : public testing::TestWithParam<CheckedMesh> {
 protected:
  HeatOperators()
      : ops(operators_of(GetParam(), report)), L(ops.scalar.L.selfadjointView<Eigen::Lower>()) {}

  VecX random_vector(Eigen::Index n) {
    VecX x(n);
    for (double& v : x) v = uniform(random);
    return x;
  }
  /// The connection Laplacian as a real matrix on interleaved pairs, whichever form it has.
  VecX diffuse_operator(const VecX& x) const {
    if (!ops.vector.complex_linear())
      return ops.vector.L_real({}).selfadjointView<Eigen::Lower>() * x;
    const Eigen::Map<const VecXc> z(reinterpret_cast<const Complex*>(x.data()), x.size() / 2);
    const VecXc y = ops.vector.L({}).selfadjointView<Eigen::Lower>() * z;
    return Eigen::Map<const VecX>(reinterpret_cast<const double*>(y.data()), x.size());
  }

  Report report;
  Operators ops;
  SpMat L;
  std::mt19937 random{7};
  std::uniform_real_distribution<double> uniform{-1, 1};
};

TEST_P(HeatOperators, LaplacianIsSemidefiniteWithConstantsInItsNullSpace) {
  const double size = L.coeffs().cwiseAbs().maxCoeff();
  ASSERT_TRUE(std::isfinite(size));
  EXPECT_LE((L * VecX::Ones(L.rows())).cwiseAbs().maxCoeff(), 1e-12 * size);
  for (int k = 0; k < 20; ++k) {
    const VecX x = random_vector(L.rows());
    EXPECT_GE(x.dot(L * x), -1e-12 * size * x.squaredNorm());
  }
}

TEST_P(HeatOperators, LaplacianIsDivergenceOfGradient) {
  const Calculus& C = ops.scalar;
  const double size = L.coeffs().cwiseAbs().maxCoeff();
  const VecX x = random_vector(L.rows());
  EXPECT_LE((C.divergence(C.G.apply(x)) - L * x).cwiseAbs().maxCoeff(), 1e-9 * size);
}

TEST_P(HeatOperators, GradientAndItsAdjointIntegrateByParts) {
  const Calculus& C = ops.scalar;
  const VecX x = random_vector(C.G.cols), Y = random_vector(C.G.rows);
  const VecX gradient = C.G.apply(x);
  EXPECT_NEAR(gradient.dot(Y), x.dot(C.G.adjoint(Y)), 1e-12 * gradient.norm() * Y.norm());
  const SpRows G = C.G.matrix();
  EXPECT_LE((G * x - gradient).norm(), 1e-12 * gradient.norm());
  for (int r = 0; r < G.outerSize(); ++r) {
    int last = -1;
    for (SpRows::InnerIterator it(G, r); it; last = static_cast<int>(it.col()), ++it)
      ASSERT_GT(it.col(), last) << "columns ascend in row " << r;
  }
}

TEST_P(HeatOperators, MassesSumToTheArea) {
  const double area = ops.scalar.A.sum();
  EXPECT_GT(area, 0);
  EXPECT_NEAR(ops.scalar.M.sum(), area, 1e-12 * area);
  EXPECT_NEAR(ops.vector.M.sum(), area, 1e-12 * area);
}

TEST_P(HeatOperators, ConnectionLaplacianIsSymmetricAndSemidefinite) {
  const Eigen::Index n = 2 * ops.vector.n;
  for (int k = 0; k < 20; ++k) {
    const VecX x = random_vector(n), y = random_vector(n);
    const VecX Lx = diffuse_operator(x), Ly = diffuse_operator(y);
    ASSERT_TRUE(Lx.allFinite());
    EXPECT_NEAR(y.dot(Lx), x.dot(Ly), 1e-10 * (Lx.norm() * y.norm() + Ly.norm() * x.norm()));
    EXPECT_GE(x.dot(Lx), -1e-10 * Lx.norm() * x.norm());
  }
}

INSTANTIATE_TEST_SUITE_P(
    Meshes, HeatOperators,
    testing::Values(CheckedMesh{"grid", test::grid_soup(7, 5)},
                    CheckedMesh{"jittered", test::jittered_grid_soup(8, 8, 0.3)},
                    CheckedMesh{"sphere", test::octasphere_soup(3)},
                    CheckedMesh{"torus", test::torus_soup(18, 9)},
                    CheckedMesh{"flipped", some_flipped(test::torus_soup(18, 9))},
                    CheckedMesh{"moebius", moebius_soup(24, 4)},
                    CheckedMesh{"degenerate", with_degenerate_faces()},
                    on(test::Domain::polygons, "polygons"), on(test::Domain::points, "points"),
                    on(test::Domain::voxels, "voxels")));

class NodalPlane : public testing::TestWithParam<test::Domain> {};

TEST_P(NodalPlane, LinearFunctionsAndConstantFieldsAreExact) {
  const test::Shape shape = test::square(GetParam(), 9);
  const SurfaceMesh mesh(shape.soup);
  Report report;
  const NodalSurface S = GetParam() == test::Domain::polygons
                             ? polygon_surface(mesh, report)
                             : cloud_surface(mesh.points(), shape.soup.normals, report);
  const Operators ops = nodal_operators(S);
  const Calculus& C = ops.scalar;
  const VecX x = mesh.points() * Vec3(2, -3, 0);
  const VecX g = C.G.apply(x / ops.unit);
  // The same vector as a field at nodes, in the frame that all tangent planes share.
  const Complex w = TangentFrame(Vec3::UnitZ()).coordinates(Vec3(2, -3, 0));
  VecX X(2 * ops.vector.n);
  for (int i = 0; i < ops.vector.n; ++i) X.segment<2>(2 * i) << w.real(), w.imag();
  const VecX Y = ops.vector.to_cells.apply(X);
  EXPECT_LE((g - Y).cwiseAbs().maxCoeff(), 1e-8);
  const Eigen::Map<const VecXc> z(reinterpret_cast<const Complex*>(X.data()), ops.vector.n);
  const VecXc Lz = ops.vector.L({}).selfadjointView<Eigen::Lower>() * z;
  EXPECT_LE(Lz.cwiseAbs().maxCoeff(), 1e-9);
  const VecX Lx = C.L.selfadjointView<Eigen::Lower>() * x;
  for (int v = 0; v < mesh.n_vertices(); ++v)
    if (!C.boundary[v]) {
      EXPECT_NEAR(Lx[v], 0, 1e-9);
    }
}

INSTANTIATE_TEST_SUITE_P(Domains, NodalPlane,
                         testing::Values(test::Domain::polygons, test::Domain::points));

TEST(HeatOperatorsPlane, LinearFunctionsHaveConstantGradients) {
  Report report;
  const SurfaceMesh mesh(test::jittered_grid_soup(9, 9, 0.3));
  const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
  const Operators ops = triangle_operators(T);
  const VecX x = mesh.points().col(0) * 2 - mesh.points().col(1) * 3;
  const VecX g = ops.scalar.G.apply(x / T.unit);
  for (int f = 0; f < T.n_faces(); ++f) {
    EXPECT_NEAR(g.segment<2>(2 * f).norm(), std::sqrt(13.0), 1e-9);
    // In the frame of the face, side 0 is the real axis.
    const Vec3 side = mesh.point(T.faces(f, 1)) - mesh.point(T.faces(f, 0));
    EXPECT_NEAR(g[2 * f] * side.norm(), 2 * side.x() - 3 * side.y(), 1e-9);
  }
}

/// A constant field of the plane in the frames of the edges, which point along them.
VecX constant_field(const SurfaceMesh& mesh, const IntrinsicTriangulation& T, Complex w) {
  VecX x(2 * T.n_edges());
  for (int e = 0; e < T.n_edges(); ++e) {
    const Vec3 side = mesh.point(T.edges(e, 1)) - mesh.point(T.edges(e, 0));
    const Complex z = w * std::conj(Complex(side.x(), side.y())) / side.norm();
    x[2 * e] = z.real();
    x[2 * e + 1] = z.imag();
  }
  return x;
}

TEST(HeatOperatorsPlane, ConstantFieldsAreInTheNullSpaceOfTheConnectionLaplacian) {
  Report report;
  const SurfaceMesh mesh(test::jittered_grid_soup(9, 9, 0.3));
  const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
  const Operators ops = triangle_operators(T);
  ASSERT_TRUE(ops.vector.complex_linear());
  const VecX x = constant_field(mesh, T, Complex(0.6, 0.8));
  const Eigen::Map<const VecXc> z(reinterpret_cast<const Complex*>(x.data()), T.n_edges());
  const VecXc y = ops.vector.L({}).selfadjointView<Eigen::Lower>() * z;
  EXPECT_LE(y.cwiseAbs().maxCoeff(), 1e-10);
  // Averaged to a face it is the same vector, in the face's frame.
  const VecX cells = ops.vector.to_cells.apply(x);
  for (int f = 0; f < T.n_faces(); ++f) {
    const Vec3 side = mesh.point(T.faces(f, 1)) - mesh.point(T.faces(f, 0));
    const Complex expected =
        Complex(0.6, 0.8) * std::conj(Complex(side.x(), side.y())) / side.norm();
    EXPECT_NEAR(cells[2 * f], expected.real(), 1e-10);
    EXPECT_NEAR(cells[2 * f + 1], expected.imag(), 1e-10);
  }
}

TEST(HeatOperatorsPlane, TwoTrianglesThatShareAVertexArePinchedThere) {
  // The shared vertex is each corner of either triangle in turn; no other is pinched.
  for (int k = 0; k < 9; ++k) {
    PolygonSoup soup;
    soup.points.resize(5, 3);
    soup.points << 0, 0, 0, 1, 1, 0, -1, 1, 0, -1, -1, 0, 1, -1, 0;
    std::array<int, 3> first = {0, 1, 2}, second = {0, 3, 4};
    std::rotate(first.begin(), first.begin() + k % 3, first.end());
    std::rotate(second.begin(), second.begin() + k / 3, second.end());
    soup.add_face(first);
    soup.add_face(second);
    Report report;
    const VectorDiffusion V =
        triangle_operators(intrinsic_triangulation(SurfaceMesh(soup), report)).vector;
    ASSERT_EQ(V.pinches.size(), 2U) << k;
    EXPECT_NE(V.pinches[0].piece, V.pinches[1].piece);
    for (const Pinch& pinch : V.pinches) {
      EXPECT_EQ(pinch.node, 0);
      EXPECT_FALSE(pinch.radial.empty());
    }
  }
}

TEST(HeatOperatorsPlane, RealAndComplexFormsHaveTheSameEnergy) {
  // A Moebius band beside a grid forces the real form on both; the grid's part must not change.
  Report report;
  const PolygonSoup grid = test::jittered_grid_soup(6, 6, 0.3), band = moebius_soup(16, 2);
  PolygonSoup both = grid;
  both.points.conservativeResize(grid.n_vertices() + band.n_vertices(), 3);
  both.points.bottomRows(band.n_vertices()) = band.points.rowwise() + Eigen::RowVector3d(3, 0, 0);
  for (int f = 0; f < band.n_faces(); ++f) {
    const auto c = band.face(f);
    test::add_triangle(both, c[0] + grid.n_vertices(), c[1] + grid.n_vertices(),
                       c[2] + grid.n_vertices());
  }
  const auto alone = triangle_operators(intrinsic_triangulation(SurfaceMesh(grid), report));
  const auto joint = triangle_operators(intrinsic_triangulation(SurfaceMesh(both), report));
  ASSERT_TRUE(alone.vector.complex_linear());
  ASSERT_FALSE(joint.vector.complex_linear());
  std::mt19937 random(5);
  std::uniform_real_distribution<double> u(-1, 1);
  VecX x = VecX::Zero(2 * joint.vector.n);
  for (int i = 0; i < 2 * alone.vector.n; ++i) x[i] = u(random);
  const Eigen::Map<const VecXc> z(reinterpret_cast<const Complex*>(x.data()), alone.vector.n);
  const VecXc y = alone.vector.L({}).selfadjointView<Eigen::Lower>() * z;
  const double energy = z.dot(y).real();
  const VecX real_y = joint.vector.L_real({}).selfadjointView<Eigen::Lower>() * x;
  EXPECT_NEAR(x.dot(real_y), energy, 1e-10 * energy);
}

TEST(HeatOperatorsPlane, PointsGiveTheEdgesOppositeAndThoseTheyLieOnTheirDirections) {
  // The integral of directions over the angle of a side: along its bisector, 2 sin(angle / 2) long.
  const SurfaceMesh mesh(test::jittered_grid_soup(5, 4, 0.25));
  Report report;
  const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
  std::vector<SurfacePoint> points{SurfacePoint::at_vertex(13), SurfacePoint::at_vertex(3),
                                   SurfacePoint::in_face(11, 0.3, 0.5, 0.2)};
  for (int e = 2; e < mesh.n_edges(); e += 11) points.push_back(SurfacePoint::on_edge(e, 0.35));
  for (const SurfacePoint& p : points) {
    const Vec3 x = mesh.position(p);
    MatX3 expected = MatX3::Zero(T.n_edges(), 3);
    double all = 0;
    for (const int f : faces_at(mesh, p)) {
      std::array<Vec3, 3> to;
      for (std::size_t k = 0; k < 3; ++k) to[k] = mesh.point(mesh.face(f)[k]) - x;
      std::array<bool, 3> on_side;
      for (std::size_t k = 0; k < 3; ++k) on_side[k] = to[k].cross(to[(k + 1) % 3]).norm() < 1e-12;
      for (std::size_t k = 0; k < 3; ++k) {
        if (on_side[k]) continue;
        const Vec3 u = to[k].normalized(), w = to[(k + 1) % 3].normalized();
        const double angle = std::acos(std::clamp(u.dot(w), -1., 1.));
        all += angle;
        for (int l = 0; l < 3; ++l)
          if (l == int(k) || on_side[static_cast<std::size_t>(l)])
            expected.row(T.side_edge(f, l)) += (u + w).normalized() * 2 * std::sin(angle / 2);
      }
    }
    std::vector<std::pair<int, Complex>> found;
    add_radial_measure(T, triangles_around(mesh, T, p), 5, found);
    MatX3 vectors = MatX3::Zero(T.n_edges(), 3);
    for (const auto& [e, z] : found) {
      const Vec3 d = (mesh.point(T.edges(e, 1)) - mesh.point(T.edges(e, 0))).normalized();
      vectors.row(e) += z.real() * d + z.imag() * Vec3::UnitZ().cross(d);
    }
    EXPECT_LT((vectors - 5 / all * expected).cwiseAbs().maxCoeff(), 1e-9)
        << static_cast<int>(p.on) << " " << p.element;
  }
}

}  // namespace
}  // namespace littoral
