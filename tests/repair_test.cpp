#include "littoral/repair.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <set>
#include <vector>

#include "api/surface/mesh_info.h"
#include "broken_shapes.h"
#include "contour/fit_to_surface.h"
#include "contour/isosurface.h"
#include "littoral/error.h"
#include "repair_helpers.h"
#include "space_helpers.h"
#include "spatial/self_intersections.h"
#include "spatial/triangulate.h"
#include "test_meshes.h"

namespace littoral {
namespace {

TEST(Repair, BoxWithItsEdgesAndCorners) {
  // A box that does not follow the grid: the fit gives its edges and corners back.
  PolygonSoup box = test::box_soup(Vec3(0.5, 0.4, 0.3));
  const Eigen::Matrix3d turn(Eigen::AngleAxis<double>(0.5, Vec3(1, 2, 3).normalized()));
  box.points = box.points * turn.transpose();
  RepairOptions options;
  options.remesh = true;
  options.grid.resolution = 32;
  const Repaired with = repair(box, options);
  options.fit = false;
  const Repaired without = repair(box, options);
  test::expect_watertight(with.surface);
  test::expect_watertight(without.surface);
  EXPECT_EQ(with.report.status, "converged");
  const double h = 1.0 / 25;  // about a spacing
  EXPECT_GT(test::size_named(without.report, "input to result: largest"), 0.1 * h);
  EXPECT_LT(test::size_named(with.report, "input to result: largest"), 0.02 * h);
  EXPECT_LT(test::size_named(with.report, "result to input: largest"), 1e-9);
  EXPECT_NEAR(test::volume_of(with.surface.soup()), 8 * 0.5 * 0.4 * 0.3, 1e-4);
  EXPECT_EQ(test::size_named(with.report, "result: handles"), 0);
}

TEST(Repair, CreasesDoNotFlattenFaces) {
  RepairOptions options;
  options.remesh = true;
  // Along the grid both ends of a side lie next to the same place of an edge.
  for (const auto& [resolution, angle] :
       {std::pair(12, 0.2), std::pair(20, 0.5), std::pair(48, 0.0)}) {
    PolygonSoup box = test::box_soup(Vec3(0.5, 0.4, 0.3));
    const Eigen::Matrix3d turn(Eigen::AngleAxis<double>(angle, Vec3(1, 2, 3).normalized()));
    box.points = box.points * turn.transpose();
    options.grid.resolution = resolution;
    const PolygonSoup out = repair(box, options).surface.soup();
    for (int f = 0; f < out.n_faces(); ++f) {
      const Vec3 a = out.points.row(out.face(f)[0]), b = out.points.row(out.face(f)[1]),
                 c = out.points.row(out.face(f)[2]);
      const double longest = std::max({(b - a).norm(), (c - a).norm(), (c - b).norm()});
      EXPECT_GT((b - a).cross(c - a).norm(), 1e-3 * longest * longest) << resolution << " " << f;
    }
  }
}

TEST(Repair, HoleTurnedFacesAndADuplicate) {
  // A sphere with a hole, some faces turned round, some twice and one piece of it beside itself.
  const PolygonSoup whole = test::octasphere_soup(4);
  PolygonSoup broken;
  broken.points = whole.points;
  std::mt19937 random(2);
  for (int f = 0; f < whole.n_faces(); ++f) {
    const auto v = whole.face(f);
    const Vec3 x = whole.points.row(v[0]);
    if (x[2] > 0.93) continue;
    if (random() % 20 == 0)
      test::add_triangle(broken, v[0], v[2], v[1]);
    else
      test::add_triangle(broken, v[0], v[1], v[2]);
    if (random() % 20 == 0) test::add_triangle(broken, v[0], v[1], v[2]);
  }
  RepairOptions options;
  options.grid.resolution = 48;
  const Repaired out = repair(broken, options);
  test::expect_watertight(out.surface);
  EXPECT_GT(test::size_named(out.report, "input: boundary edges"), 0);
  EXPECT_GT(test::size_named(out.report, "input: self intersecting triangles"), 0);
  EXPECT_LT(test::size_named(out.report, "result to input and closure: largest"), 0.05);
  EXPECT_NEAR(test::volume_of(out.surface.soup()), 4 * M_PI / 3, 0.08);
}

TEST(Repair, OverlappingPartsBecomeOne) {
  PolygonSoup a = test::box_soup(Vec3(0.5, 0.5, 0.5)), b = a;
  b.points.rowwise() += Eigen::RowVector3d(0.41, 0.37, 0.33);
  RepairOptions options;
  options.grid.resolution = 40;
  const Repaired out = repair(test::joined(a, b), options);
  test::expect_watertight(out.surface);
  EXPECT_EQ(test::size_named(out.report, "parts"), 1);
  EXPECT_NEAR(test::volume_of(out.surface.soup()), 2 - 0.59 * 0.63 * 0.67, 2e-3);
  EXPECT_GT(test::size_named(out.report, "input within the result, share"), 0.1);
  EXPECT_EQ(test::size_named(out.report, "input missed, share"), 0);
}

TEST(Repair, PartsAndCavities) {
  const PolygonSoup outer = test::octasphere_soup(3);
  PolygonSoup inner = test::reversed(outer), small = outer;
  inner.points *= 0.5;
  small.points *= 0.2;
  small.points.rowwise() += Eigen::RowVector3d(1.6, 0, 0);
  const PolygonSoup all = test::joined(test::joined(outer, inner), small);
  RepairOptions options;
  options.grid.resolution = 48;
  EXPECT_EQ(test::size_named(repair(all, options).report, "parts"), 3);
  options.smallest_part = 1;
  const Repaired large = repair(all, options);
  EXPECT_EQ(test::size_named(large.report, "parts"), 2);
  EXPECT_EQ(test::size_named(large.report, "small parts dropped"), 1);
  options.cavities = false;
  const Repaired solid = repair(all, options);
  EXPECT_EQ(test::size_named(solid.report, "cavities filled"), 1);
  EXPECT_NEAR(test::volume_of(solid.surface.soup()), test::volume_of(outer), 0.03);
  options.smallest_part = 100;
  EXPECT_THROW(repair(all, options), InputError);
}

TEST(Repair, KeepsTrianglesThatNeedOnlyTurning) {
  // Two balls, one with a cavity, every corner by itself as in STL files; a third of the faces is
  // turned round, some are there twice.
  const PolygonSoup ball = test::octasphere_soup(3);
  PolygonSoup cavity = ball, second = ball;
  cavity.points *= 0.5;
  second.points.col(0).array() += 3;
  const PolygonSoup all = test::joined(test::joined(ball, test::reversed(cavity)), second);
  PolygonSoup broken;
  broken.points.resize(3 * 2 * all.n_faces(), 3);
  std::mt19937 random(3);
  int n = 0;
  for (int f = 0; f < all.n_faces(); ++f)
    for (int again = random() % 10 == 0 ? 2 : 1; again > 0; --again) {
      for (const int v : all.face(f)) broken.points.row(n++) = all.points.row(v);
      if (all.face(f)[0] < 2 * ball.n_vertices() && random() % 3 == 0)
        test::add_triangle(broken, n - 3, n - 1, n - 2);
      else
        test::add_triangle(broken, n - 3, n - 2, n - 1);
    }
  broken.points.conservativeResize(n, 3);
  const Repaired out = repair(broken);
  test::expect_watertight(out.surface);
  EXPECT_EQ(test::size_named(out.report, "parts"), 3);
  EXPECT_EQ(out.surface.soup().n_faces(), 3 * ball.n_faces());
  EXPECT_NEAR(test::volume_of(out.surface.soup()), (1 - 0.125 + 1) * test::volume_of(ball), 1e-12);
  EXPECT_LT(test::size_named(out.report, "result to input: largest"), 1e-14);
  EXPECT_GT(test::size_named(out.report, "triangles of the input turned, share"), 0.1);
}

TEST(Repair, LeavesOutAWholePartWithinAnother) {
  const PolygonSoup ball = test::octasphere_soup(3);
  PolygonSoup within = ball;
  within.points *= 0.5;
  const Repaired out = repair(test::joined(within, ball));
  EXPECT_EQ(out.surface.soup().points, ball.points);
  EXPECT_EQ(test::size_named(out.report, "parts"), 1);
  EXPECT_NEAR(test::size_named(out.report, "input within the result, share"), 0.2, 1e-12);
}

TEST(Repair, KeepsABoxInsideOutToTheBit) {
  const PolygonSoup box = test::box_soup(Vec3(0.1, 0.7, 0.3));
  for (const PolygonSoup& given : {box, test::reversed(box)}) {
    const PolygonSoup kept = repair(given).surface.soup();
    EXPECT_EQ(kept.points, box.points);
    EXPECT_EQ(kept.n_faces(), 12);
    EXPECT_GT(test::volume_of(kept), 0);
  }
  RepairOptions options;
  options.remesh = true;
  options.grid.resolution = 16;
  EXPECT_GT(repair(box, options).surface.soup().n_faces(), 100);
}

/// Of which a face is missing, thinner than a spacing of the usual grid.
PolygonSoup ruler() {
  PolygonSoup out;
  const PolygonSoup box = test::box_soup(Vec3(0.5, 0.03, 0.004));
  out.points = box.points;
  for (int f = 0; f < box.n_faces() - 1; ++f) out.add_face(box.face(f));
  return out;
}

TEST(Repair, KeepsTheUsualGridWhereAFinerOneIsTooLarge) {
  const double finer = test::size_named(repair(ruler()).report, "nodes");
  Context little;
  little.memory_limit = 40 * finer;  // a grid takes 48 bytes a node
  const Repaired usual = repair(ruler(), {}, {}, {}, little);
  EXPECT_LT(test::size_named(usual.report, "nodes"), 0.8 * finer);
  EXPECT_GT(usual.surface.n_faces(), 0);
  EXPECT_EQ(usual.report.status, "uncertain");  // of parts that were lost
}

TEST(Repair, GridsAreFinerWherePartsAreThin) {
  const Repaired out = repair(ruler());
  test::expect_watertight(out.surface);
  EXPECT_GT(test::size_named(out.report, "nodes"), 128);
  EXPECT_NEAR(test::volume_of(out.surface.soup()), 0.06 * 0.008, 0.02 * 0.06 * 0.008);
  EXPECT_LT(test::size_named(out.report, "input missed, share"), 0.01);
}

TEST(Repair, MeasuresSheetsOnce) {
  // On the grid that showed them to have no inside; where it leaves no room for walls, on a wider
  // one.
  const PolygonSoup sheet = test::grid_soup(4, 4);
  for (const double padding : {0.1, 0.0}) {
    RepairOptions options;
    options.grid.resolution = 48;
    options.grid.padding = padding;
    int measured = 0;
    std::string last;
    Context context;
    context.progress = [&](double, const std::string& stage) {
      measured += stage == "sign" && stage != last;
      last = stage;
    };
    const Repaired out = repair(sheet, options, {}, {}, context);
    EXPECT_EQ(measured, padding > 0 ? 1 : 2);
    test::expect_watertight(out.surface);
    EXPECT_EQ(test::size_named(out.report, "parts"), 1);
  }
}

TEST(Repair, WarnsOfWhatItMisses) {
  // A box with a large fin that has no inside.
  const PolygonSoup box = test::box_soup(Vec3(0.5, 0.5, 0.5));
  PolygonSoup fin = test::grid_soup(2, 2);
  fin.points.rowwise() += Eigen::RowVector3d(0.4, 0, 0);
  RepairOptions options;
  options.grid.resolution = 40;
  const Repaired out = repair(test::joined(box, fin), options);
  test::expect_watertight(out.surface);
  EXPECT_EQ(out.report.status, "uncertain");
  EXPECT_GT(test::size_named(out.report, "input missed, share"), 0.03);
}

TEST(Repair, RefinesUntilTheErrorIsMet) {
  const PolygonSoup sphere = test::octasphere_soup(3);
  RepairOptions options;
  options.remesh = true;
  options.fit = false;
  options.error = 0.004;
  const Repaired out = repair(sphere, options);
  EXPECT_EQ(out.report.status, "converged");
  EXPECT_LE(test::size_named(out.report, "result to input and closure: largest"), 0.004);
}

TEST(RepairSlow, StopsWhereRefiningDoesNotLowerTheError) {
  // Walls about a sheet are three spacings thick where the sheet has an inside nowhere; given
  // their thickness, their surface stays half of it away, however fine the grid.
  const PolygonSoup sheet = test::grid_soup(2, 2);
  RepairOptions options;
  options.thicken = 0.2;
  options.error = 1e-9;
  const Repaired out = repair(sheet, options);
  EXPECT_EQ(out.report.status, "uncertain");
  ASSERT_FALSE(out.report.warnings.empty());
  EXPECT_EQ(out.report.warnings.back().code, "accuracy-missed");
  EXPECT_NE(out.report.warnings.back().text.find("finer grids do not lower it"), std::string::npos);
  EXPECT_NEAR(test::size_named(out.report, "result to input and closure: largest"), 0.1, 0.01);
  EXPECT_LT(test::size_named(out.report, "nodes"), 1e6);  // 6.6 million on the finest grid
}

TEST(Repair, StopsWhereAFinerGridIsTooLarge) {
  RepairOptions options;
  options.error = 1e-9;
  options.remesh = true;
  Context little;
  little.memory_limit = 3e7;
  const Repaired out = repair(test::octasphere_soup(3), options, {}, {}, little);
  EXPECT_EQ(out.report.status, "uncertain");
  EXPECT_EQ(out.report.warnings.back().code, "accuracy-missed");
  EXPECT_NE(out.report.warnings.back().text.find("a finer grid is too large"), std::string::npos);
}

TEST(Repair, RefusesWhatMakesNoSense) {
  const PolygonSoup sphere = test::octasphere_soup(1);
  RepairOptions options;
  options.error = NAN;
  EXPECT_THROW(repair(sphere, options), InputError);
  options = {};
  options.thicken = -1;
  EXPECT_THROW(repair(sphere, options), InputError);
  options = {};
  options.thicken = 1;
  PolygonSoup cloud;
  cloud.points = cloud.normals = sphere.points;
  EXPECT_THROW(repair(cloud, options), UnsupportedError);
  options = {};
  options.error = 0.1;  // nothing to measure it from
  EXPECT_THROW(repair(cloud, options), UnsupportedError);
  EXPECT_THROW(repair(PolygonSoup{}), InputError);
}

TEST(FitToSurface, UntanglesAPointThatWasPushedThrough) {
  PolygonSoup sphere = test::octasphere_soup(3);
  const MatX3i faces = triangles_of(sphere);
  sphere.points.row(40) *= -1.3;  // through the other side
  const auto crossing = [&] {
    const auto flags = self_intersecting_faces(sphere.points, faces);
    return std::count(flags.begin(), flags.end(), 1);
  };
  EXPECT_GT(crossing(), 0);
  untangle(sphere.points, faces, {});
  EXPECT_EQ(crossing(), 0);
  EXPECT_NEAR(test::volume_of(sphere), 4 * M_PI / 3, 0.3);
}

/// The same with every face looked at in every round.
MatX3 untangled_plainly(MatX3 points, const MatX3i& faces) {
  for (int round = 0; round < 20; ++round) {
    const std::vector<char> crossing = self_intersecting_faces(points, faces);
    if (std::count(crossing.begin(), crossing.end(), 1) == 0) return points;
    const MatX3 before = points;
    for (int v = 0; v < points.rows(); ++v) {
      bool bad = false;
      std::set<int> neighbours;
      for (Eigen::Index f = 0; f < faces.rows(); ++f)
        for (int k = 0; k < 3; ++k) {
          if (faces(f, k) != v) continue;
          bad = bad || crossing[std::size_t(f)] != 0;
          neighbours.insert({faces(f, (k + 1) % 3), faces(f, (k + 2) % 3)});
        }
      if (!bad) continue;
      Vec3 sum = Vec3::Zero();
      for (const int w : neighbours) sum += before.row(w);
      points.row(v) = 0.5 * before.row(v) + 0.5 * (sum / double(neighbours.size())).transpose();
    }
  }
  return points;
}

TEST(FitToSurface, UntanglingMovesVerticesToTheMiddleOfTheirNeighbours) {
  for (const double far : {-1.3, -1.02}) {
    PolygonSoup sphere = test::octasphere_soup(2);
    const MatX3i faces = triangles_of(sphere);
    sphere.points.row(20) *= far;
    sphere.points.row(30) = 1.2 * sphere.points.row(31);
    const MatX3 expected = untangled_plainly(sphere.points, faces);
    EXPECT_GT((sphere.points - expected).norm(), 0.1) << far;
    untangle(sphere.points, faces, {});
    EXPECT_LE((sphere.points - expected).cwiseAbs().maxCoeff(), 1e-12) << far;
  }
}

TEST(FitToSurface, UntanglingEndsWhereNothingHelps) {
  // Two spheres in one place stay so.
  const PolygonSoup one = test::octasphere_soup(1);
  const PolygonSoup two = test::joined(one, one);
  const MatX3i faces = triangles_of(two);
  MatX3 points = two.points;
  untangle(points, faces, {});
  EXPECT_LE((points - untangled_plainly(two.points, faces)).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_EQ(points.topRows(one.points.rows()), points.bottomRows(one.points.rows()));
}

TEST(FitToSurface, TakesBackWhatWouldCross) {
  // Two plates nearer to each other than the reach: feet on the wrong one must not tangle.
  PolygonSoup target = test::octasphere_soup(3), contour = target;
  contour.points *= 0.97;
  std::mt19937 random(4);
  std::uniform_real_distribution<double> u(-0.5, 0.5);
  for (Eigen::Index v = 0; v < target.points.rows(); ++v)  // a rough target
    target.points.row(v) *= 1 + u(random);
  const FittedSurface out = fit_to_surface(contour.points, triangles_of(contour), target.points,
                                           triangles_of(target), 0.6, {});
  const auto flags = self_intersecting_faces(out.points, out.faces);
  EXPECT_EQ(std::count(flags.begin(), flags.end(), 1), 0);
  EXPECT_GT(out.n_moved, 0);
  EXPECT_GT(out.n_kept, 0);
}

}  // namespace
}  // namespace littoral
