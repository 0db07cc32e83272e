// Signed heat on grids: diffused normals, their sampling, and distances with known answers.

#include <gtest/gtest.h>

#include <cmath>
#include <span>

#include "base/index.h"
#include "base/parallel.h"
#include "littoral/error.h"
#include "methods/heat/convolve.h"
#include "methods/heat/signed_heat_grid.h"
#include "methods/heat/yukawa_tree.h"
#include "space_helpers.h"

namespace littoral {
namespace {

TEST(Convolution, FarDirectionIsThatOfTheNearestSampleAndNeverUnderflows) {
  OrientedPoints two;
  two.points.resize(2, 3);
  two.points << 0, 0, 0, 1, 0, 0;
  two.normals.resize(2, 3);
  two.normals << 0, 0, 1, 0, 1, 0;
  two.areas = Eigen::Vector2d(1, 1);
  const Convolution X(two, 0.01);
  const Flow far = X(Vec3(-1e5, 0, 3));
  EXPECT_LT((far.direction - Vec3(0, 0, 1)).norm(), 1e-6);
  EXPECT_NEAR(far.distance, std::hypot(1e5, 3), 1e-6 * far.distance);
  // Halfway, both weigh the same.
  EXPECT_LT((X(Vec3(0.5, 0, 0)).direction - Vec3(0, 1, 1).normalized()).norm(), 1e-5);
}

TEST(Convolution, EqualsTheSumOfKernels) {
  const OrientedPoints sphere = test::sphere_samples(2);
  const double root_t = 0.2;
  const Convolution X(sphere, root_t, 0);
  const MatX3 queries = test::random_points(50, 1.5);
  for (Eigen::Index i = 0; i < queries.rows(); ++i) {
    Vec3 sum = Vec3::Zero();
    for (Eigen::Index s = 0; s < sphere.size(); ++s) {
      const double r = (queries.row(i) - sphere.points.row(s)).norm();
      sum += sphere.areas[s] * std::exp(-r / root_t) / r * sphere.normals.row(s).transpose();
    }
    EXPECT_LT((X(queries.row(i)).direction - sum.normalized()).norm(), 2e-5);
  }
}

TEST(Convolution, MomentsOfClustersTurnItLittle) {
  const OrientedPoints sphere = test::sphere_samples(5);
  const double root_t = sample_spacing(sphere);
  const Convolution sums(sphere, root_t, 0), X(sphere, root_t);
  double total = 0, most = 0;
  for (const double radius : {0.4, 0.9, 1.0, 1.05, 1.3, 2.5}) {
    const MatX3 directions = test::random_points(64, 1);
    std::vector<Vec3> places;
    for (Eigen::Index i = 0; i < directions.rows(); ++i)  // a few blocks of neighbours
      places.emplace_back(
          radius *
          (directions.row(i / 16 * 16) + 0.02 * directions.row(i)).normalized().transpose());
    std::vector<Flow> flows(places.size());
    X(places.data(), int_size(places), flows.data());
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Flow exact = sums(places[i]);
      EXPECT_NEAR(flows[i].distance, exact.distance, 1e-6);
      total += (flows[i].direction - exact.direction).norm() / places.size();
      most = std::max(most, (flows[i].direction - exact.direction).norm());
    }
  }
  EXPECT_LT(total / 6, 3e-4);
  EXPECT_LT(most, 3e-3);
}

TEST(YukawaTree, MomentsAreThoseOfTheSamples) {
  OrientedPoints source;
  source.points = test::random_points(100, 0.5);
  source.normals = test::random_points(100, 1).rowwise().normalized();
  source.areas = VecX::LinSpaced(100, 0.1, 2);
  const YukawaTree tree = yukawa_tree(source, 8);
  ASSERT_GT(tree.boxes.size(), 20u);
  for (std::size_t i = 0; i < tree.boxes.size(); ++i) {
    double area = 0;
    Vec3 centre = Vec3::Zero(), normal = Vec3::Zero(), along = Vec3::Zero();
    const auto samples = std::span(tree.samples)
                             .subspan(tree.boxes[i].begin, tree.boxes[i].end - tree.boxes[i].begin);
    for (const YukawaSample& s : samples) {
      area += s.area;
      centre += s.area * Vec3(s.x, s.y, s.z);
      normal += Vec3(s.nx, s.ny, s.nz);
    }
    centre /= area;
    double spread = 0;
    for (const YukawaSample& s : samples) {
      const Vec3 d = Vec3(s.x, s.y, s.z) - centre;
      spread += s.area / area * d.x() * d.y();
      along += s.nz * d;
    }
    const YukawaMoments& m = tree.moments[i];
    EXPECT_NEAR(m.area, area, 1e-4 * area);
    EXPECT_NEAR(m.spread[3], spread, 1e-5);
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(m.centre[k], centre[k], 1e-5);
      EXPECT_NEAR(m.normal[k], normal[k], 1e-4);
      EXPECT_NEAR(m.first[2][k], along[k], 1e-4);
    }
  }
}

TEST(SampleDirections, InterpolationStaysCloseToEvaluationEverywhere) {
  const Grid grid = test::cube_grid(41, 2);
  const Convolution X(test::sphere_samples(4), 0.1);
  Report report;
  const Directions Y = sample_directions(
      grid, [&](const Vec3* x, int n, Flow* out) { X(x, n, out); }, Task(), report);
  double worst = 0;
  for (int k = 0; k < 41; k += 3)
    for (int j = 0; j < 41; j += 3)
      for (int i = 0; i < 41; i += 3) {
        const Vec3 x = grid.point(i, j, k);
        if (x.norm() < 0.2) continue;  // the medial axis of the sphere
        const Vec3 y = Y.row(static_cast<Eigen::Index>(grid.node(i, j, k))).cast<double>();
        worst = std::max(worst, (y - X(x).direction).norm());
      }
  EXPECT_LT(worst, 0.03);
  EXPECT_LT(report.sizes.back().second, 0.5 * static_cast<double>(grid.n_nodes()));
}

TEST(SignedHeatGridSlow, SphereErrorFallsWithTheSpacing) {
  // Observed order over two halvings, samples refined along with the grid.
  const auto error = [](int n, int level, SpaceConstraint constraint) {
    const Grid grid = test::cube_grid(n, 2);
    SpaceSignedHeat options;
    options.constraint = constraint;
    Report report;
    const VecX phi = signed_heat_grid(grid, test::sphere_samples(level), options, Task(), report);
    return test::mean_error(grid, phi, [](const Vec3& x) { return x.norm() - 1; });
  };
  for (const auto constraint :
       {SpaceConstraint::none, SpaceConstraint::zero_set, SpaceConstraint::soft}) {
    const double coarse = error(17, 3, constraint), fine = error(65, 5, constraint);
    EXPECT_GT(std::log2(coarse / fine) / 2, 1.2);
    EXPECT_LT(fine, 1e-3);
  }
}

TEST(SignedHeatGrid, SameBitsForAnyNumberOfThreads) {
  const Grid grid = test::cube_grid(23, 1.7);
  const OrientedPoints sphere = test::sphere_samples(3);
  Report report;
  set_thread_count(1);
  const VecX one = signed_heat_grid(grid, sphere, {}, Task(), report);
  set_thread_count(5);
  const VecX five = signed_heat_grid(grid, sphere, {}, Task(), report);
  set_thread_count(0);
  EXPECT_TRUE(one == five);
}

TEST(SignedHeatGrid, SoftConstraintLiesBetweenNoneAndZeroSet) {
  // Two parallel planes of one orientation cannot both be zero: the constraint forces them.
  OrientedPoints planes;
  planes.points.resize(2 * 15 * 15, 3);
  for (int i = 0; i < planes.points.rows(); ++i)
    planes.points.row(i) << -0.7 + 0.1 * (i % 15), -0.7 + 0.1 * (i / 15 % 15),
        (i < 225 ? -0.25 : 0.25);
  planes.normals = Eigen::RowVector3d(0, 0, 1).replicate(planes.points.rows(), 1);
  planes.areas = VecX::Constant(planes.points.rows(), 0.01);
  const Grid grid = test::cube_grid(21, 1);
  std::vector<int> sheets(450, 0);
  std::fill(sheets.begin() + 225, sheets.end(), 1);
  const auto spread = [&](SpaceConstraint constraint, double soft) {
    SpaceSignedHeat options;
    options.constraint = constraint;
    options.soft = soft;
    Report report;
    const bool levels = constraint == SpaceConstraint::level_sets;
    const VecX phi = signed_heat_grid(grid, planes, options, Task(), report,
                                      levels ? sheets : std::vector<int>());
    const GridRows rows = grid_rows(grid, planes.points, planes.areas, sheets);
    const VecX at = rows.A * phi;
    if (levels) {  // each at one value, zero between them
      for (const int sheet : {0, 1})
        for (Eigen::Index r = 0; r < at.size(); ++r)
          if (rows.part[r] == sheet) {
            EXPECT_NEAR(at[r], at[at.size() - 1] * (sheet == 0 ? -1 : 1), 0.005);
          }
    }
    return at.maxCoeff() - at.minCoeff();
  };
  const double none = spread(SpaceConstraint::none, 1), held = spread(SpaceConstraint::zero_set, 1);
  const double weak = spread(SpaceConstraint::soft, 0.1);
  const double strong = spread(SpaceConstraint::soft, 100);
  EXPECT_NEAR(none, 0.5, 0.1);
  EXPECT_NEAR(spread(SpaceConstraint::level_sets, 0), 0.5, 0.05);
  EXPECT_LT(held, 0.05);
  EXPECT_LT(strong, weak);
  EXPECT_LT(weak, none);
}

TEST(SignedHeatGrid, StopsWhenAsked) {
  const CancelToken token;
  token.cancel();
  Report report;
  EXPECT_THROW(
      signed_heat_grid(test::cube_grid(17, 2), test::sphere_samples(2), {}, Task(token), report),
      Cancelled);
}

}  // namespace
}  // namespace littoral
