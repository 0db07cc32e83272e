#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <random>

#include "api/surface/mesh_info.h"
#include "base/parallel.h"
#include "contour/isosurface.h"
#include "littoral/error.h"
#include "test_meshes.h"
#include "volume_helpers.h"

namespace littoral {
namespace {

using test::sampled;

PolygonSoup contour(const Volume& f, double level = 0, bool close = false) {
  Report report;
  return isosurface(f.grid, f.values, level, {.close = close}, report);
}

class Facts {
 public:
  explicit Facts(const PolygonSoup& soup) : entries_(surface_info(soup)) {}
  double operator[](const std::string& key) const {
    for (const InfoEntry& entry : entries_) {
      if (entry.key == key) return std::get<double>(entry.value);
    }
    throw std::runtime_error("no such fact: " + key);
  }

 private:
  std::vector<InfoEntry> entries_;
};

double info(const PolygonSoup& soup, const std::string& key) { return Facts(soup)[key]; }

// Nothing wrong with the surface; boundary is allowed where the box is met.
void expect_clean(const PolygonSoup& soup, bool closed = true) {
  const Facts facts(soup);
  for (const char* key :
       {"nonmanifold_edges", "nonmanifold_vertices", "inconsistently_oriented_edges",
        "degenerate_faces", "duplicate_faces", "coincident_vertices", "isolated_vertices"}) {
    EXPECT_EQ(facts[key], 0) << key;
  }
  if (closed) {
    EXPECT_EQ(facts["boundary_edges"], 0);
  }
}

double volume(const PolygonSoup& soup) {
  double sum = 0;
  for (int f = 0; f < soup.n_faces(); ++f) {
    const auto v = soup.face(f);
    const Vec3 a = soup.points.row(v[0]), b = soup.points.row(v[1]), c = soup.points.row(v[2]);
    sum += a.cross(b).dot(c) / 6;
  }
  return sum;
}

double sphere(const Vec3& p) { return p.norm() - 0.7; }

double torus(const Vec3& p) { return std::hypot(std::hypot(p[0], p[1]) - 0.6, p[2]) - 0.25; }

TEST(Isosurface, SphereConvergesWithSecondOrderAndLooksOutward) {
  double before = 0;
  for (int n : {17, 33, 65}) {
    const PolygonSoup soup = contour(sampled(test::box_grid(n), sphere));
    expect_clean(soup);
    EXPECT_EQ(info(soup, "euler_characteristic"), 2);
    double worst = 0;
    for (int v = 0; v < soup.n_vertices(); ++v)
      worst = std::max(worst, std::abs(soup.points.row(v).norm() - 0.7));
    if (before > 0) {
      EXPECT_NEAR(std::log2(before / worst), 2, 0.3);
    }
    before = worst;
    const double exact = 4.0 / 3 * std::acos(-1.0) * 0.7 * 0.7 * 0.7;
    EXPECT_NEAR(volume(soup), exact, 6.0 * exact / (n * n));
  }
}

TEST(Isosurface, TorusHasOneHandle) {
  const PolygonSoup soup = contour(sampled(test::box_grid(40), torus));
  expect_clean(soup);
  EXPECT_EQ(info(soup, "euler_characteristic"), 0);
  EXPECT_EQ(info(soup, "components"), 1);
}

TEST(Isosurface, AnisotropicGridsOfAnySize) {
  const Grid grid{{7, 30, 19}, Vec3(-1, -1, -1), Vec3(2.0 / 6, 2.0 / 29, 2.0 / 18)};
  const PolygonSoup soup = contour(sampled(grid, sphere));
  expect_clean(soup);
  EXPECT_EQ(info(soup, "euler_characteristic"), 2);
}

// Independent values at every node: all cases of marching cubes, with all their neighbours.
TEST(Isosurface, RandomFieldsGiveManifolds) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto field = sampled(test::box_grid(9), [&](const Vec3&) { return uniform(random); });
    expect_clean(contour(field), false);
    expect_clean(contour(field, 0.4, true));
  }
}

// Small whole numbers: values exactly at the level, equal neighbours, saddles at the level.
TEST(IsosurfaceSlow, ValuesAtTheLevelMakeNoDegenerateTriangles) {
  for (unsigned seed = 0; seed < 40; ++seed) {
    std::mt19937 random(seed);
    std::uniform_int_distribution<int> whole(-1 - static_cast<int>(seed % 3), 2);
    const auto field =
        sampled(test::box_grid(8), [&](const Vec3&) { return static_cast<double>(whole(random)); });
    expect_clean(contour(field), false);
    expect_clean(contour(field, 0, true));
  }
}

TEST(Isosurface, BoxOnTheNodesIsExact) {
  const auto box = [](const Vec3& p) { return p.cwiseAbs().maxCoeff() - 0.5; };
  const PolygonSoup soup = contour(sampled(test::box_grid(9), box));
  expect_clean(soup);
  EXPECT_EQ(info(soup, "euler_characteristic"), 2);
  EXPECT_NEAR(volume(soup), 1, 1e-12);
  for (int v = 0; v < soup.n_vertices(); ++v)
    EXPECT_NEAR(soup.points.row(v).cwiseAbs().maxCoeff(), 0.5, 1e-12);
}

TEST(Isosurface, ALonePointAtTheLevelHasNoSurface) {
  const auto distance = [](const Vec3& p) { return p.norm(); };
  EXPECT_EQ(contour(sampled(test::box_grid(9), distance)).n_faces(), 0);
}

TEST(Isosurface, ClosedAtTheBoxWhereAsked) {
  const auto plane = [](const Vec3& p) { return p[2] + 0.1 * p[0] - 0.05; };
  Report report;
  const auto field = sampled(test::box_grid(12), plane);
  const PolygonSoup open = isosurface(field.grid, field.values, 0, {}, report);
  EXPECT_EQ(info(open, "boundary_loops"), 1);
  ASSERT_EQ(report.warnings.size(), 1u);
  EXPECT_NE(report.warnings[0].text.find("meets the boundary"), std::string::npos);
  Report quiet;
  const PolygonSoup closed = isosurface(field.grid, field.values, 0, {.close = true}, quiet);
  EXPECT_TRUE(quiet.warnings.empty());
  expect_clean(closed);
  EXPECT_EQ(info(closed, "euler_characteristic"), 2);
  EXPECT_NEAR(volume(closed), 4 * 1.05, 1e-3);  // the rim is rounded by 1/20 of a spacing
  EXPECT_LE(closed.points.cwiseAbs().maxCoeff(), 1 + 1e-12);
  // Everything below the level: the box itself.
  const PolygonSoup box = contour(field, 9, true);
  expect_clean(box);
  EXPECT_NEAR(volume(box), 8, 1e-9);
}

// The trilinear interpolant itself, sampled finely, is what the topology has to agree with.
TEST(IsosurfaceSlow, TopologyOfTheTrilinearInterpolant) {
  int wrong = 0, handles = 0;
  for (unsigned seed = 0; seed < 24; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto coarse = sampled(test::box_grid(3), [&](const Vec3&) { return uniform(random); });
    const auto fine = sampled(test::box_grid(2 * 14 + 1), [&](const Vec3& p) {
      return interpolate(coarse, (p + Vec3::Ones()).cwiseQuotient(coarse.grid.spacing));
    });
    const PolygonSoup a = contour(coarse, 0, true), b = contour(fine, 0, true);
    if (a.n_faces() == 0) continue;
    const Facts at_once(a), sampled_finely(b);
    const double euler = at_once["euler_characteristic"], parts = at_once["components"];
    if (euler != sampled_finely["euler_characteristic"] || parts != sampled_finely["components"])
      ++wrong;
    if (euler < 2 * parts) ++handles;
  }
  EXPECT_LE(wrong, 1);  // saddles too close to the level for the fine sampling
  EXPECT_GE(handles, 3);
}

// Two opposite corners above: joined by a tube if the middle is above, too.
TEST(Isosurface, TubeThroughACell) {
  Volume cell{test::box_grid(2), VecX::Constant(8, -1), "distance"};
  cell.values[0] = cell.values[7] = 2;
  const PolygonSoup discs = contour(cell);
  EXPECT_EQ(info(discs, "components"), 2);
  cell.values[0] = cell.values[7] = 9;
  const PolygonSoup tube = contour(cell);
  EXPECT_EQ(info(tube, "components"), 1);
  EXPECT_EQ(info(tube, "boundary_loops"), 2);
  EXPECT_EQ(info(tube, "euler_characteristic"), 0);
  expect_clean(tube, false);
}

TEST(Isosurface, SameBitsForAnyNumberOfThreads) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto field = sampled(test::box_grid(24), [&](const Vec3&) { return uniform(random); });
  set_thread_count(1);
  const PolygonSoup one = contour(field, 0.1, true);
  set_thread_count(5);
  const PolygonSoup five = contour(field, 0.1, true);
  set_thread_count(0);
  EXPECT_EQ(one.corners, five.corners);
  EXPECT_TRUE((one.points.array() == five.points.array()).all());
}

TEST(Isosurface, ScaleAndTranslation) {
  const auto field = sampled(test::box_grid(15), torus);
  const PolygonSoup base = contour(field);
  for (double scale : {1e-3, 1e3}) {
    Volume moved = field;
    moved.values *= scale;
    moved.grid.spacing *= scale;
    moved.grid.origin = scale * (field.grid.origin + Vec3(10, -3, 2));
    const PolygonSoup soup = contour(moved);
    ASSERT_EQ(soup.corners, base.corners);
    const MatX3 back = (soup.points / scale).rowwise() - Eigen::RowVector3d(10, -3, 2);
    EXPECT_LT((back - base.points).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST(Isosurface, HugeAndTinyValues) {
  for (double scale : {1e-300, 1e300, 1.7e308}) {
    auto field =
        sampled(test::box_grid(9), [](const Vec3& p) { return p.norm() < 0.7 ? -1.0 : 1.0; });
    field.values *= scale;
    expect_clean(contour(field));
  }
}

TEST(Isosurface, BadInputIsRefused) {
  auto field = sampled(test::box_grid(5), sphere);
  Report report;
  const auto refused = [&](const Volume& f, double level, const std::string& why) {
    try {
      isosurface(f.grid, f.values, level, {}, report);
      ADD_FAILURE() << "accepted: " << why;
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find(why), std::string::npos) << e.what();
    }
  };
  refused(field, std::nan(""), "level");
  Volume bad = field;
  bad.values[1 + 5 * (2 + 5 * 3)] = std::numeric_limits<double>::infinity();
  refused(bad, 0, "node (1, 2, 3) is inf");
  bad.values = VecX::Zero(7);
  refused(bad, 0, "7 values for 125 nodes");
  bad = field;
  bad.grid.n = {5, 25, 1};
  refused(bad, 0, "two nodes");
  bad = field;
  bad.grid.spacing[1] = 0;
  refused(bad, 0, "spacing");
}

TEST(Isosurface, Cancels) {
  const auto field = sampled(test::box_grid(9), sphere);
  CancelToken cancel;
  cancel.cancel();
  Report report;
  EXPECT_THROW(isosurface(field.grid, field.values, 0, {}, report, Task(cancel)), Cancelled);
}

// n nodes along each axis of the test grids' box.
TetMesh kuhn_lattice(int n) {
  TetMesh mesh = test::tet_box(n - 1);
  const Grid grid = test::box_grid(n);
  for (int v = 0; v < mesh.n_vertices(); ++v)
    mesh.points.row(v) = grid.point(v % n, v / n % n, v / n / n);
  return mesh;
}

TEST(MarchingTets, SphereAndTorusAreCleanAndLookOutward) {
  const TetMesh mesh = kuhn_lattice(24);
  for (const auto& [shape, euler] : {std::pair{&sphere, 2}, {&torus, 0}}) {
    VecX values(mesh.n_vertices());
    for (int v = 0; v < mesh.n_vertices(); ++v) values[v] = shape(mesh.points.row(v));
    Report report;
    const PolygonSoup soup = isosurface(mesh, values, 0, report);
    expect_clean(soup);
    EXPECT_EQ(info(soup, "euler_characteristic"), euler);
    EXPECT_GT(volume(soup), 0.4);
  }
}

TEST(MarchingTets, RandomAndWholeValuesGiveManifolds) {
  const TetMesh mesh = kuhn_lattice(7);
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    VecX values(mesh.n_vertices());
    for (double& v : values) v = seed % 2 ? uniform(random) : std::round(1.4 * uniform(random));
    Report report;
    expect_clean(isosurface(mesh, values, 0, report), false);
  }
}

TEST(MarchingTets, BadInputIsRefused) {
  TetMesh mesh = kuhn_lattice(2);
  Report report;
  VecX values = VecX::LinSpaced(8, -1, 1);
  EXPECT_THROW(isosurface(mesh, VecX::Zero(3), 0, report), InputError);
  values[3] = std::nan("");
  EXPECT_THROW(isosurface(mesh, values, 0, report), InputError);
  values[3] = 0;
  mesh.tets(2, 1) = 8;
  EXPECT_THROW(isosurface(mesh, values, 0, report), InputError);
}

}  // namespace
}  // namespace littoral
