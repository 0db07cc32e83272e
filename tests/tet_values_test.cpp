// Values at sources in tets that distance is counted from.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "api/tet/tet_domain.h"
#include "littoral/error.h"
#include "one_call.h"
#include "space_helpers.h"
#include "tet_helpers.h"

namespace littoral {
namespace {

using testing::HasSubstr;

VecX counted(const TetMesh& mesh, const TetSources& sources, const AnyMethod& method = {}) {
  Report report;
  return test::tet_mesh_distance(mesh, sources, method, report);
}

/// One surface after another, each with a value.
void add_valued(TetSources& sources, const PolygonSoup& surface, double value) {
  PolygonSoup& all = sources.surface;
  const int first = all.n_vertices();
  all.points.conservativeResize(first + surface.n_vertices(), 3);
  all.points.bottomRows(surface.n_vertices()) = surface.points;
  for (int f = 0; f < surface.n_faces(); ++f) {
    std::vector<int> corners;
    for (const int v : surface.face(f)) corners.push_back(first + v);
    all.add_face(corners);
    sources.values.push_back(value);
  }
}

TetSources two_planes(double low, double high, double at_low, double at_high, int n) {
  TetSources sources;
  add_valued(sources, test::square_at(low, n), at_low);
  add_valued(sources, test::square_at(high, n), at_high);
  return sources;
}

TEST(TetValues, OneValueOfAllIsAddedByEveryMethod) {
  const TetMesh mesh = test::tet_box(3);
  TetSources vertices{{}, {5, 40}}, square{test::square_at(0.5, 3), {}}, boundary;
  boundary.boundary = true;
  for (const MethodInfo& info : Registry<TetDomain>::instance().infos())
    for (const TetSources& zero : {vertices, square, boundary}) {
      TetSources four = zero;
      four.values = {4};
      const VecX a = counted(mesh, zero, AnyMethod::named(info.name));
      const VecX b = counted(mesh, four, AnyMethod::named(info.name));
      EXPECT_EQ((a.array() + 4).matrix(), b) << info.name;
    }
}

TEST(TetValues, FromVerticesTheDefaultIsTheLeastOfValuePlusDistance) {
  TetMesh mesh = test::tet_box(5);
  mesh.points *= 8;  // values have the unit of the mesh
  const int a = test::tet_vertex_at(mesh, {0, 0, 0}), b = test::tet_vertex_at(mesh, {8, 8, 8});
  TetSources sources{{}, {a, b, b}};
  sources.values = {1, -2.5, 7};
  const VecX phi = counted(mesh, sources);
  const auto least = [&](const Vec3& x) {
    return std::min(1 + x.norm(), -2.5 + (x - Vec3::Constant(8)).norm());
  };
  EXPECT_LT(test::tet_errors(mesh, phi, least).largest, 1e-12);
  sources.boundary = true;
  sources.vertices = {test::tet_vertex_at(mesh, {3.2, 4.8, 4.8})};
  sources.values = {-1, 0.5};
  const VecX both = counted(mesh, sources);
  const auto nearer = [&](const Vec3& x) {
    return std::min(-1 + (x - Vec3(3.2, 4.8, 4.8)).norm(),
                    0.5 + std::min(x.minCoeff(), 8 - x.maxCoeff()));
  };
  EXPECT_LT(test::tet_errors(mesh, both, nearer).largest, 1e-12);
}

TEST(TetValues, ClosedSurfacesCountUpOutsideAndDownInside) {
  const TetMesh mesh = test::tet_box(8);
  const Vec3 half(0.15, 0.1, 0.15), a(0.3, 0.5, 0.4), b(0.72, 0.5, 0.6);
  TetSources sources;
  for (const auto& [centre, value] : {std::pair(a, 0.06), std::pair(b, -0.03)}) {
    PolygonSoup box = test::box_soup(half);
    box.points.rowwise() += centre.transpose();
    add_valued(sources, box, value);
  }
  const VecX phi = counted(mesh, sources);
  const auto exact = [&](const Vec3& x) {
    const double to_a = test::box_distance(x - a, half), to_b = test::box_distance(x - b, half);
    return to_a > 0 && to_b > 0 ? std::min(0.06 + to_a, -0.03 + to_b)
                                : std::max(0.06 - std::abs(to_a), -0.03 - std::abs(to_b));
  };
  EXPECT_LT(test::tet_errors(mesh, phi, exact).largest, 1e-12);
}

TEST(TetValues, HeatGivesLevelSetsOfOneFunctionBack) {
  const int n = 6;
  const TetMesh mesh = test::tet_box(n);
  const TetSources planes = two_planes(0.27, 0.71, 1.27, 1.71, 9);
  for (const char* constraint : {"none", "zero-set", "soft"}) {
    const VecX phi =
        counted(mesh, planes, AnyMethod::named("signed-heat", {{"constraint", constraint}}));
    EXPECT_LT((phi - (mesh.points.col(0).array() + 1).matrix()).cwiseAbs().maxCoeff(), 3e-3)
        << constraint;
  }
}

// Directions are those of x everywhere, so that the function nearest to them is linear between.
TEST(TetValues, ASlabWithValuesAtItsFacesIsLinearBetween) {
  const int n = 8;
  TetMesh mesh = test::tet_box(n);
  const TetSources slab = two_planes(0.25, 0.75, 0, 0.8, n);
  const auto profile = [](double x) {
    return x < 0.25 ? x - 0.25 : x > 0.75 ? 0.8 + x - 0.75 : 1.6 * (x - 0.25);
  };
  const VecX phi = counted(mesh, slab, SpaceSignedHeat{});
  EXPECT_LT(test::tet_errors(mesh, phi, [&](const Vec3& x) { return profile(x[0]); }).largest,
            2e-3);
  // The same on each of several parts, one of them without sources of the second value.
  mesh = test::copies(mesh, 2, {0, 3, 0});
  TetSources apart = slab;
  PolygonSoup moved = test::square_at(0.5, n);
  moved.points.col(1).array() += 3;
  add_valued(apart, moved, -0.2);
  const VecX parts = counted(mesh, apart, SpaceSignedHeat{});
  const auto both = [&](const Vec3& x) { return x[1] < 2 ? profile(x[0]) : x[0] - 0.7; };
  EXPECT_LT(test::tet_errors(mesh, parts, both).largest, 2e-3);
}

// For planes a distance L apart whose values are e too far apart, 1/2 k^2 L + w a^2 / h with
// k L = e - 2 a, what the slope has too much and the values miss, is least at e / a = 2 + w L / h.
TEST(TetValues, WhatAPenaltyLeavesIsInverseToItsWeight) {
  const int n = 8;
  const TetMesh mesh = test::tet_box(n);
  const TetSources slab = two_planes(0.25, 0.75, 0, 0.8, n);
  const int at = test::tet_vertex_at(mesh, {0.25, 0.5, 0.5});
  const auto missed = [&](double weight) {
    SpaceSignedHeat soft;
    soft.constraint = SpaceConstraint::soft;
    soft.soft = weight;
    return 0.3 / counted(mesh, slab, soft)[at] - 2;
  };
  const double one = missed(1), four = missed(4);
  EXPECT_NEAR(four / one, 4, 0.25);
  EXPECT_GT(one, 2);  // L / h, h about the edges' mean, 1/8 to sqrt(3)/8
  EXPECT_LT(one, 4.5);
}

TEST(TetValues, HeatOfVerticesMeetsWhereValuePlusDistanceAgree) {
  const TetMesh mesh = test::tet_box(12);
  const int a = test::tet_vertex_at(mesh, {0.25, 0.5, 0.5});
  const int b = test::tet_vertex_at(mesh, {0.75, 0.5, 0.5});
  TetSources sources{{}, {a, b}};
  sources.values = {0, 0.25};
  const VecX phi = counted(mesh, sources, SpaceSignedHeat{});
  EXPECT_NEAR(phi[a], 0, 1e-3);
  EXPECT_NEAR(phi[b], 0.25, 1e-3);
  const auto exact = [](const Vec3& x) {
    return std::min((x - Vec3(0.25, 0.5, 0.5)).norm(), 0.25 + (x - Vec3(0.75, 0.5, 0.5)).norm());
  };
  EXPECT_LT(test::tet_errors(mesh, phi, exact).mean, 0.045);
  sources.values = {0, 0};
  const VecX same = counted(mesh, sources, SpaceSignedHeat{});
  EXPECT_GT(test::tet_errors(mesh, same, exact).mean, 0.06);
}

// Arrival times of one function at many vertices. A solve for each would be 48 and err by 0.068.
TEST(TetValues, HeatOfManyValuesTakesEightSolves) {
  const int n = 12;
  const TetMesh mesh = test::tet_box(n);
  const Vec3 a(0.2, 0.3, 0.25), b(0.8, 0.6, 0.7);
  const auto arrival = [&](const Vec3& x) {
    return std::min((x - a).norm(), 0.1 + (x - b).norm());
  };
  TetSources sources;
  for (int i = 0; i < 50; ++i) {
    sources.vertices.push_back((37 * i + 5) % mesh.n_vertices());
    sources.values.push_back(arrival(mesh.points.row(sources.vertices.back())));
  }
  const auto exact = [&](const Vec3& x) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < sources.values.size(); ++i)
      least = std::min(
          least, sources.values[i] + (x - mesh.points.row(sources.vertices[i]).transpose()).norm());
    return least;
  };
  Report report;
  const VecX phi = test::tet_mesh_distance(mesh, sources, SpaceSignedHeat{}, report);
  EXPECT_THAT(report.iterations, testing::Contains(testing::Pair("heat solves", 8)));
  EXPECT_LT(test::tet_errors(mesh, phi, exact).mean, 0.068);
  // Only their differences count.
  TetSources later = sources;
  for (double& value : later.values) value += 1000;
  Report of_later;
  const VecX shifted = test::tet_mesh_distance(mesh, later, SpaceSignedHeat{}, of_later);
  EXPECT_THAT(of_later.iterations, testing::Contains(testing::Pair("heat solves", 8)));
  EXPECT_LT((shifted.array() - 1000 - phi.array()).abs().maxCoeff(), 1e-6);
  // Values that no range of numbers holds together take a solve of their own.
  sources.values.back() = 1e5;
  sources.values.front() = 1e6;
  Report again;
  const VecX apart = test::tet_mesh_distance(mesh, sources, SpaceSignedHeat{}, again);
  EXPECT_THAT(again.iterations, testing::Contains(testing::Pair("heat solves", 10)));
  EXPECT_TRUE(apart.allFinite());
}

TEST(TetValues, WhatIsShadowedIsToldOf) {
  TetMesh mesh = test::tet_box(4);
  mesh.points *= 2;
  const int a = test::tet_vertex_at(mesh, {0, 1, 1}), b = test::tet_vertex_at(mesh, {1, 1, 1});
  const auto warnings = [&](TetSources sources, double value) {
    const bool planes = sources.surface.n_faces() > 0;
    sources.values.assign(planes ? 64 : 2, 0);
    std::fill(sources.values.begin() + (planes ? 32 : 1), sources.values.end(), value);
    Report report;
    test::tet_mesh_distance(mesh, sources, SpaceSignedHeat{}, report);
    return std::vector<std::string>(report.warnings.begin(), report.warnings.end());
  };
  TetSources planes;
  add_valued(planes, test::square_at(0.25, 4), 0);
  add_valued(planes, test::square_at(0.75, 4), 0);
  planes.surface.points *= 2;
  for (const TetSources& sources : {TetSources{{}, {a, b}}, planes}) {  // 1 apart
    EXPECT_THAT(warnings(sources, 1.5),
                testing::Contains(HasSubstr("the source of value 1.5 has a value 0.")));
    EXPECT_THAT(warnings(sources, 0.9), testing::Not(testing::Contains(HasSubstr("shadowed"))));
  }
}

TEST(TetValues, WhatCannotBeHadIsRefusedInTets) {
  const TetMesh mesh = test::tet_box(8);
  TetSources vertices{{}, {0, 9}};
  vertices.values = {0, 0.1};
  for (const char* method : {"quadratic", "regularized", "belyaev-fayolle"})
    EXPECT_THROW(counted(mesh, vertices, AnyMethod::named(method)), UnsupportedError) << method;
  const TetSources planes = two_planes(0.2, 0.8, 0, 0.6, 3);
  EXPECT_THROW(counted(mesh, planes), UnsupportedError);  // one inside the other's outside
  SpaceSignedHeat levels;
  levels.constraint = SpaceConstraint::level_sets;
  EXPECT_THROW(counted(mesh, planes, levels), InputError);
  SpaceSignedHeat sharp;
  sharp.sharpen = true;
  EXPECT_THROW(counted(mesh, planes, sharp), UnsupportedError);
  TetSources cloud{planes.surface, {}};
  cloud.surface.face_offsets = {0};
  cloud.surface.corners.clear();
  cloud.surface.normals = MatX3::Zero(cloud.surface.n_vertices(), 3);
  cloud.surface.normals.col(0).setOnes();
  cloud.values.assign(static_cast<std::size_t>(cloud.surface.n_vertices()), 0);
  std::fill(cloud.values.begin() + 16, cloud.values.end(), 0.6);
  EXPECT_THROW(counted(mesh, cloud), UnsupportedError);
  const VecX heat = counted(mesh, cloud, SpaceSignedHeat{});
  EXPECT_LT((heat - (mesh.points.col(0).array() - 0.2).matrix()).cwiseAbs().maxCoeff(), 0.02);
  vertices.values = {0, 1, 2};
  EXPECT_THAT(test::message_of([&] { counted(mesh, vertices); }),
              HasSubstr("3 values for 2 sources"));
  vertices.values = {0, std::numeric_limits<double>::quiet_NaN()};
  EXPECT_EQ(test::message_of([&] { counted(mesh, vertices); }),
            "value 1 of the sources, counted from 0, is not finite");
  EXPECT_EQ(test::message_of([&] { counted(mesh, {}); }),
            "there is nothing to measure from: no surface, cloud, vertex or boundary");
}

}  // namespace
}  // namespace littoral
