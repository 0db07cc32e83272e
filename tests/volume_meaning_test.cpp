// What the values of a volume stand for.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <utility>

#include "base/option_table.h"
#include "littoral/error.h"
#include "littoral/littoral.h"

namespace littoral {
namespace {

template <class F>
Volume sampled(const F& value) {
  Volume volume;
  volume.grid = {{33, 33, 33}, Vec3::Constant(-1), Vec3::Constant(1.0 / 16)};
  volume.values.resize(static_cast<Eigen::Index>(volume.grid.n_nodes()));
  for (int k = 0; k < 33; ++k)
    for (int j = 0; j < 33; ++j)
      for (int i = 0; i < 33; ++i)
        volume.values[static_cast<Eigen::Index>(volume.grid.node(i, j, k))] =
            value(volume.grid.point(i, j, k));
  return volume;
}

TEST(VolumeMeaning, MessagesHaveFourDigitsOfAMeasuredValue) {
  for (const auto& [value, text] : std::initializer_list<std::pair<double, const char*>>{
           {0.25018308123652166, "0.2502"},
           {-123456, "-123500"},
           {2e-7 / 3, "6.667e-08"},
           {0.1, "0.1"},
           {0, "0"},
           {1e300, "1e+300"},
           {-1e-300, "-1e-300"},
           {std::numeric_limits<double>::infinity(), "inf"}})
    EXPECT_EQ(rounded_text(value), text);
}

const Vec3 outside(0.9, 0.1, 0);

TEST(VolumeMeaning, MasksAreMeasuredFromBetweenTheirVoxels) {
  const Volume ball = sampled([](const Vec3& x) { return x.norm() < 0.6 ? 1.0 : 0.0; });
  for (const VolumeMeaning meaning : {VolumeMeaning::automatic, VolumeMeaning::mask}) {
    const Sdf distance = signed_distance(ball, meaning);
    EXPECT_NEAR(distance(Vec3::Zero()), -0.6, 0.04);
    EXPECT_NEAR(distance(outside), outside.norm() - 0.6, 0.04);
  }
  // Taken for distance it would be 0 outside.
  EXPECT_NEAR(signed_distance(ball, VolumeMeaning::distance)(outside), 0, 1e-12);
}

TEST(VolumeMeaning, DistanceIsKnownByItsSlope) {
  const Volume ball = sampled([](const Vec3& x) { return x.norm() - 0.6; });
  EXPECT_NEAR(signed_distance(ball, VolumeMeaning::automatic)(outside), outside.norm() - 0.6, 1e-3);
  for (const double scale : {0.1, 0.5, 2.0, 10.0}) {
    Volume scaled = ball;
    scaled.values *= scale;
    EXPECT_THROW(signed_distance(scaled, VolumeMeaning::automatic), InputError) << scale;
  }
  // Slope 1 at the zero set alone will not do.
  const Volume quadric = sampled([](const Vec3& x) { return x.squaredNorm() - 0.25; });
  EXPECT_THROW(signed_distance(quadric, VolumeMeaning::automatic), InputError);
}

TEST(VolumeMeaning, DensityIsLargerInside) {
  const Volume blob = sampled([](const Vec3& x) { return std::exp(-x.norm()); });
  EXPECT_THROW(signed_distance(blob, VolumeMeaning::automatic), InputError);
  const Sdf distance = signed_distance(blob, VolumeMeaning::density, std::exp(-0.5));
  EXPECT_NEAR(distance(outside), outside.norm() - 0.5, 0.01);
  EXPECT_THROW(signed_distance(blob, VolumeMeaning::density, 1.5), InputError);
  EXPECT_THROW(signed_distance(blob, VolumeMeaning::mask, 0.5), InputError);
}

TEST(VolumeMeaning, WallsAreClosedAndHollow) {
  const Volume ball = sampled([](const Vec3& x) { return x.norm() - 0.6; });
  const Mesh mesh = wall(ball, 0.2);
  const PolygonSoup& hollow = mesh.soup();
  double volume = 0;  // by the divergence theorem
  for (int f = 0; f < hollow.n_faces(); ++f) {
    const auto c = hollow.face(f);
    const Vec3 a = hollow.points.row(c[0]), b = hollow.points.row(c[1]),
               d = hollow.points.row(c[2]);
    volume += a.dot(b.cross(d)) / 6;
  }
  EXPECT_NEAR(volume, 4 * std::acos(-1.0) / 3 * (std::pow(0.7, 3) - std::pow(0.5, 3)), 0.01);
  EXPECT_THROW(wall(ball, 0), InputError);
  EXPECT_THROW(wall(ball, 0.1, -2), InputError);
}

}  // namespace
}  // namespace littoral
