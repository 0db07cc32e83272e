// Meshes, soups and clouds as oriented samples.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "base/groups.h"
#include "domain/cloud/cloud_normals.h"
#include "littoral/error.h"
#include "space_helpers.h"
#include "spatial/places.h"

namespace littoral {
namespace {

using test::message_of;
using ::testing::HasSubstr;

constexpr double never = std::numeric_limits<double>::infinity();

TEST(SpaceSamples, FacesKeepAreaAndVectorArea) {
  Report report;
  const PolygonSoup box = test::box_soup({1, 2, 3});
  for (const double side : {never, 0.7}) {
    const OrientedPoints s = sample_faces(box, side, report);
    EXPECT_NEAR(s.areas.sum(), 8 * (2 + 3 + 6), 1e-9);
    EXPECT_LT((s.normals.transpose() * s.areas).norm(), 1e-9);
    EXPECT_GT((s.points.array() * s.normals.array()).rowwise().sum().minCoeff(), 0.9);
  }
  EXPECT_EQ(sample_faces(box, never, report).size(), 12);
  EXPECT_LT(sample_faces(box, 0.7, report).areas.maxCoeff(), 0.7 * 0.7 / 2);
}

TEST(SpaceSamples, PartsOfANeedleHaveAreaOrAreLeftOut) {
  // Corners on a line but for rounding, which leaves nothing of some parts; and one with area.
  PolygonSoup needle;
  needle.points.resize(23, 3);
  needle.points.row(0) << 0, 0, 1;
  needle.points.row(1) << -0.50000000000000044, -0.86602540378443837, 0;
  needle.points.row(2) << 1, 0, 0;
  needle.add_face(std::array{0, 1, 2});
  for (int v = 3; v < 23; ++v) {
    needle.points.row(v) << -0.25000000000000022, -0.43301270189221919 + 5.6e-17 * (v - 13), 0.5;
    needle.add_face(std::array{0, 1, v});
  }
  for (const double side : {0.4, 0.2, 0.1, 0.05}) {
    Report report;
    for (const auto count : {SamplesPerTriangle::one, SamplesPerTriangle::three})
      EXPECT_GT(sample_faces(needle, side, report, count).areas.minCoeff(), 0);
  }
}

TEST(SpaceSamples, OneFaceWithoutAreaIsToldOf) {
  PolygonSoup box = test::box_soup({1, 2, 3});
  Report report;
  sample_faces(box, never, report);
  EXPECT_THAT(report.warnings, testing::IsEmpty());
  box.add_face(std::array{0, 1, 1});
  EXPECT_EQ(sample_faces(box, never, report).size(), 12);
  ASSERT_EQ(report.warnings.size(), 1u);
  EXPECT_THAT(report.warnings[0].text, HasSubstr("1 face without area"));
}

TEST(SpaceSamples, LongTrianglesThatTakeTooManySamplesAreToldOfAtOnce) {
  // What is as long as 2^26 sides takes more samples than that, but only if it has an area.
  const double side = std::ldexp(1, -26);
  const auto sampled = [&](double length, int copies, double width, int turn) {
    PolygonSoup soup = test::box_soup({side / 4, side / 4, side / 4});
    for (int i = 0; i < copies; ++i) {
      const int n = soup.n_vertices();
      soup.points.conservativeResize(n + 3, 3);
      soup.points.bottomRows(3) << 0, 0, 0, length, 0, 0, length / 2, width, 0;
      test::add_triangle(soup, n + turn, n + (turn + 1) % 3, n + (turn + 2) % 3);
    }
    Report report;
    return message_of([&] { sample_faces(soup, side, report); });
  };
  for (int turn = 0; turn < 3; ++turn) {
    EXPECT_THAT(sampled(1.01, 1, 1e-9, turn), HasSubstr("67108864 samples")) << turn;
    EXPECT_THAT(sampled(0.51, 2, 1e-9, turn), HasSubstr("67108864 samples")) << turn;
    EXPECT_EQ(sampled(1.01, 2, 0, turn), "no error") << turn;
  }
}

TEST(SpaceSamples, SpacingIsTheSideOfEvenTriangles) {
  Report report;
  PolygonSoup one;
  one.points.resize(3, 3);
  one.points << 0, 0, 0, 2, 0, 0, 1, std::sqrt(3.0), 0;
  test::add_triangle(one, 0, 1, 2);
  EXPECT_NEAR(sample_spacing(sample_faces(one, never, report)), 2, 1e-12);
}

TEST(SpaceSamples, SaysWhatIsWrongWithAMesh) {
  Report report;
  PolygonSoup soup = test::octasphere_soup(0);
  EXPECT_THAT(message_of([&] { sample_faces(PolygonSoup(), never, report); }),
              HasSubstr("no faces"));
  PolygonSoup flat = soup;
  flat.points.col(2).setZero();
  flat.points.col(1).setZero();
  EXPECT_THAT(message_of([&] { sample_faces(flat, never, report); }), HasSubstr("has any area"));
  soup.points(4, 1) = std::nan("");
  EXPECT_THAT(message_of([&] { sample_faces(soup, never, report); }), HasSubstr("vertex 4"));
}

TEST(SpaceSamples, CloudAreasAreThoseOfTheirCells) {
  // A square lattice: every interior cell is a unit square.
  PolygonSoup cloud;
  cloud.points.resize(100, 3);
  cloud.normals.resize(100, 3);
  for (int i = 0; i < 100; ++i) {
    cloud.points.row(i) << i % 10, i / 10, 0;
    cloud.normals.row(i) << 0, 0, 5;
  }
  Report report;
  const OrientedPoints s = sample_cloud(cloud, report);
  EXPECT_NEAR(s.areas[55], 1, 1e-9);
  EXPECT_EQ(s.normals(3, 2), 1);
  EXPECT_GT(s.areas.minCoeff(), 0.1);
  // Each point four times: the same surface, a quarter of the area each.
  PolygonSoup four;
  four.points = cloud.points.replicate(4, 1);
  four.normals = cloud.normals.replicate(4, 1);
  EXPECT_NEAR(sample_cloud(four, report).areas[155], 0.25, 1e-9);
  // Places that differ by rounding are one.
  four.points.bottomRows(200).col(0).array() += 1e-13;
  EXPECT_NEAR(sample_cloud(four, report).areas[155], 0.25, 1e-9);
}

TEST(PointsByPlace, AreInTheOrderOfTheFirstThere) {
  MatX3 points(6, 3);
  points << 1, 0, 0, 0, 0, 5, 1, 0, 0, 1, 0, 1e-300, 0, -0.0, 5, 1, 0, 0;
  const Groups<int> places = points_by_place(points);
  EXPECT_EQ(places.begin, (std::vector{0, 3, 5, 6}));
  EXPECT_EQ(places.members, (std::vector{0, 2, 5, 1, 4, 3}));
  EXPECT_EQ(points_by_place(MatX3(0, 3)).begin, std::vector{0});
}

TEST(SpaceSamples, PointsAtOnePlaceShareTheCellItHasByItself) {
  // Also where there are more of them than neighbours are asked for at first, or not equally many.
  PolygonSoup cloud;
  cloud.points = test::random_points(60, 1);
  cloud.points.col(2) *= 0.01;
  cloud.normals = Vec3::UnitZ().transpose().replicate(60, 1);
  Report report;
  const VecX once = sample_cloud(cloud, report).areas;
  for (const std::array<int, 2> copies : {std::array{2, 2}, {4, 4}, {1, 70}, {300, 500}}) {
    std::vector<int> place;
    for (int i = 0; i < 60; ++i)
      place.insert(place.end(), std::size_t(copies[std::size_t(i) % 2]), i);
    PolygonSoup many;
    many.points = cloud.points(place, Eigen::all);
    many.normals = cloud.normals(place, Eigen::all);
    const VecX areas = sample_cloud(many, report).areas;
    for (std::size_t i = 0; i < place.size(); ++i)
      EXPECT_NEAR(areas[Eigen::Index(i)] * copies[std::size_t(place[i] % 2)], once[place[i]],
                  1e-9 * once[place[i]])
          << copies[1] << " copies of " << place[i];
  }
}

TEST(SpaceSamples, CellsAtTheRimOfACloudEndAtADisc) {
  // A regular polygon of 12 corners at the median distance of up to six neighbours stands for the
  // disc; its sector beside an axis, up to half a unit from the axis, has this area.
  const auto sector = [](double radius) { return 0.5 * radius - 0.25 * (1 - std::sqrt(0.75)); };
  const auto lattice = [](int n) {
    PolygonSoup cloud;
    cloud.points.resize(n * n, 3);
    cloud.normals.resize(n * n, 3);
    for (int i = 0; i < n * n; ++i) {
      cloud.points.row(i) << i % n, i / n, 0;
      cloud.normals.row(i) << 0, 0, 1;
    }
    return cloud;
  };
  Report report;
  const OrientedPoints s = sample_cloud(lattice(10), report);
  // A corner: two neighbours at 1, the third at the diagonal. A quarter of the disc, two sectors
  // and the quarter of a square. A side: the third is at 1; two sectors outside, half a square.
  const double corner = 1.5 + 2 * sector(std::sqrt(2)) + 0.25;
  for (const int i : {0, 9, 90, 99}) EXPECT_NEAR(s.areas[i], corner, 1e-9);
  for (const int i : {1, 10, 29, 95}) EXPECT_NEAR(s.areas[i], 2 * sector(1) + 0.5, 1e-9);
  // At the end of a row: of three neighbours the second counts, of two the first.
  for (const int n : {3, 4}) {
    PolygonSoup row = lattice(n);
    row.points.conservativeResize(n, 3);
    row.normals.conservativeResize(n, 3);
    const double radius = n - 2;
    EXPECT_NEAR(sample_cloud(row, report).areas[0], 1.5 * radius * radius + 2 * sector(radius),
                1e-9);
  }
}

TEST(SpaceSamples, AreaOfASphereComesOut) {
  const OrientedPoints exact = test::sphere_samples(4);
  PolygonSoup cloud;
  cloud.points = exact.points;
  cloud.normals = exact.normals;
  Report report;
  EXPECT_NEAR(sample_cloud(cloud, report).areas.sum(), 4 * M_PI, 0.03 * 4 * M_PI);
}

TEST(SpaceSamples, SaysWhatIsWrongWithACloud) {
  Report report;
  const auto message = [&](const PolygonSoup& cloud) {
    return message_of([&] { sample_cloud(cloud, report); });
  };
  PolygonSoup cloud;
  EXPECT_THAT(message(cloud), HasSubstr("no points"));
  cloud.points = test::random_points(20, 1);
  EXPECT_THAT(message(cloud), HasSubstr("estimate-normals"));
  cloud.normals = MatX3::Zero(20, 3);
  EXPECT_THAT(message(cloud), HasSubstr("not zero"));
  cloud.normals.setOnes();
  cloud.points(7, 0) = std::nan("");
  EXPECT_THAT(message(cloud), HasSubstr("point 7"));
  cloud.points.setOnes();
  EXPECT_THAT(message(cloud), HasSubstr("three different places"));
}

TEST(SpaceSamples, PointsWithoutNormalAreLeftOutWithAWarning) {
  Report report;
  PolygonSoup cloud;
  cloud.points = test::random_points(20, 1);
  cloud.normals = MatX3::Ones(20, 3);
  cloud.normals.row(3).setZero();
  cloud.normals(4, 1) = std::nan("");
  EXPECT_EQ(sample_cloud(cloud, report).size(), 18);
  ASSERT_EQ(report.warnings.size(), 1u);
  EXPECT_THAT(report.warnings[0], HasSubstr("2 points"));
}

TEST(SpaceSamples, EstimatedNormalsPointOutOfSphereAndTorus) {
  const MatX3 sphere = test::sphere_samples(4).points;
  const MatX3 n = estimate_normals(sphere, Task());
  EXPECT_GT((n.array() * sphere.array()).rowwise().sum().minCoeff(), 0.95);

  const PolygonSoup torus = test::torus_soup(60, 30);
  const MatX3 m = estimate_normals(torus.points, Task());
  int outward = 0;
  for (int i = 0; i < torus.n_vertices(); ++i) {
    const Vec3 p = torus.points.row(i);
    const Vec3 ring = Vec3(p[0], p[1], 0).normalized();
    outward += m.row(i).dot((p - ring).transpose()) > 0 ? 1 : 0;
  }
  EXPECT_EQ(outward, torus.n_vertices());
}

}  // namespace
}  // namespace littoral
