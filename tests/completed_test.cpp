// Distance to surfaces that are completed first: exact around closed ones, whatever their
// orientation, smooth across holes, and never silent about what is doubtful.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "api/space/sdf.h"
#include "base/parallel.h"
#include "broken_shapes.h"
#include "littoral/error.h"
#include "littoral/space.h"
#include "report_helpers.h"
#include "space_helpers.h"
#include "spatial/closest_on_triangle.h"
#include "spatial/grid_values.h"
#include "spatial/triangulate.h"
#include "spatial/winding_number.h"

namespace littoral {
namespace {

using test::hemisphere;
using test::joined;
using test::message_of;
using test::part_of;
using test::reversed;
using test::turned;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// What nobody has chosen anything for.
VecX by_default(const PolygonSoup& input, const Grid& grid, Report& report, bool flip = false) {
  SpaceRequest request;
  request.flip = flip;
  return grid_distance(input, grid, request, Task(), report);
}

VecX asked(const PolygonSoup& input, const MatX3& queries, Report& report, bool flip = false) {
  SpaceRequest request;
  request.flip = flip;
  return query_distance(input, queries, request, nullptr, Task(), report);
}

double brute_force(const PolygonSoup& soup, const Vec3& x) {
  const MatX3i faces = triangles_of(soup);
  double nearest = 1e300;
  for (Eigen::Index f = 0; f < faces.rows(); ++f) {
    Vec3 p[3];
    for (int k = 0; k < 3; ++k) p[k] = soup.points.row(faces(f, k)).transpose() - x;
    nearest = std::min(nearest, closest_on_triangle(p[0], p[1], p[2]).squared);
  }
  const double winding = winding_number_brute_force(soup.points, faces, x);
  return std::sqrt(nearest) * (winding > 0.5 ? -1 : 1);
}

double largest_error(const Grid& grid, const VecX& values, const PolygonSoup& truth) {
  double worst = 0;
  for (int k = 0; k < grid.n[2]; ++k)
    for (int j = 0; j < grid.n[1]; ++j)
      for (int i = 0; i < grid.n[0]; ++i)
        worst = std::max(worst, std::abs(values[static_cast<Eigen::Index>(grid.node(i, j, k))] -
                                         brute_force(truth, grid.point(i, j, k))));
  return worst;
}

/// Up to rounding: corners in another order.
void expect_same(const VecX& a, const VecX& b) { EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 1e-14); }

TEST(Completed, IsTheDefaultAndExactAroundClosedMeshes) {
  const Grid grid = test::cube_grid(7, 1.37);
  for (const PolygonSoup& shape :
       {test::torus_soup(24, 12), test::octasphere_soup(2),
        joined(test::box_soup({0.2, 0.3, 0.4}), test::octasphere_soup(2))}) {
    const PolygonSoup triangles = triangulate(shape);
    Report report, at_points;
    const VecX values = by_default(shape, grid, report);
    EXPECT_EQ(report.method, "auto");
    EXPECT_LT(largest_error(grid, values, triangles), 1e-12);
    const MatX3 queries = test::random_points(60, 1.4);
    const VecX there = asked(shape, queries, at_points);
    EXPECT_EQ(at_points.method, "auto");
    for (Eigen::Index i = 0; i < queries.rows(); ++i)
      EXPECT_NEAR(there[i], brute_force(triangles, queries.row(i)), 1e-12);
  }
}

TEST(Completed, SamplesOnGridsAreTheAnswersAtTheirNodes) {
  Grid grid = test::cube_grid(27, 1.31);
  grid.n[1] = 19;
  grid.spacing[1] *= 1.4;
  for (const PolygonSoup& shape : {test::off_centre_torus(), hemisphere(4, false)})
    for (const AnyMethod& method : {AnyMethod(), AnyMethod(WindingSign{})}) {
      const Sdf distance = signed_distance(shape, method);
      const VecX sampled = distance.sample(grid).values;
      EXPECT_LT((sampled - distance.at(grid_points(grid))).cwiseAbs().maxCoeff(), 1e-14);
    }
}

TEST(Completed, EnclosedSpaceIsInsideWhicheverWayAllNormalsPoint) {
  const PolygonSoup torus = test::off_centre_torus();
  const Grid grid = test::cube_grid(15, 1.2);
  Report fine, warned, quiet, trusted;
  const VecX values = by_default(torus, grid, fine);
  EXPECT_THAT(fine.warnings, IsEmpty());
  EXPECT_EQ(fine.status, "converged");
  expect_same(by_default(reversed(torus), grid, warned), values);
  EXPECT_THAT(warned.warnings, Contains(HasSubstr("count as reversed")));
  EXPECT_EQ(test::size_named(warned, "share of the area that bounds"), 1);
  // --flip takes the normals at their word.
  expect_same(by_default(torus, grid, quiet, true), -values);
  expect_same(by_default(reversed(torus), grid, trusted, true), values);
  EXPECT_THAT(trusted.warnings, IsEmpty());
}

TEST(Completed, HolesAreClosedByTheLevelOfTheWindingNumber) {
  // A planar loop is seen under half of all directions from its disc alone: the patch is flat.
  const Grid grid = test::cube_grid(33, 1.31);
  Report report;
  const VecX values = by_default(hemisphere(4, false), grid, report);
  const double h = grid.spacing[0];
  Report exact;
  const VecX truth = grid_distance(hemisphere(4, true), grid, {WindingSign{}}, Task(), exact);
  EXPECT_LT((values - truth).cwiseAbs().maxCoeff(), 0.05 * h);
  EXPECT_NEAR(test::size_named(report, "completed share of the zero set"), 1.0 / 3, 0.01);
  EXPECT_EQ(test::size_named(report, "share of sign changes without surface"), 0);
  EXPECT_THAT(report.warnings, IsEmpty());
  EXPECT_EQ(report.status, "converged");
}

TEST(CompletedSlow, DistanceIsSmoothAcrossHolesAndExactAwayFromThem) {
  const PolygonSoup whole = test::octasphere_soup(4);
  const PolygonSoup open = part_of(whole, [](int, const Vec3& c) {
    return c[0] + 0.4 * std::sin(5 * c[1]) < 0.6;  // a rim that is not flat
  });
  // Lines through the hole, near its middle and along its rim.
  constexpr int lines = 5, on_line = 1501;
  const double step = 1.2 / (on_line - 1);
  MatX3 places(lines * on_line, 3);
  for (int l = 0; l < lines; ++l)
    for (int i = 0; i < on_line; ++i)
      places.row(l * on_line + i) << 0.2 + step * i, 0.1 + 0.17 * l, 0.05 - 0.1 * l;
  Report across;
  const VecX all = asked(open, places, across);
  for (int l = 0; l < lines; ++l) {
    const auto values = all.segment(l * on_line, on_line);
    double jump = 0;
    for (int i = 1; i < on_line; ++i) jump = std::max(jump, std::abs(values[i] - values[i - 1]));
    EXPECT_LT(values.minCoeff(), 0);
    EXPECT_GT(values.maxCoeff(), 0);
    // A unit of the frame is twice the sphere's radius: patches are fine to 2 * .01.
    EXPECT_LT(jump, step + 0.1 * 0.02) << l;
  }
  const MatX3 queries = test::random_points(150, 1.5);
  Report report;
  const VecX values = asked(open, queries, report);
  int away = 0;
  for (Eigen::Index i = 0; i < queries.rows(); ++i) {
    if (queries(i, 0) > -0.2) continue;
    ++away;
    EXPECT_NEAR(values[i], brute_force(whole, queries.row(i)), 1e-12);
  }
  EXPECT_GT(away, 30);
}

TEST(Completed, SoupsAreOrientedByParityWhereTheirOrientationDisagrees) {
  const PolygonSoup torus = test::off_centre_torus();
  const Grid grid = test::cube_grid(15, 1.2);
  Report report;
  const VecX values = by_default(torus, grid, report);
  std::mt19937 random(3);
  const PolygonSoup mixed = turned(torus, [&](int) { return random() % 2 == 0; });
  const PolygonSoup doubled = joined(torus, reversed(torus));
  // A reversed patch bounds by its own winding number, the wrong way round.
  const PolygonSoup patched =
      turned(torus, [&](int f) { return torus.points(torus.face(f)[0], 0) > 0.55; });
  Report of_patched;
  expect_same(by_default(patched, grid, of_patched), values);
  EXPECT_THAT(of_patched.warnings, Contains(HasSubstr("orientation of faces disagrees")));
  // Two bodies, one of them inside out.
  PolygonSoup other = test::octasphere_soup(2);
  other.points = (0.2 * other.points).rowwise() + Eigen::RowVector3d(0.1, -0.9, 0.8);
  const PolygonSoup good = joined(torus, other), odd = joined(torus, reversed(other));
  Report of_mixed, of_doubled, of_good, of_odd;
  expect_same(by_default(mixed, grid, of_mixed), values);
  EXPECT_THAT(of_mixed.warnings, Contains(HasSubstr("orientation of faces disagrees")));
  EXPECT_GT(test::size_named(of_mixed, "certainty of the orientation"), 0.99);
  expect_same(by_default(doubled, grid, of_doubled), values);
  EXPECT_THAT(of_doubled.warnings, Contains(HasSubstr("faces are double")));
  expect_same(by_default(odd, grid, of_odd), by_default(good, grid, of_good));
  EXPECT_THAT(of_good.warnings, IsEmpty());
  EXPECT_FALSE(of_odd.warnings.empty());
}

TEST(Completed, FacesThatAreThereTwiceCountOnce) {
  const PolygonSoup open = hemisphere(2, false), sphere = test::octasphere_soup(2);
  for (const PolygonSoup& soup : {open, sphere}) {
    // Some, among them faces on the rim; and all of them.
    const PolygonSoup some =
        joined(soup, part_of(soup, [](int f, const Vec3&) { return f % 7 == 0; }));
    const Grid grid = test::cube_grid(17, 1.31);
    Report of_once, of_some, of_all;
    const VecX values = by_default(soup, grid, of_once);
    expect_same(by_default(some, grid, of_some), values);
    expect_same(by_default(joined(soup, soup), grid, of_all), values);
    for (const Report* report : {&of_once, &of_some, &of_all}) {
      EXPECT_THAT(report->warnings, IsEmpty());
      EXPECT_EQ(test::size_named(*report, "free edges"), test::size_named(of_once, "free edges"));
    }
  }
}

TEST(Completed, CopiesOfFacesThatAreLeftOutAreCounted) {
  const PolygonSoup open = hemisphere(2, false);
  for (const int copies : {1, 2, 5}) {
    Report report;
    const auto first = part_of(open, [&](int f, const Vec3&) { return f < copies; });
    by_default(joined(open, first), test::cube_grid(9, 1.31), report);
    EXPECT_EQ(test::size_named(report, "copies of faces left out of the sign"), copies);
  }
}

TEST(Completed, FacesThatAPartNeedsToBeClosedStayThoughTheyAreCopies) {
  // A tetrahedron inside a sphere that shares one of its faces; the sphere has a hole elsewhere.
  PolygonSoup both = part_of(test::octasphere_soup(2), [](int f, const Vec3&) { return f != 9; });
  const std::vector<int> base(both.face(0).begin(), both.face(0).end());
  both.points.conservativeResize(both.n_vertices() + 1, 3);
  const int apex = both.n_vertices() - 1;
  both.points.row(apex).setZero();
  both.add_face(base);
  for (int k = 0; k < 3; ++k)
    both.add_face(std::array{base[std::size_t((k + 1) % 3)], base[std::size_t(k)], apex});
  Report report;
  by_default(both, test::cube_grid(9, 1.31), report);
  EXPECT_EQ(test::size_named(report, "free edges"), 3);
  for (const auto& [name, value] : report.sizes)
    EXPECT_NE(name, "copies of faces left out of the sign");
}

TEST(Completed, SaysWhatIsDoubtful) {
  const Grid grid = test::cube_grid(15, 1.2);
  const PolygonSoup sheet = test::grid_soup(8, 8);
  for (const PolygonSoup& nothing : {sheet, joined(sheet, reversed(sheet))}) {
    Report report;
    const VecX values = by_default(nothing, grid, report);
    EXPECT_EQ(report.status, "uncertain");
    EXPECT_THAT(report.warnings, Contains(HasSubstr("encloses nothing")));
    if (test::size_named(report, "free edges") > 0) {
      EXPECT_EQ(test::size_named(report, "patch triangles"), 0);
    }
    EXPECT_GE(values.minCoeff(), 0);
  }
  // A sphere with a fin as large as itself.
  PolygonSoup fin = test::grid_soup(8, 8);
  fin.points *= 2;
  Report finned;
  by_default(joined(test::octasphere_soup(3), fin), grid, finned);
  EXPECT_EQ(finned.status, "uncertain");
  EXPECT_THAT(finned.warnings, Contains(HasSubstr("outside on both sides")));
  // A sphere within a sphere, both outward.
  PolygonSoup inner = test::octasphere_soup(3);
  inner.points *= 0.5;
  Report nested;
  by_default(joined(test::octasphere_soup(3), inner), grid, nested);
  EXPECT_EQ(nested.status, "converged");
  EXPECT_NEAR(test::size_named(nested, "share of the area inside on both sides"), 0.2, 0.01);
  EXPECT_THAT(nested.warnings, Contains(HasSubstr("walls within")));
}

TEST(Completed, ThroughTetsIsExactAtTheirVertices) {
  const PolygonSoup ball = test::octasphere_soup(2);
  const Grid grid = test::cube_grid(12, 1.4);
  Report report;
  const SpaceAnswer answer = tet_distance(ball, grid, {}, {}, Task(), report);
  EXPECT_EQ(report.method, "auto");
  EXPECT_EQ(report.domain, "tet lattice");
  EXPECT_LT(largest_error(grid, answer.at_nodes, ball), 1e-12);
  ASSERT_EQ(answer.tets.values.size(), answer.tets.mesh.n_vertices());
  for (Eigen::Index v = 0; v < answer.tets.values.size(); v += 17)
    EXPECT_NEAR(answer.tets.values[v], brute_force(ball, answer.tets.mesh.points.row(v)), 1e-12);
}

TEST(Completed, RefusesInputsWithoutExtent) {
  const Grid grid = test::cube_grid(8, 1);
  const auto said = [&](const PolygonSoup& input) {
    return message_of([&] {
      Report report;
      by_default(input, grid, report);
    });
  };
  EXPECT_THAT(said({}), HasSubstr("no faces"));
  PolygonSoup flat;
  flat.points = MatX3::Zero(3, 3);
  flat.points.col(0) << 0, 0.5, 0.9;
  test::add_triangle(flat, 0, 1, 2);
  EXPECT_THAT(said(flat), HasSubstr("area"));
  flat.points(0, 0) = std::nan("");
  EXPECT_THAT(said(flat), HasSubstr("finite"));
}

TEST(CompletedSlow, DoesNotDependOnThreadsPlaceOrScale) {
  const PolygonSoup open =
      part_of(test::off_centre_torus(), [](int f, const Vec3&) { return f % 37 > 3; });
  const Grid grid = test::cube_grid(17, 1.2);
  Report report;
  const VecX values = by_default(open, grid, report);
  set_thread_count(1);
  Report again;
  EXPECT_EQ(by_default(open, grid, again), values);
  set_thread_count(0);
  PolygonSoup moved = open;
  const Vec3 shift(512, -1024, 256);
  moved.points = (4 * open.points).rowwise() + shift.transpose();
  Grid there = grid;
  there.origin = 4 * grid.origin + shift;
  there.spacing *= 4;
  EXPECT_LT((by_default(moved, there, report) / 4 - values).cwiseAbs().maxCoeff(),
            1e-3 * grid.spacing[0]);
}

TEST(Completed, RandomSoupsGiveFiniteDistancesNoLargerThanTheNearestFace) {
  std::mt19937 random(11);
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  for (int round = 0; round < 12; ++round) {
    PolygonSoup soup;
    const int n = 4 + below(9);
    soup.points.resize(n, 3);
    // Often on a lattice, so that faces meet, repeat and degenerate.
    for (double& x : soup.points.reshaped()) x = round % 3 == 0 ? below(3) : below(1000) / 400.0;
    soup.points *= std::pow(10.0, below(17) - 8);
    for (int f = 1 + below(16); f > 0; --f) {
      const int a = below(n), b = below(n), c = below(n);
      test::add_triangle(soup, a, b, c);
      if (below(4) == 0) test::add_triangle(soup, c, b, a);
    }
    const double size =
        (soup.points.colwise().maxCoeff() - soup.points.colwise().minCoeff()).maxCoeff();
    MatX3 queries = test::random_points(20, 2, round);
    queries = (size * queries).rowwise() + soup.points.row(0);
    Report report, exact;
    VecX values, nearest;
    try {
      values = asked(soup, queries, report);
      nearest = query_distance(soup, queries, {WindingSign{}}, nullptr, Task(), exact).cwiseAbs();
    } catch (const InputError&) {
      continue;  // no area
    }
    ASSERT_TRUE(values.allFinite()) << round;
    EXPECT_LE((values.cwiseAbs() - nearest).maxCoeff(), 1e-12 * size) << round;
    EXPECT_TRUE(report.status == "converged" || !report.warnings.empty()) << round;
  }
}

TEST(Completed, ConfidenceIsThatOfTheSidesThatWereSettled) {
  // Turned faces are missed by nothing: signs are as sure as those of the whole.
  const PolygonSoup torus = test::off_centre_torus();
  const PolygonSoup patched =
      turned(torus, [&](int f) { return torus.points(torus.face(f)[0], 0) > 0.55; });
  const MatX3 places = test::random_points(200, 1.2);
  EXPECT_GT(signed_distance(patched).confidence(places).minCoeff(), 1 - 1e-9);
  // In the middle of a disc that is missing half of all directions are.
  const Sdf open = signed_distance(hemisphere(4, false));
  EXPECT_LT(open.confidence(Vec3::Zero().transpose())[0], 0.02);
  EXPECT_GT(open.confidence(Vec3(0, 0, -3).transpose())[0], 0.9);
}

TEST(Completed, AnswersThroughThePublicHeader) {
  const Sdf f = signed_distance(hemisphere(3, false));
  EXPECT_EQ(f.report().method, "auto");
  EXPECT_NEAR(f(Vec3(0, 0, 0.3)), 0.3, 1e-3);
  EXPECT_NEAR(f(Vec3(0, 0, -0.2)), -0.2, 1e-3);
  EXPECT_NEAR(f.gradient(Vec3(0.1, 0, 0.4))[2], 1, 1e-2);
  const Vec3 top = test::octasphere_soup(3).points.row(5);
  EXPECT_NEAR(signed_distance(reversed(hemisphere(3, false))).gradient(top).dot(top), 1, 0.1);
}

}  // namespace
}  // namespace littoral
