// Prescribed values at sources: the least of value + distance, and what cannot be had.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "heat_helpers.h"
#include "io/read.h"
#include "io/sources/write_sources.h"
#include "littoral/error.h"
#include "one_call.h"
#include "sources/surface/surface_points.h"
#include "test_meshes.h"

namespace littoral {
namespace {

using testing::HasSubstr;

VecX valued(const SurfaceMesh& mesh, const Sources& sources, const AnyMethod& method) {
  Report report;
  return test::surface_distance(mesh, sources, method, report);
}

double to_segment(const Vec3& x, const Vec3& a, const Vec3& b) {
  const double t = std::clamp((x - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (a + t * (b - a) - x).norm();
}

/// Distance to a closed polygon, and whether a point is inside it.
struct ToPolygon {
  double distance = std::numeric_limits<double>::infinity();
  bool inside = false;
};
ToPolygon polygon_at(const MatX3& polygon, const Vec3& x) {
  ToPolygon out;
  for (Eigen::Index i = 0; i + 1 < polygon.rows(); ++i) {
    const Vec3 a = polygon.row(i), b = polygon.row(i + 1);
    out.distance = std::min(out.distance, to_segment(x, a, b));
    if ((a[1] > x[1]) != (b[1] > x[1]) &&
        x[0] < a[0] + (x[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]))
      out.inside = !out.inside;
  }
  return out;
}

Sources valued_circle(double x, double radius, double value, bool is_signed = true) {
  Sources sources = test::space_curve(test::circle(x, 0.5, 0, radius, 60), is_signed);
  sources.space_curves[0].value = value;
  return sources;
}

TEST(SourceValues, ExactDistanceIsTheLeastOfValuePlusDistance) {
  const SurfaceMesh mesh(test::jittered_grid_soup(14, 14, 0.3));
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int round = 0; round < 20; ++round) {
    Sources sources;
    MatX3 places(6, 3);
    VecX values(6);
    for (int i = 0; i < 6; ++i) {
      SurfacePoint p = SurfacePoint::at_vertex(int(unit(random) * mesh.n_vertices()));
      if (i % 3 == 1) p = SurfacePoint::on_edge(int(unit(random) * mesh.n_edges()), unit(random));
      if (i % 3 == 2) p = SurfacePoint::in_face(int(unit(random) * mesh.n_faces()), 0.2, 0.3, 0.5);
      values[i] = 0.6 * unit(random) - 0.3;  // some are shadowed
      places.row(i) = mesh.position(p);
      sources.add(p, values[i]);
    }
    const VecX exact = valued(mesh, sources, Exact{}), whole = valued(mesh, sources, Automatic{});
    for (int v = 0; v < mesh.n_vertices(); ++v) {
      double least = 1e9;
      for (int i = 0; i < 6; ++i)
        least = std::min(least, values[i] + (mesh.point(v) - Vec3(places.row(i))).norm());
      EXPECT_NEAR(exact[v], least, 1e-12);
      EXPECT_EQ(whole[v], exact[v]);
    }
  }
}

TEST(SourceValues, UnsignedCurvesCountFromTheirValues) {
  const SurfaceMesh mesh(test::jittered_grid_soup(20, 20, 0.3));
  const Sources sources = valued_circle(0.3, 0.15, 0.1, false)
                              .add(valued_circle(0.75, 0.1, -0.05, false))
                              .add(SurfacePoint::at_vertex(0), 0.02);
  const MatX3 a = test::circle(0.3, 0.5, 0, 0.15, 60), b = test::circle(0.75, 0.5, 0, 0.1, 60);
  const VecX exact = valued(mesh, sources, Exact{}), front = valued(mesh, sources, FastMarching{});
  double error = 0;
  for (int v = 0; v < mesh.n_vertices(); ++v) {
    const Vec3 x = mesh.point(v);
    const double least = std::min(
        {0.1 + polygon_at(a, x).distance, -0.05 + polygon_at(b, x).distance, 0.02 + x.norm()});
    EXPECT_NEAR(exact[v], least, 1e-9);
    error += std::abs(front[v] - least) / mesh.n_vertices();
  }
  EXPECT_LT(error, 0.01);
}

TEST(SourceValues, BoundingCurvesCountUpOnOneSideAndDownOnTheOther) {
  const SurfaceMesh mesh(test::jittered_grid_soup(24, 24, 0.3));
  Sources sources = valued_circle(0.3, 0.15, 0.06).add(valued_circle(0.75, 0.1, -0.05));
  sources.add(SurfacePoint::at_vertex(0), -0.1);  // on the negative side
  const MatX3 a = test::circle(0.3, 0.5, 0, 0.15, 60), b = test::circle(0.75, 0.5, 0, 0.1, 60);
  const VecX phi = valued(mesh, sources, {});
  for (int v = 0; v < mesh.n_vertices(); ++v) {
    const Vec3 x = mesh.point(v);
    const ToPolygon to_a = polygon_at(a, x), to_b = polygon_at(b, x);
    const double least = std::min({0.06 + to_a.distance, -0.05 + to_b.distance, -0.1 + x.norm()});
    const double most = std::max({0.06 - to_a.distance, -0.05 - to_b.distance, -0.1 - x.norm()});
    EXPECT_NEAR(phi[v], to_a.inside || to_b.inside ? least : most, 1e-9);
  }
}

TEST(SourceValues, OneValueOfAllIsAddedByEveryMethod) {
  const SurfaceMesh mesh(test::grid_soup(8, 8));
  for (const MethodInfo& info : Registry<SurfaceDomain>::instance().infos()) {
    Sources zero = test::vertex_points({40, 3}), four;
    for (const SurfacePoint& p : zero.points) four.add(p, 4);
    const VecX a = valued(mesh, zero, AnyMethod::named(info.name));
    const VecX b = valued(mesh, four, AnyMethod::named(info.name));
    EXPECT_EQ((a.array() + 4).matrix(), b) << info.name;
  }
  // Of broken curves, too.
  Sources broken = test::space_curve(test::circle(0.5, 0.5, 0, 0.3, 40).topRows(30));
  const VecX a = valued(mesh, broken, {});
  broken.space_curves[0].value = -2;
  EXPECT_EQ((a.array() - 2).matrix(), valued(mesh, broken, {}));
}

TEST(SourceValues, HeatMeetsWhereValuePlusDistanceAgree) {
  const SurfaceMesh mesh(test::grid_soup(60, 60, 1));
  Sources points = test::vertex_points({});
  points.add(SurfacePoint::at_vertex(30 * 61 + 12), 0)
      .add(SurfacePoint::at_vertex(30 * 61 + 48), 0.3);
  for (const AnyMethod& method : {AnyMethod(UnsignedHeat{}), AnyMethod(SignedHeat{})}) {
    const VecX phi = valued(mesh, points, method);
    double mean = 0;
    for (int v = 0; v < mesh.n_vertices(); ++v) {
      const Vec3 x = mesh.point(v);
      mean += std::abs(
          phi[v] - std::min((x - Vec3(0.2, 0.5, 0)).norm(), 0.3 + (x - Vec3(0.8, 0.5, 0)).norm()));
    }
    EXPECT_LT(mean / mesh.n_vertices(), 0.008) << method.name();
    EXPECT_NEAR(phi[30 * 61 + 36], 0.4, 0.02);  // nearer to the second, reached from the first
    EXPECT_NEAR(phi[30 * 61 + 48], 0.3, 1e-6);
  }
}

TEST(SourceValues, LevelSetsOfOneFunctionGiveItBack) {
  const SurfaceMesh mesh(test::jittered_grid_soup(40, 40, 0.2));
  const Sources levels = valued_circle(0.5, 0.15, 0.15).add(valued_circle(0.5, 0.3, 0));
  const auto deviation = [&](const SignedHeat& options) {
    Report report;
    const VecX phi = test::surface_distance(mesh, levels, options, report);
    for (const Warning& warning : report.warnings)  // it stops at each curve
      EXPECT_THAT(warning.text, testing::Not(HasSubstr("fast marching")));
    double mean = 0;
    for (int v = 0; v < mesh.n_vertices(); ++v) {
      const double r = (mesh.point(v) - Vec3(0.5, 0.5, 0)).norm();
      if (r > 0.05 && r < 0.45) mean += std::abs(phi[v] - (0.3 - r));
    }
    return mean / mesh.n_vertices();
  };
  EXPECT_LT(deviation({}), 0.002);
  SignedHeat soft;
  soft.soft = 100;
  EXPECT_LT(deviation(soft), 0.002);
  SignedHeat free;
  free.constraint = Constraint::none;
  EXPECT_LT(deviation(free), 0.002);
  SignedHeat delaunay;
  delaunay.intrinsic_delaunay = true;
  EXPECT_LT(deviation(delaunay), 0.002);
}

TEST(SourceValues, WhatIsShadowedIsWarnedOf) {
  const SurfaceMesh mesh(test::grid_soup(8, 8));
  const auto warnings = [&](double value, const AnyMethod& method) {
    Sources sources;
    sources.add(SurfacePoint::at_vertex(0)).add(SurfacePoint::at_vertex(4), value);  // 0.5 apart
    Report report;
    test::surface_distance(mesh, sources, method, report);
    return std::vector<std::string>(report.warnings.begin(), report.warnings.end());
  };
  for (const char* method : {"auto", "exact", "fast-marching", "signed-heat", "unsigned-heat"}) {
    EXPECT_THAT(warnings(0.75, AnyMethod::named(method)),
                testing::Contains(HasSubstr("point source 2 has a value 0.25 above")))
        << method;
    EXPECT_THAT(warnings(0.45, AnyMethod::named(method)),
                testing::Not(testing::Contains(HasSubstr("shadowed"))))
        << method;
  }
}

TEST(SourceValues, WhatCannotBeHadIsRefused) {
  const SurfaceMesh mesh(test::grid_soup(12, 12));
  Sources points;
  points.add(SurfacePoint::at_vertex(0)).add(SurfacePoint::at_vertex(20), 0.1);
  for (const char* method : {"quadratic", "regularized", "belyaev-fayolle"})
    EXPECT_THROW(valued(mesh, points, AnyMethod::named(method)), UnsupportedError) << method;
  const Sources circles = valued_circle(0.3, 0.15, 0.06).add(valued_circle(0.75, 0.1, 0));
  EXPECT_THROW(valued(mesh, circles, FastMarching{}), UnsupportedError);
  SignedHeat levels;
  levels.constraint = Constraint::level_sets;
  EXPECT_THROW(valued(mesh, circles, levels), InputError);
  SignedHeat sharp;
  sharp.sharpen = Sharpening::on;
  EXPECT_THROW(valued(mesh, circles, sharp), UnsupportedError);
  SignedHeat torn;
  torn.discontinuous = true;
  EXPECT_THROW(valued(mesh, circles, torn), UnsupportedError);
  Sources mixed = circles;
  mixed.add(SurfacePoint::at_vertex(0), 0.1);
  EXPECT_THROW(valued(mesh, mixed, SignedHeat{}), UnsupportedError);
  Sources broken = circles;
  broken.space_curves[0].points.conservativeResize(40, 3);
  EXPECT_THROW(valued(mesh, broken, Automatic{}), UnsupportedError);
  Sources lost;
  lost.add(SurfacePoint::at_vertex(0), std::numeric_limits<double>::quiet_NaN());
  EXPECT_THROW(valued(mesh, lost, {}), InputError);
  lost.points.push_back(SurfacePoint::at_vertex(1));
  lost.point_values = {0, std::numeric_limits<double>::infinity()};
  EXPECT_THROW(valued(mesh, lost, {}), InputError);
}

TEST(SourceValues, FilesHoldThem) {
  const SurfaceMesh mesh(test::grid_soup(3, 3));
  Sources sources;
  sources.add(Curve::along_vertices({0, 1, 2}).with_value(0.1));
  sources.add(Curve::along_vertices({4, 5}).unsigned_curve());
  sources.add(SurfacePoint::at_vertex(9));
  sources.add(SurfacePoint::at_vertex(10), -2.5).add(SurfacePoint::at_vertex(11));
  for (const char* extension : {".txt", ".json"}) {
    const std::string text = std::string(extension) == ".txt" ? io::sources_txt(sources, mesh)
                                                              : io::sources_json(sources, mesh);
    Report report;
    const Sources read = io::read_sources_bytes(text, extension, "a", mesh, {}, report);
    ASSERT_EQ(read.curves.size(), 2u) << text;
    EXPECT_EQ(read.curves[0].value, 0.1);
    EXPECT_EQ(read.curves[1].value, 0);
    ASSERT_EQ(read.points.size(), 3u);
    EXPECT_EQ(read.point_value(0), 0);
    EXPECT_EQ(read.point_value(1), -2.5);
    EXPECT_EQ(read.point_value(2), 0);
  }
  const auto error = [&](const std::string& text, const char* extension) -> std::string {
    Report report;
    try {
      io::read_sources_bytes(text, extension, "a", mesh, {}, report);
    } catch (const InputError& e) {
      return e.what();
    }
    return {};
  };
  EXPECT_EQ(error("signed_curve value x\nv 0\nv 1\n", ".txt"), "a:1: expected a number, found 'x'");
  EXPECT_THAT(error("signed_curve value inf\nv 0\nv 1\n", ".txt"), HasSubstr("a:1: "));
  EXPECT_THAT(error("signed_curve value\nv 0\nv 1\n", ".txt"), HasSubstr("'value NUMBER'"));
  EXPECT_THAT(error(R"({"points": [{"v": 1, "value": "x"}]})", ".json"),
              HasSubstr("points[0]: expected a number"));
  EXPECT_THAT(error(R"({"curves": [{"nodes": [{"v": 1, "value": 2}, {"v": 2}]}]})", ".json"),
              HasSubstr("curves[0].nodes[0]"));
}

}  // namespace
}  // namespace littoral
