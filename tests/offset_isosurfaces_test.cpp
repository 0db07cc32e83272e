#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "api/space/isosurfaces.h"
#include "api/surface/mesh_info.h"
#include "base/parallel.h"
#include "contour/isosurface.h"
#include "contour/redistance.h"
#include "littoral/error.h"
#include "spatial/triangle_bvh.h"
#include "spatial/triangulate.h"
#include "volume_helpers.h"

namespace littoral {
namespace {

double ball(const Vec3& p, const Vec3& centre, double radius) {
  return (p - centre).norm() - radius;
}

TEST(Redistance, IsTheDistanceToTheLevelSetUpToItsReach) {
  // Twice the distance to a sphere of radius 0.5.
  const Volume field = test::sampled(test::box_grid(33),
                                     [](const Vec3& p) { return 2 * ball(p, Vec3::Zero(), 0.5); });
  Report report;
  const PolygonSoup surface = isosurface(field.grid, field.values, 0.2, {}, report);
  const VecX distance = redistance(field.grid, field.values, 0.2, surface, 0.3, {});
  const Volume exact = test::sampled(
      field.grid, [](const Vec3& p) { return std::clamp(ball(p, Vec3::Zero(), 0.6), -0.3, 0.3); });
  const double sagitta =
      3 * std::pow(field.grid.spacing[0], 2) / (8 * 0.6);  // of a cell's diagonal
  EXPECT_LT((distance - exact.values).cwiseAbs().maxCoeff(), sagitta);
  set_thread_count(1);
  const VecX again = redistance(field.grid, field.values, 0.2, surface, 0.3, {});
  set_thread_count(0);
  EXPECT_TRUE((again.array() == distance.array()).all());
  EXPECT_EQ(redistance(field.grid, field.values, 9, {}, 0.3, {}).maxCoeff(), -0.3);
}

TEST(Redistance, IsTheDistanceToTheNearestTriangleAtEveryNodeWithinItsReach) {
  // Far from the origin, on a box with another size and spacing along each axis.
  Grid grid{{41, 34, 27}, Vec3(50, -70, 30), Vec3(0.05, 0.06, 0.08)};
  const Vec3 middle = grid.origin + Vec3(0.8, 0.9, 1.1);
  const Volume field =
      test::sampled(grid, [&](const Vec3& p) { return 3 * ball(p, middle, 0.45) + 7; });
  Report report;
  const PolygonSoup surface = isosurface(grid, field.values, 7, {}, report);
  for (const double reach : {0.12, 0.5, 9.0}) {
    const VecX distance = redistance(grid, field.values, 7, surface, reach, {});
    const TriangleBvh bvh(surface.points, triangles_of(surface));
    for (int k = 0; k < grid.n[2]; ++k)
      for (int j = 0; j < grid.n[1]; ++j)
        for (int i = 0; i < grid.n[0]; ++i) {
          const auto node = static_cast<Eigen::Index>(grid.node(i, j, k));
          const double near = std::min(reach, bvh.closest_point(grid.point(i, j, k)).distance);
          ASSERT_NEAR(distance[node], field.values[node] > 7 ? near : -near, 1e-12)
              << reach << " at " << i << " " << j << " " << k;
        }
  }
}

TEST(Isosurface, PointsLieWhereTheFunctionTakesTheLevel) {
  // Balls that nearly touch, some in one cell: the distance has creases between them, and cells
  // whose corners alternate, which have points inside.
  const Grid grid = test::box_grid(17);
  const double h = grid.spacing[0];
  double worst = 0, worst_by_nodes = 0;
  for (int shift = 0; shift < 40; ++shift) {
    const Vec3 at(0.013 * shift, 0.007 * shift, -0.011 * shift);
    const auto shape = [&](const Vec3& p) {
      double nearest = 10;
      for (int corner = 0; corner < 8; ++corner) {
        Vec3 centre(corner & 1, corner >> 1 & 1, corner >> 2);
        if (centre.sum() == 1 || centre.sum() == 3) continue;
        nearest = std::min(nearest, ball(p, at + 2.2 * h * centre, 1.2 * h));
      }
      return nearest;
    };
    const Volume field = test::sampled(grid, shape);
    Report report;
    const auto farthest = [&](const IsosurfaceOptions& options) {
      const PolygonSoup surface = isosurface(grid, field.values, 0.3 * h, options, report);
      EXPECT_TRUE(report.warnings.empty());  // closed
      double most = 0;
      for (Eigen::Index v = 0; v < surface.points.rows(); ++v)
        most = std::max(most, std::abs(shape(surface.points.row(v)) - 0.3 * h));
      return most;
    };
    worst = std::max(worst, farthest({.function = shape}));
    worst_by_nodes = std::max(worst_by_nodes, farthest({}));
  }
  EXPECT_LT(worst, 0.1 * h);  // of vertices that are joined near a node
  EXPECT_GT(worst_by_nodes, 0.2 * h);
}

double widest(const PolygonSoup& soup) { return soup.points.rowwise().norm().maxCoeff(); }
double narrowest(const PolygonSoup& soup) { return soup.points.rowwise().norm().minCoeff(); }

std::vector<Isosurface> offsets(const Volume& field, const std::vector<double>& at,
                                const Morphology& morphology = {}) {
  Report report;
  return offset_isosurfaces(field, at, morphology, false, report, {});
}

TEST(Offset, SpheresGrowAndShrink) {
  const Volume field =
      test::sampled(test::box_grid(40), [](const Vec3& p) { return ball(p, Vec3::Zero(), 0.5); });
  const auto surfaces = offsets(field, {-0.2, 0, 0.3});
  ASSERT_EQ(surfaces.size(), 3u);
  for (const Isosurface& shell : surfaces) {
    EXPECT_NEAR(widest(shell.surface), 0.5 + shell.level, 2e-3);
    EXPECT_NEAR(narrowest(shell.surface), 0.5 + shell.level, 2e-3);
  }
  const PolygonSoup all = join_isosurfaces(surfaces);
  EXPECT_EQ(all.scalars.at("level").minCoeff(), -0.2);
  EXPECT_EQ(all.n_faces(), surfaces[0].surface.n_faces() + surfaces[1].surface.n_faces() +
                               surfaces[2].surface.n_faces());
}

TEST(OffsetSlow, OpeningRemovesThinPartsAndKeepsTheRest) {
  // A ball with a thin rod through it.
  const Volume field = test::sampled(test::box_grid(50), [](const Vec3& p) {
    const double rod = std::max(std::hypot(p[0], p[1]) - 0.1, std::abs(p[2]) - 0.9);
    return std::min(ball(p, Vec3::Zero(), 0.5), rod);
  });
  EXPECT_GT(widest(offsets(field, {0}).front().surface), 0.85);
  const auto opened = offsets(field, {0, 0.1}, {.open = 0.15});
  EXPECT_NEAR(widest(opened[0].surface), 0.5, 0.02);
  EXPECT_NEAR(narrowest(opened[0].surface), 0.5, 0.02);
  EXPECT_NEAR(widest(opened[1].surface), 0.6, 0.02);
}

TEST(OffsetSlow, ClosingFillsAGap) {
  // Two balls nearly touching: closing joins them; what is far from the gap stays.
  const Vec3 left(-0.33, 0, 0), right(0.33, 0, 0);
  const Volume field = test::sampled(test::box_grid(50), [&](const Vec3& p) {
    return std::min(ball(p, left, 0.3), ball(p, right, 0.3));
  });
  const auto components = [](const PolygonSoup& soup) {
    for (const InfoEntry& entry : surface_info(soup))
      if (entry.key == "components") return std::get<double>(entry.value);
    return -1.0;
  };
  EXPECT_EQ(components(offsets(field, {0}).front().surface), 2);
  const PolygonSoup closed = offsets(field, {0}, {.close = 0.12}).front().surface;
  EXPECT_EQ(components(closed), 1);
  EXPECT_NEAR(widest(closed), 0.63, 0.01);
}

TEST(Offset, RefusesWhatCannotBe) {
  const Volume field =
      test::sampled(test::box_grid(20), [](const Vec3& p) { return ball(p, Vec3::Zero(), 0.5); });
  EXPECT_THROW(offsets(field, {5}), InputError);
  EXPECT_THROW(offsets(field, {0}, {.open = 0.7}), InputError);
  EXPECT_THROW(offsets(field, {0}, {.open = -0.1}), InputError);
  EXPECT_THROW(offsets(field, {0}, {.close = std::nan("")}), InputError);
  EXPECT_THROW(write_isosurfaces({"a.obj", "b.obj"}, {{0, {}}}), InputError);
  Report report;
  CancelToken cancel;
  cancel.cancel();
  EXPECT_THROW(offset_isosurfaces(field, {0}, {.open = 0.1}, false, report, Task(cancel)),
               Cancelled);
}

TEST(OffsetIsosurfaces, WhatIsThinnerThanTheGridNamesAFinerOne) {
  const Volume sheet = test::sampled(test::box_grid(9), [](const Vec3& p) {
    return std::abs(p.z() - 0.01);  // the nodes next to it lie in z = 0
  });
  const auto said = [&](double level) {
    Report report;
    try {
      isosurfaces(sheet, {level}, false, report, {});
    } catch (const InputError& error) {
      EXPECT_EQ(report.warnings.size(), 1U);
      EXPECT_EQ(report.warnings.front().code, "level-missed");
      const auto names = [](const std::string& text) {
        return text.find("thinner than the grid: option spacing 0.004 would") != std::string::npos;
      };
      EXPECT_EQ(names(report.warnings.front().text), names(error.what()));
      return std::string(names(error.what()) ? "thin" : "missed");
    }
    return std::string("there");
  };
  EXPECT_EQ(said(0.004), "thin");
  EXPECT_EQ(said(0.04), "there");
  EXPECT_EQ(said(40), "missed");
  EXPECT_EQ(said(-0.004), "missed");
}

}  // namespace
}  // namespace littoral
