// Distance through a tet mesh of your own.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "api/tet/tet_boundary.h"
#include "constants.h"
#include "domain/tet/tet_locator.h"
#include "io/tet/tets.h"
#include "one_call.h"
#include "shared_data.h"
#include "space_helpers.h"
#include "tet_helpers.h"

namespace littoral {
namespace {

using test::infinity;

VecX tet_distance(const TetMesh& mesh, const TetSources& sources,
                  const OptionValues& options = {}) {
  Report report;
  return test::tet_mesh_distance(mesh, sources, AnyMethod::named("signed-heat", options), report);
}

TEST(TetPictures, AreCutOpenWhereTheBoundaryHasOneValue) {
  for (const int n : {4, 5}) {
    const TetMesh mesh = test::tet_box(n);
    const VecX inward =
        mesh.points.cwiseMin((1 - mesh.points.array()).matrix()).rowwise().minCoeff();
    const io::TetFile file{mesh, {}, {{"distance", inward}}};
    EXPECT_EQ(boundary_of(file).scalars.at("distance").maxCoeff(), 0);
    const PolygonSoup drawn = drawn_surface(file);
    const VecX& shown = drawn.scalars.at("distance");
    EXPECT_NEAR(shown.maxCoeff(), n % 2 ? 0.4 : 0.5, 1e-12);
    EXPECT_LE(drawn.points.col(2).maxCoeff(), 0.5 + 1e-12);
    for (int v = 0; v < drawn.n_vertices(); ++v) {
      if (shown[v] > 1e-12) {
        EXPECT_NEAR(drawn.points(v, 2), 0.5, 1e-12);
      }
    }
    const io::TetFile sloping{mesh, {}, {{"x", mesh.points.col(0)}}};
    EXPECT_EQ(drawn_surface(sloping).n_faces(), boundary_of(sloping).n_faces());
  }
}

TEST(TetLocator, FindsTheTetAndItsCoordinates) {
  const TetMesh mesh = test::tet_box(4);
  const TetLocator locator(mesh);
  const MatX3 queries = test::random_points(400, 0.7);
  int inside = 0;
  for (Eigen::Index i = 0; i < queries.rows(); ++i) {
    const Vec3 x = queries.row(i).transpose().array() + 0.5;
    const TetPoint p = locator.locate(x);
    const bool in_cube = x.minCoeff() >= 0 && x.maxCoeff() <= 1;
    EXPECT_EQ(p.tet >= 0, in_cube);
    if (p.tet < 0) continue;
    ++inside;
    Vec3 y = Vec3::Zero();
    for (int k = 0; k < 4; ++k) {
      EXPECT_GE(p.barycentric[k], -1e-9);
      y += p.barycentric[k] * mesh.points.row(mesh.tets(p.tet, k)).transpose();
    }
    EXPECT_LT((x - y).norm(), 1e-12);
  }
  EXPECT_GT(inside, 50);
}

TEST(TetLocator, TheBoundaryOfACubeFacesOutward) {
  TetMesh mesh = test::tet_box(3);
  for (int t = 0; t < mesh.n_tets(); t += 2) std::swap(mesh.tets(t, 0), mesh.tets(t, 1));
  const MatX3i faces = boundary_faces(mesh);
  EXPECT_EQ(faces.rows(), 6 * 9 * 2);
  double volume = 0;
  for (const auto& f : faces.rowwise()) {
    const Vec3 a = mesh.points.row(f[0]), b = mesh.points.row(f[1]), c = mesh.points.row(f[2]);
    volume += a.dot(b.cross(c)) / 6;
  }
  EXPECT_NEAR(volume, 1, 1e-12);
}

// A plane through the whole domain diffuses to its own normal everywhere: linear functions are
// exact, whatever the tets.
TEST(TetMeshDistance, IsExactFromAPlaneOfFaces) {
  const int n = 6;
  TetMesh mesh = test::tet_box(n);
  const VecX phi = tet_distance(mesh, {test::square_at(0.5, n), {}});
  EXPECT_LT((phi - (mesh.points.col(0).array() - 0.5).matrix()).cwiseAbs().maxCoeff(), 1e-3);
}

TEST(TetMeshDistance, IsExactFromAPlaneBetweenFaces) {
  const int n = 6;
  TetMesh mesh = test::tet_box(n);
  // Inner vertices anywhere: the plane crosses tets of every shape.
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(-0.03, 0.03);
  for (auto p : mesh.points.rowwise())
    if (p.minCoeff() > 0 && p.maxCoeff() < 1)
      for (double& x : p) x += u(random);
  for (const char* constraint : {"none", "zero-set", "soft"}) {
    const VecX phi =
        tet_distance(mesh, {test::square_at(0.43, 9), {}}, {{"constraint", constraint}});
    EXPECT_LT((phi - (mesh.points.col(0).array() - 0.43).matrix()).cwiseAbs().maxCoeff(), 2e-3)
        << constraint;
  }
}

TEST(TetMeshDistance, ParallelPlanesAreLevelSetsOfOneFunction) {
  const int n = 6;
  TetMesh mesh = test::tet_box(n);
  PolygonSoup planes = test::square_at(0.27, 9);
  const PolygonSoup second = test::square_at(0.71, 9);
  const int first = planes.n_vertices();
  planes.points.conservativeResize(2 * first, 3);
  planes.points.bottomRows(first) = second.points;
  for (int f = 0; f < second.n_faces(); ++f) {
    std::vector<int> face;
    for (const int v : second.face(f)) face.push_back(first + v);
    planes.add_face(face);
  }
  const VecX x = mesh.points.col(0).array() - 0.49;
  const auto worst = [&](const char* constraint) {
    const VecX phi = tet_distance(mesh, {planes, {}}, {{"constraint", constraint}});
    return (phi - x).cwiseAbs().maxCoeff();
  };
  EXPECT_LT(worst("level-sets"), 2e-3);
  EXPECT_GT(worst("zero-set"), 0.1);  // it holds both at zero
  EXPECT_THROW(tet_distance(mesh, {planes, {}}, {{"constraint", "level-sets"}, {"sharpen", "on"}}),
               InputError);
}

TEST(TetMeshDistance, IsZeroAtTheVerticesOfFacesThatAreSources) {
  const int n = 6;
  const TetMesh mesh = test::tet_box(n);
  // Two planes that meet at a right angle.
  PolygonSoup corner;
  std::vector<int> used;
  for (int v = 0; v < mesh.n_vertices(); ++v) {
    const Vec3 p = mesh.points.row(v);
    const bool side = p[0] == 0.5 && p[1] <= 0.5, top = p[1] == 0.5 && p[0] <= 0.5;
    if (side || top) used.push_back(v);
  }
  PolygonSoup side = test::square_at(0.5, n);
  corner.points = side.points;
  for (int f = 0; f < side.n_faces(); ++f) {
    bool low = true;
    for (int v : side.face(f)) low = low && side.points(v, 1) <= 0.5;
    if (low) corner.add_face(side.face(f));
  }
  const int first = corner.n_vertices();
  MatX3 turned = side.points;
  turned.col(0) = side.points.col(1);
  turned.col(1) = side.points.col(0);
  corner.points.conservativeResize(2 * first, 3);
  corner.points.bottomRows(first) = turned;
  for (int f = 0; f < side.n_faces(); ++f) {
    const auto face = side.face(f);
    const int other[3] = {first + face[0], first + face[2], first + face[1]};
    bool low = true;
    for (int v : face) low = low && side.points(v, 1) <= 0.5;
    if (low) corner.add_face(other);
  }
  const VecX phi = tet_distance(mesh, {corner, {}});
  for (int v : used) EXPECT_NEAR(phi[v], 0, 0.01 / n);
  EXPECT_LT(phi[0], -0.2);
  EXPECT_GT(phi[mesh.n_vertices() - 1], 0.3);
}

TEST(TetMeshDistance, FromAVertexGrowsByOne) {
  double last = infinity;
  for (const int n : {8, 16}) {
    const TetMesh mesh = test::tet_box(n);
    const int middle = n / 2 * (1 + (n + 1) * (1 + (n + 1)));
    const VecX phi = tet_distance(mesh, {{}, {middle}});
    const VecX exact = (mesh.points.rowwise() - mesh.points.row(middle)).rowwise().norm();
    const double error = (phi - exact).cwiseAbs().mean() / exact.maxCoeff();
    EXPECT_LT(error, 0.05);
    EXPECT_LT(error, 0.8 * last);
    EXPECT_EQ(phi[middle], phi.minCoeff());
    last = error;
  }
}

TEST(TetMeshDistance, FromAVertexDoesNotDependOnVerticesInNoTet) {
  const TetMesh mesh = test::tet_box(4);
  TetMesh other = mesh;  // one before the others, and one after them
  other.points.resize(mesh.n_vertices() + 2, 3);
  other.points << Eigen::RowVector3d(0.5, 0.5, 0.6), mesh.points, Eigen::RowVector3d(7, 8, 9);
  other.tets.array() += 1;
  const VecX phi = tet_distance(mesh, {{}, {30}}), same = tet_distance(other, {{}, {31}});
  EXPECT_LE((same.segment(1, phi.size()) - phi).cwiseAbs().maxCoeff(), 1e-5);
  EXPECT_EQ(same[0], infinity);
  EXPECT_EQ(same[phi.size() + 1], infinity);
}

TEST(TetMeshDistance, ComponentsAreSolvedApart) {
  const int n = 4;
  const TetMesh one = test::tet_box(n);
  TetMesh three = test::copies(one, 3, {0, 2, 0});
  const int nv = one.n_vertices();
  three.points.conservativeResize(3 * nv + 1, 3);
  three.points.row(3 * nv) << 9, 9, 9;  // in no tet
  PolygonSoup source = test::square_at(0.5, n);
  PolygonSoup second = test::square_at(0.25, n);
  const int first = source.n_vertices();
  source.points.conservativeResize(2 * first, 3);
  source.points.bottomRows(first) = second.points.rowwise() + Eigen::RowVector3d(0, 2, 0);
  for (int f = 0; f < second.n_faces(); ++f) {
    const auto face = second.face(f);
    const int moved[3] = {first + face[0], first + face[1], first + face[2]};
    source.add_face(moved);
  }
  Report report;
  const VecX phi = test::tet_mesh_distance(three, {source, {}}, {}, report);
  const VecX x = one.points.col(0);
  EXPECT_LT((phi.head(nv).array() - (x.array() - 0.5)).abs().maxCoeff(), 1e-3);
  EXPECT_LT((phi.segment(nv, nv).array() - (x.array() - 0.25)).abs().maxCoeff(), 1e-3);
  for (int v = 2 * nv; v < 3 * nv + 1; ++v) EXPECT_EQ(phi[v], infinity);
  EXPECT_EQ(report.unreachable_components, std::vector<int>{2});
}

TEST(TetMeshDistance, DoesNotDependOnPlaceScaleNumbersAndOrientation) {
  const int n = 5;
  const TetMesh mesh = test::tet_box(n);
  PolygonSoup ball = test::octasphere_soup(2);
  ball.points = (0.3 * ball.points).rowwise() + Eigen::RowVector3d(0.5, 0.45, 0.55);
  const VecX phi = tet_distance(mesh, {ball, {}});

  TetMesh moved = mesh;
  PolygonSoup moved_ball = ball;
  for (MatX3* points : {&moved.points, &moved_ball.points})
    *points = (1024 * *points).rowwise() + Eigen::RowVector3d(4096, -2048, 0);
  EXPECT_LT((tet_distance(moved, {moved_ball, {}}) / 1024 - phi).cwiseAbs().maxCoeff(), 1e-5);

  TetMesh mixed = mesh;
  std::mt19937 random(5);
  std::vector<int> order(static_cast<std::size_t>(mesh.n_vertices()));
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), random);
  for (int v = 0; v < mesh.n_vertices(); ++v) mixed.points.row(order[v]) = mesh.points.row(v);
  for (int t = 0; t < mesh.n_tets(); ++t) {
    for (int k = 0; k < 4; ++k) mixed.tets(t, k) = order[mesh.tets(mesh.n_tets() - 1 - t, k)];
    if (t % 2) std::swap(mixed.tets(t, 1), mixed.tets(t, 2));
  }
  const VecX psi = tet_distance(mixed, {ball, {}});
  for (int v = 0; v < mesh.n_vertices(); ++v) EXPECT_NEAR(psi[order[v]], phi[v], 2e-3);

  TetSources inward{ball, {}};
  inward.flip = true;
  const VecX flipped = tet_distance(mesh, inward);
  EXPECT_LT((flipped + phi).cwiseAbs().maxCoeff(), 1e-3);
}

TEST(TetMeshDistance, SaysWhatIsWrong) {
  const TetMesh mesh = test::tet_box(2);
  const PolygonSoup square = test::square_at(0.5, 2);
  PolygonSoup far = square;
  far.points.array() += 5;
  EXPECT_THAT(test::message_of([&] {
                tet_distance(mesh, {far, {}});
              }),
              testing::HasSubstr("no source lies within the tets"));
  EXPECT_THAT(test::message_of([&] {
                tet_distance(mesh, {square, {1}});
              }),
              testing::HasSubstr("not both"));
  EXPECT_THAT(test::message_of([&] {
                Report report;
                test::tet_mesh_distance(mesh, {square, {}}, WindingSign{}, report);
              }),
              testing::HasSubstr("unknown method 'winding'; known: auto, signed-heat"));
  TetMesh flat = mesh;
  flat.points.col(2).setZero();
  EXPECT_THAT(test::message_of([&] {
                tet_distance(flat, {square, {}});
              }),
              testing::HasSubstr("no volume"));
  TetMesh broken = mesh;
  broken.points(13, 1) = std::nan("");
  EXPECT_THAT(test::message_of([&] {
                tet_distance(broken, {square, {}});
              }),
              testing::HasSubstr("vertex 13, whose coordinates are not finite"));
}

TEST(TetMeshDistanceSlow, OfABallFromItsBoundary) {
  LITTORAL_NEEDS_SHARED("data/tets/sphere.mesh");
  const io::TetFile file = io::read_tets(test::shared() / "data/tets/sphere.mesh");
  PolygonSoup boundary;
  boundary.points = file.mesh.points;
  const MatX3i faces = boundary_faces(file.mesh);
  for (const auto& f : faces.rowwise()) {
    const int corners[3] = {f[0], f[1], f[2]};
    boundary.add_face(corners);
  }
  const VecX phi = tet_distance(file.mesh, {boundary, {}});
  const double radius = file.mesh.points.maxCoeff() / 2;  // it touches the coordinate planes
  const VecX r = (file.mesh.points.array() - radius).matrix().rowwise().norm();
  VecX error = VecX::Zero(r.size());
  for (Eigen::Index v = 0; v < r.size(); ++v)
    if (std::isfinite(phi[v])) error[v] = std::abs(phi[v] - (r[v] - radius));
  EXPECT_LT(error.mean(), 0.002 * radius);
  EXPECT_LT(error.maxCoeff(), 0.05 * radius);
}

}  // namespace
}  // namespace littoral
