// What completion is made of: where a surface ends, patches over holes, orientation by parity.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <random>
#include <vector>

#include "broken_shapes.h"
#include "constants.h"
#include "methods/implicit/level_patch.h"
#include "methods/implicit/orient_soup.h"
#include "spatial/winding_number.h"
#include "test_meshes.h"

namespace littoral {
namespace {

using test::hemisphere;
using test::joined;
using test::part_of;
using test::pi;
using test::turned;

TEST(LevelPatch, CornersLieOnTheLevelAndCracksGetNone) {
  const PolygonSoup open = hemisphere(3, false);
  const MatX3i faces = triangles_of(open);
  const WindingNumber winding(open.points, faces);
  const auto inside = [&](const Vec3& x) { return winding(x, 1e9) - 0.5; };
  const auto rim = boundary_edges(open.points, faces);
  EXPECT_EQ(rim.size(), 32u);
  const LevelPatch patch = level_patch(inside, open.points, rim, 0.05, Task());
  EXPECT_TRUE(patch.complete);
  EXPECT_NEAR(patch.area, 3.1, 0.06);  // of the polygon
  EXPECT_LT(patch.points.col(2).cwiseAbs().maxCoeff(), 1e-3);
  for (Eigen::Index f = 0; f < patch.faces.rows(); ++f) {
    const Vec3 a = patch.points.row(3 * f), b = patch.points.row(3 * f + 1),
               c = patch.points.row(3 * f + 2);
    EXPECT_GE((b - a).cross(c - a)[2], -1e-9);  // outward is up
  }
  // A cut along the equator whose two sides stand a thousandth apart.
  PolygonSoup upper =
      part_of(test::octasphere_soup(3), [](int, const Vec3& c) { return c[2] > 0; });
  upper.points.col(2).array() += 1e-3;
  const PolygonSoup cut = joined(open, upper);
  const MatX3i both = triangles_of(cut);
  const WindingNumber around(cut.points, both);
  const auto cracks = boundary_edges(cut.points, both);
  EXPECT_EQ(cracks.size(), 64u);
  EXPECT_EQ(level_patch([&](const Vec3& x) { return around(x, 1e9) - 0.5; }, cut.points, cracks,
                        0.05, Task())
                .faces.rows(),
            0);
}

TEST(LevelPatch, LooksAtTheLevelSetAndNotAtAllOfTheBox) {
  const PolygonSoup open = hemisphere(3, false);
  const MatX3i faces = triangles_of(open);
  const WindingNumber winding(open.points, faces);
  const auto rim = boundary_edges(open.points, faces);
  const auto asked = [&](double spacing) {
    std::atomic<int> times = 0;
    const auto inside = [&](const Vec3& x) {
      ++times;
      return winding(x, 1e9) - 0.5;
    };
    const LevelPatch patch = level_patch(inside, open.points, rim, spacing, Task());
    // For each triangle a few: corners shared among cells, both sides of it, crossings.
    EXPECT_LT(times, 14 * patch.faces.rows()) << spacing << " " << patch.faces.rows();
    return patch.faces.rows();
  };
  EXPECT_GT(asked(0.025), 2 * asked(0.05));
}

TEST(LevelPatch, CoversASlotThatLiesAskewToTheCubesOnce) {
  // Between two long parallel edges the zero set is the plane through them, and only tips of cubes
  // reach through it.
  Eigen::Matrix3d frame;  // columns: across the slot, along it, normal
  frame.col(2) = Vec3(1, 1, 1).normalized();
  frame.col(0) = Vec3(1, -2, 0.3).cross(frame.col(2)).normalized();
  frame.col(1) = frame.col(2).cross(frame.col(0));
  const auto inside = [&](const Vec3& x) {
    const Vec3 q = frame.transpose() * x;
    const double seen = std::atan2(q[0] + 1, q[2]) - std::atan2(q[0] - 1, q[2]);  // of the slot
    return q[2] > 0 ? 0.5 - seen / (2 * pi) : -0.5 - seen / (2 * pi);
  };
  MatX3 points(4, 3);
  points << -1, -4, 0, -1, 4, 0, 1, -4, 0, 1, 4, 0;
  points = (points * frame.transpose()).eval();
  const LevelPatch patch = level_patch(inside, points, {{0, 1}, {2, 3}}, 0.12, Task());
  const MatX3 on_plane = patch.points * frame;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-0.7, 0.7);
  std::vector<Vec2> places(3000);
  for (Vec2& q : places) q = Vec2(place(random), 3 * place(random));
  std::sort(places.begin(), places.end(), [](const Vec2& p, const Vec2& q) { return p[0] < q[0]; });
  std::vector<int> covered(places.size(), 0);
  for (Eigen::Index f = 0; f < patch.faces.rows(); ++f) {
    const auto corners = on_plane.block<3, 2>(3 * f, 0).eval();
    const auto left_end = [](const Vec2& q, double x) { return q[0] < x; };
    const auto first =
        std::lower_bound(places.begin(), places.end(), corners.col(0).minCoeff(), left_end);
    for (auto q = first; q != places.end() && (*q)[0] <= corners.col(0).maxCoeff(); ++q) {
      int left = 0;
      for (int k = 0; k < 3; ++k) {
        const Vec2 a = corners.row(k), b = corners.row((k + 1) % 3);
        left += (b[0] - a[0]) * ((*q)[1] - a[1]) > (b[1] - a[1]) * ((*q)[0] - a[0]);
      }
      covered[q - places.begin()] += left == 3 || left == 0;
    }
  }
  for (std::size_t i = 0; i < places.size(); ++i) EXPECT_EQ(covered[i], 1) << places[i].transpose();
}

TEST(BoundaryEdges, AreThoseOfTheChain) {
  const PolygonSoup sphere = test::octasphere_soup(1);
  const auto of = [](const PolygonSoup& soup) {
    return boundary_edges(soup.points, triangles_of(soup)).size();
  };
  EXPECT_EQ(of(sphere), 0u);
  EXPECT_EQ(of(joined(sphere, sphere)), 0u);  // edges of four faces
  EXPECT_EQ(of(part_of(sphere, [](int f, const Vec3&) { return f != 0; })), 3u);
  EXPECT_EQ(of(turned(sphere, [](int f) { return f == 0; })), 3u);
  PolygonSoup loose;  // nothing shared but positions
  for (int f = 0; f < sphere.n_faces(); ++f)
    loose = joined(loose, part_of(sphere, [&](int g, const Vec3&) { return g == f; }));
  EXPECT_EQ(of(loose), 0u);
}

TEST(BoundaryEdges, CopiesAreFacesWithTheSameCornersInTheSameSense) {
  const PolygonSoup sphere = test::octasphere_soup(1);
  const auto left = [](const PolygonSoup& soup) {
    return without_copies(soup.points, triangles_of(soup));
  };
  EXPECT_EQ(left(sphere), triangles_of(sphere));
  EXPECT_EQ(left(joined(sphere, sphere)), triangles_of(sphere));  // by position; the first stay
  EXPECT_EQ(left(joined(sphere, test::reversed(sphere))).rows(), 2 * sphere.n_faces());
  PolygonSoup begun_elsewhere = sphere;
  const auto face = sphere.face(5);
  begun_elsewhere.add_face(std::array{face[2], face[0], face[1]});
  EXPECT_EQ(left(begun_elsewhere), triangles_of(sphere));
}

/// So many triangles by themselves with middles in a box about a place, and corners about these.
PolygonSoup crowd(int n, const Vec3& place, const Vec3& box, const Vec3& size) {
  PolygonSoup soup;
  soup.points = 0.5 * (MatX3::Random(3 * n, 3) * size.asDiagonal());
  const MatX3 middles = 0.5 * (MatX3::Random(n, 3) * box.asDiagonal());
  for (int f = 0; f < n; ++f) {
    const std::array<int, 3> corners{3 * f, 3 * f + 1, 3 * f + 2};
    for (const int v : corners) soup.points.row(v) += middles.row(f) + place.transpose();
    soup.add_face(corners);
  }
  return soup;
}

TEST(BoundaryEdges, LooseFacesInOneLineCountAsNothing) {
  const PolygonSoup sphere = test::octasphere_soup(1);
  const PolygonSoup strewn = joined(sphere, crowd(2000, {2, 0, 0}, {0, 0, 0}, {0, 0, 1}));
  EXPECT_TRUE(boundary_edges(strewn.points, triangles_of(strewn)).empty());
  const WindingNumber winding(strewn.points, triangles_of(strewn));
  EXPECT_TRUE(winding.exact());
  EXPECT_EQ(winding({0.1, 0.2, 0.3}), 1);
  EXPECT_EQ(winding({2, 0, 0.1}), 0);
  const PolygonSoup line = crowd(3, {0, 0, 0}, {0, 0, 0}, {1, 0, 0});
  EXPECT_EQ(WindingNumber(line.points, triangles_of(line))(Vec3(0.1, 0.2, 0.3)), 0);
  // A square whose diagonal has a corner on one side only: the face in one line closes the gap.
  PolygonSoup square;
  square.points.resize(5, 3);
  square.points << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0.5, 0.5, 0;
  for (const std::array<int, 3>& f : {std::array{0, 1, 2}, {0, 4, 3}, {4, 2, 3}, {0, 2, 4}})
    square.add_face(f);
  EXPECT_EQ(boundary_edges(square.points, triangles_of(square)).size(), 4u);
}

TEST(OrientSoup, CrowdsAndFacesWithoutAreaChangeNothing) {
  const PolygonSoup sphere = turned(test::octasphere_soup(3), [](int f) { return f < 64; });
  const PolygonSoup line = joined(sphere, crowd(3000, {2, 0, 0}, {0, 0, 0}, {0, 0, 1})),
                    tiny = joined(
                        sphere, crowd(3000, {2, 0, 0}, Vec3::Constant(1e-6), Vec3::Constant(1e-8)));
  for (const PolygonSoup& soup : {line, tiny}) {
    const OrientedSoup oriented = orient_soup(soup.points, triangles_of(soup), Task());
    EXPECT_NEAR(oriented.turned, 64.0 / 512, 0.01);
    EXPECT_NEAR(WindingNumber(soup.points, oriented.faces)(Vec3(0.1, 0, 0)), 1, 1e-4);
  }
}

TEST(OrientSoup, PlacesLieAllOverAPart) {
  // In place of one face of a sphere there is a tongue, through which lines pass nothing else:
  // first or last, it is one face of many.
  const PolygonSoup sphere = test::octasphere_soup(3);
  const int removed = 100;
  for (const bool last : {true, false}) {
    PolygonSoup soup;
    soup.points.resize(sphere.n_vertices() + 1, 3);
    soup.points << sphere.points, 3 * sphere.points.row(sphere.face(removed)[2]);
    const auto tongue = [&] {
      test::add_triangle(soup, sphere.face(removed)[0], sphere.face(removed)[1],
                         sphere.n_vertices());
    };
    if (!last) tongue();
    for (int f = 0; f < sphere.n_faces(); ++f)
      if (f != removed) soup.add_face(sphere.face(f));
    if (last) tongue();
    const OrientedSoup oriented = orient_soup(soup.points, triangles_of(soup), Task());
    EXPECT_EQ(oriented.faces.rows(), sphere.n_faces());
    EXPECT_EQ(oriented.turned, 0);
    EXPECT_GT(oriented.certainty, 0.95);
  }
}

TEST(OrientSoup, LeavesOutWallsAndSheetsAndCountsWhatItTurned) {
  const PolygonSoup sphere = test::octasphere_soup(3);
  PolygonSoup wall = test::grid_soup(4, 4);  // a square through the middle
  wall.points = (wall.points.array() - 0.5).matrix();
  wall.points.col(2).setConstant(0.013);
  const PolygonSoup with_wall = joined(sphere, wall);
  const OrientedSoup oriented = orient_soup(with_wall.points, triangles_of(with_wall), Task());
  EXPECT_EQ(oriented.faces.rows(), sphere.n_faces());
  EXPECT_NEAR(oriented.left_out, 1.0 / (1 + 4 * M_PI), 0.005);
  EXPECT_EQ(oriented.turned, 0);
  const PolygonSoup one = turned(sphere, [](int f) { return f < 64; });
  const OrientedSoup again = orient_soup(one.points, triangles_of(one), Task());
  EXPECT_NEAR(again.turned, 64.0 / 512, 0.01);
  EXPECT_NEAR(WindingNumber(one.points, again.faces)(Vec3(0.1, 0, 0)), 1, 1e-4);
  // Every line through a place on a closed surface tells: as few as there are, all of it is sure.
  for (const PolygonSoup& closed : {test::octasphere_soup(0), test::octasphere_soup(2)}) {
    const PolygonSoup inverse = turned(closed, [](int) { return true; });
    const OrientedSoup all = orient_soup(inverse.points, triangles_of(inverse), Task());
    EXPECT_NEAR(all.surely_turned, 1, 1e-12);
    EXPECT_EQ(all.certainty, 1);
  }
  EXPECT_EQ(orient_soup(wall.points, triangles_of(wall), Task()).faces.rows(), 0);
  EXPECT_EQ(orient_soup(MatX3(3, 3).setZero(), MatX3i::Zero(1, 3), Task()).faces.rows(), 0);
}

}  // namespace
}  // namespace littoral
