// Oriented points on level sets of sampled values: on the surface to third order, evenly spread.
#include "sources/space/level_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "api/space/csg.h"
#include "base/parallel.h"
#include "littoral/error.h"

namespace littoral {
namespace {

Volume sampled_on(int n, const std::function<double(const Vec3&)>& f, double half = 1.5) {
  Volume field;
  field.grid = {{n, n, n}, Vec3::Constant(-half), Vec3::Constant(2 * half / (n - 1))};
  field.values.resize(static_cast<Eigen::Index>(field.grid.n_nodes()));
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
        field.values[static_cast<Eigen::Index>(field.grid.node(i, j, k))] =
            f(field.grid.point(i, j, k));
  return field;
}

// An implicit function of a sphere of radius 1 that is far from a distance.
double steep(const Vec3& x) { return std::exp(2 * x.squaredNorm()) - std::exp(2.0); }

struct PointErrors {
  double place = 0, normal = 0;
  int points = 0;
};

PointErrors errors(int n) {
  const PolygonSoup cloud = level_points(sampled_on(n, steep), 0, {});
  PointErrors worst;
  worst.points = cloud.n_vertices();
  for (int v = 0; v < cloud.n_vertices(); ++v) {
    const Vec3 p = cloud.points.row(v);
    worst.place = std::max(worst.place, std::abs(p.norm() - 1));
    worst.normal = std::max(worst.normal, (Vec3(cloud.normals.row(v)) - p.normalized()).norm());
  }
  return worst;
}

TEST(LevelPoints, LieOnTheLevelSetToThirdOrder) {
  const PointErrors coarse = errors(24), fine = errors(47);
  EXPECT_LT(fine.place, 2e-3);
  EXPECT_LT(fine.place, coarse.place / 5);
  EXPECT_LT(fine.normal, coarse.normal / 2.8);
  EXPECT_LT(fine.normal, 0.05);
}

TEST(LevelPoints, AreAsGoodAtOneEndOfTheGridAsAtTheOther) {
  // The sphere touches the outermost cells.
  const PolygonSoup cloud = level_points(
      sampled_on(25, [](const Vec3& x) { return x.squaredNorm() * x.norm() - 1.45 * 1.45 * 1.45; }),
      0, {});
  for (int axis = 0; axis < 3; ++axis) {
    double worst[2] = {0, 0};
    for (int v = 0; v < cloud.n_vertices(); ++v) {
      const Vec3 p = cloud.points.row(v);
      if (std::abs(p[axis]) > 1.5 - 3. / 24) {
        double& w = worst[p[axis] > 0];
        w = std::max(w, std::abs(p.norm() - 1.45));
      }
    }
    EXPECT_GT(worst[0], 0);
    EXPECT_NEAR(worst[0], worst[1], 0.05 * worst[1]);
  }
}

TEST(LevelPoints, AreAsManyAsTheSurfaceHasCellsAndNotClose) {
  const Volume field = sampled_on(28, steep);
  const PolygonSoup cloud = level_points(field, 0, {});
  const double h = field.grid.spacing[0], cells = 4 * std::acos(-1.0) / (h * h);
  EXPECT_GT(cloud.n_vertices(), cells);
  EXPECT_LT(cloud.n_vertices(), 1.8 * cells);
  for (int a = 0; a < cloud.n_vertices(); ++a)
    for (int b = 0; b < a; ++b)
      ASSERT_GE((cloud.points.row(a) - cloud.points.row(b)).norm(), 0.5 * h);
}

TEST(LevelPoints, SameForAnyUnitOfValuesSpacingAndThreads) {
  const PolygonSoup cloud = level_points(sampled_on(24, steep), 0, {});
  for (double unit : {1e-250, 1e250}) {
    const PolygonSoup other =
        level_points(sampled_on(24, [unit](const Vec3& x) { return unit * steep(x); }), 0, {});
    ASSERT_EQ(other.n_vertices(), cloud.n_vertices());
    EXPECT_LT((other.points - cloud.points).norm(), 1e-9);
  }
  set_thread_count(1);
  const PolygonSoup one = level_points(sampled_on(24, steep), 0, {});
  set_thread_count(0);
  EXPECT_EQ(one.points, cloud.points);
  EXPECT_EQ(one.normals, cloud.normals);
}

TEST(LevelPoints, NormalsOfStretchedGridsAreThoseOfTheFunction) {
  Volume field = sampled_on(20, [](const Vec3& x) { return x[0] + x[1] - 0.1; });
  field.grid.spacing[0] *= 3;  // now 1/3 x + y about the origin of x
  const PolygonSoup cloud = level_points(field, 0, {});
  const Vec3 n = Vec3(1.0 / 3, 1, 0).normalized();
  for (int v = 0; v < cloud.n_vertices(); ++v)
    EXPECT_NEAR((Vec3(cloud.normals.row(v)) - n).norm(), 0, 1e-9);
}

/// Values of f on a box whose sides, spacings and place differ from axis to axis.
Volume on_uneven_box(const std::function<double(const Vec3&)>& f) {
  Volume field;
  field.grid = {{11, 13, 16}, Vec3(-1, 0.5, 2), Vec3(0.2, 0.15, 0.1)};
  field.values.resize(static_cast<Eigen::Index>(field.grid.n_nodes()));
  for (int k = 0; k < 16; ++k)
    for (int j = 0; j < 13; ++j)
      for (int i = 0; i < 11; ++i)
        field.values[static_cast<Eigen::Index>(field.grid.node(i, j, k))] =
            f(field.grid.point(i, j, k));
  return field;
}

/// For a linear function: in every cell that {f = 0} passes the mean of where it crosses the edges,
/// unless a point before it is nearer than half the smallest spacing.
std::vector<Vec3> points_on_plane(const Volume& field) {
  const Grid& grid = field.grid;
  std::vector<Vec3> kept;
  for (int k = 0; k + 1 < grid.n[2]; ++k)
    for (int j = 0; j + 1 < grid.n[1]; ++j)
      for (int i = 0; i + 1 < grid.n[0]; ++i) {
        Vec3 sum = Vec3::Zero();
        int crossings = 0;
        bool finite = true;
        for (int a = 0; a < 8; ++a)
          for (int b = a + 1; b < 8; ++b) {
            const auto node = [&](int c) {
              return std::array{i + (c & 1), j + (c >> 1 & 1), k + (c >> 2)};
            };
            const auto value = [&](int c) {
              const auto n = node(c);
              return field.values[static_cast<Eigen::Index>(grid.node(n[0], n[1], n[2]))];
            };
            finite = finite && std::isfinite(value(a)) && std::isfinite(value(b));
            const int across = a ^ b;
            if ((across != 1 && across != 2 && across != 4) || (value(a) <= 0) == (value(b) <= 0))
              continue;
            const auto m = node(a), n = node(b);
            const Vec3 p = grid.point(m[0], m[1], m[2]), q = grid.point(n[0], n[1], n[2]);
            sum += p + value(a) / (value(a) - value(b)) * (q - p);
            ++crossings;
          }
        if (crossings == 0 || !finite) continue;
        const Vec3 x = sum / crossings;
        if (std::all_of(kept.begin(), kept.end(),
                        [&](const Vec3& y) { return (x - y).norm() >= 0.05; }))
          kept.push_back(x);
      }
  return kept;
}

TEST(LevelPoints, OfPlanesAreTheMiddlesOfTheirCellsUnlessOneBeforeIsNear) {
  int points = 0;
  for (const Vec3& normal :
       {Vec3(1, 0, 0), Vec3(0, -1, 0), Vec3(0, 0, 1), Vec3(1, 1, 1), Vec3(1, -0.7, 0.2),
        Vec3(-0.1, 0.4, 1), Vec3(0.3, 1, -0.05), Vec3(-1, -1, 2)})
    for (const double share : {0.5, 0.23}) {  // through nodes or between them
      const Vec3 through = Vec3(-1, 0.5, 2) + share * Vec3(2, 1.8, 1.5);
      const auto f = [&](const Vec3& x) {
        const double value = normal.dot(x - through);
        return std::abs(value) < 1e-12 ? 0 : value;
      };
      Volume field = on_uneven_box(f);
      for (const bool holes : {false, true}) {
        if (holes)
          for (Eigen::Index v = 1; v < field.values.size(); v += 97)
            field.values[v] = std::numeric_limits<double>::quiet_NaN();
        const std::vector<Vec3> expected = points_on_plane(field);
        const PolygonSoup cloud = level_points(field, 0, {});
        ASSERT_EQ(cloud.n_vertices(), static_cast<int>(expected.size())) << normal.transpose();
        for (int v = 0; v < cloud.n_vertices(); ++v) {
          EXPECT_LT((cloud.points.row(v).transpose() - expected[v]).norm(), 1e-9);
          EXPECT_LT((Vec3(cloud.normals.row(v)) - normal.normalized()).norm(), 1e-8);
        }
        points += static_cast<int>(expected.size());
      }
    }
  EXPECT_GT(points, 3000);
}

TEST(LevelPoints, AreExactForQuadraticFunctions) {
  const Vec3 middle(0.03, 1.41, 2.74);
  Eigen::Matrix3d form;
  form << 3, 0.6, -0.4, 0.6, 5, 0.3, -0.4, 0.3, 9;
  const auto f = [&](const Vec3& x) { return (x - middle).dot(form * (x - middle)) - 2; };
  const Volume field = on_uneven_box(f);
  const PolygonSoup cloud = level_points(field, -1, {});
  EXPECT_GT(cloud.n_vertices(), 150);
  for (int v = 0; v < cloud.n_vertices(); ++v) {
    const Vec3 x = cloud.points.row(v), slope = 2 * form * (x - middle);
    EXPECT_NEAR(f(x), -1, 1e-8);
    EXPECT_LT((Vec3(cloud.normals.row(v)) - slope.normalized()).norm(), 1e-7);
  }
  EXPECT_GT((cloud.normals.colwise().maxCoeff() - cloud.normals.colwise().minCoeff()).minCoeff(),
            1.9);
}

TEST(LevelPoints, BadVolumesAreNamedAndHolesArePassedOver) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Volume field = sampled_on(24, steep);
  EXPECT_THROW(level_points(field, 1e9, {}), InputError);
  EXPECT_THROW(level_points(field, nan, {}), InputError);
  for (Eigen::Index v = 0; v < field.values.size(); v += 7)
    field.values[v] = v % 2 ? nan : std::numeric_limits<double>::infinity();
  for (int k = 12; k < 24; ++k)
    field.values.segment(k * 24 * 24, 24 * 24) =
        sampled_on(24, steep).values.segment(k * 24 * 24, 24 * 24);
  const PolygonSoup half = level_points(field, 0, {});
  EXPECT_GT(half.n_vertices(), 200);
  EXPECT_TRUE(half.points.allFinite());
  field.values.setConstant(nan);
  EXPECT_THROW(level_points(field, 0, {}), InputError);
  field.values.setZero();
  EXPECT_THROW(level_points(field, 0, {}), InputError);
  field.values.conservativeResize(5);
  EXPECT_THROW(level_points(field, 0, {}), InputError);
}

TEST(LevelPoints, MakeADistanceOfAnImplicitFunction) {
  CsgShapes shapes;
  shapes.all.resize(1);
  shapes.all[0].surface = level_points(sampled_on(48, steep), 0, {});
  shapes.all[0].request.method = Tori{};
  Report report;
  const auto distance = pointwise_distance(shapes, {}, report);
  for (const Vec3& x : {Vec3(0, 0, 0.4), Vec3(0.9, 0.9, 0.9), Vec3(-2, 0.3, 0), Vec3(0, 0.99, 0)})
    EXPECT_NEAR(distance->value(x), x.norm() - 1, 3e-3) << x.transpose();
}

}  // namespace
}  // namespace littoral
