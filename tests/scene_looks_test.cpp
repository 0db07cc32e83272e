#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "constants.h"
#include "io/render/discs.h"
#include "io/render/openness.h"
#include "io/render/scene.h"
#include "io/render/scene_style.h"
#include "littoral/error.h"
#include "test_meshes.h"

namespace littoral {
namespace {

using test::infinity;

// How much of the sky a wall sees that nothing stands before, and the floor of a ditch between two.
TEST(Openness, OfWallsRoomsAndSheets) {
  const auto at = [](const io::Openness& open, int v, const Vec3& n) {
    return io::open_part(open.row(v).transpose(), n);
  };
  const PolygonSoup ball = test::octasphere_soup(4);
  const io::Scene sphere = io::make_scene(ball);
  const io::Openness open = io::openness(sphere.points, sphere.triangles);
  for (int v = 0; v < sphere.points.rows(); ++v) {
    const Vec3 out = sphere.points.row(v);
    EXPECT_GT(at(open, v, out), 0.9f) << v;
    EXPECT_LT(at(open, v, Vec3(-out)), 0.2f) << v;  // pixels are not small
  }
  // A long strip of floor between walls half as high as it is wide: in its middle everything below
  // is seen, and above up to 45 degrees to both sides. Projected to linear functions of directions
  // that is 3/4 + 3 (-1/4 + sqrt(2)/8) z.
  MatX3 points(0, 3);
  MatX3i triangles(0, 3);
  const auto add = [&](const Vec3& a, const Vec3& u, const Vec3& v) {
    constexpr int n = 20;
    const auto first = static_cast<int>(points.rows());
    points.conservativeResize(first + (n + 1) * (n + 1), 3);
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i)
        points.row(first + i + (n + 1) * j) = (a + i * u / n + j * v / n).transpose();
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        const int p = first + i + (n + 1) * j;
        const Eigen::Index t = triangles.rows();
        triangles.conservativeResize(t + 2, 3);
        triangles.row(t) << p, p + 1, p + n + 2;
        triangles.row(t + 1) << p, p + n + 2, p + n + 1;
      }
    }
  };
  const Vec3 x = Vec3::UnitX(), y = 8 * Vec3::UnitY(), z = Vec3::UnitZ();
  add(-0.5 * x - 0.5 * y, x, y);
  add(-0.5 * x - 0.5 * y, 0.5 * z, y);
  add(0.5 * x - 0.5 * y, 0.5 * z, y);
  const io::Openness ditch = io::openness(points, triangles);
  const int middle = 10 + 21 * 10;
  const double tilt = 3 * (-0.25 + std::sqrt(2) / 8);
  EXPECT_NEAR(at(ditch, middle, z), 0.75 + 2 * tilt / 3, 0.03);
  EXPECT_NEAR(at(ditch, middle, -z), 0.75 - 2 * tilt / 3, 0.03);
  // Nothing but a sheet, whichever way its faces are turned.
  for (Eigen::Index t = 0; t < triangles.rows(); t += 3)
    std::swap(triangles(t, 0), triangles(t, 1));
  const io::Openness sheet = io::openness(points, triangles.topRows(800));
  EXPECT_GT(at(sheet, middle, z), 0.97f);
  EXPECT_GT(at(sheet, middle, -z), 0.97f);
  EXPECT_EQ(io::openness(points, triangles.topRows(800)).row(points.rows() - 1)[3], 1);  // unused
}

TEST(SceneDiscs, LieAlongTheSurfaceAndCoverIt) {
  io::Scene scene = io::make_scene(test::octasphere_soup(4));
  scene.values = scene.points.col(2);
  scene.points.conservativeResize(scene.points.rows() + 1, 3);  // and a point of no triangle
  scene.points.bottomRows(1) << 2, 0, 0;
  scene.values.conservativeResize(scene.points.rows());
  scene.values.tail(1) << infinity;
  io::show_as_discs(scene);
  const Eigen::Index n = scene.points.rows() - 1;
  double least = infinity, most = 0;
  for (Eigen::Index v = 0; v < n; ++v) {
    EXPECT_GT(std::abs(scene.discs.row(v).head<3>().dot(scene.points.row(v))), 0.98) << v;
    least = std::min(least, scene.discs(v, 3));
    most = std::max(most, scene.discs(v, 3));
  }
  EXPECT_LT(most, 2 * least);
  for (Eigen::Index t = 0; t < scene.triangles.rows(); ++t)
    for (int i = 0; i <= 6; ++i)
      for (int j = 0; i + j <= 6; ++j) {
        const Eigen::RowVector3i corners = scene.triangles.row(t);
        const Vec3 x = (i * scene.points.row(corners[0]) + j * scene.points.row(corners[1]) +
                        (6 - i - j) * scene.points.row(corners[2])) /
                       6;
        const auto covered = [&](int v) {
          return (x - scene.points.row(v).transpose()).norm() <= scene.discs(v, 3);
        };
        EXPECT_TRUE(std::any_of(corners.begin(), corners.end(), covered)) << t;
      }
  EXPECT_GT(scene.discs(n, 3), least);
  EXPECT_LT(scene.discs(n, 3), most);
  EXPECT_NO_THROW(io::check_scene(scene));
  const io::Scene drawn = io::discs_as_triangles(scene);
  ASSERT_EQ(drawn.points.rows(), 12 * (n + 1));
  for (Eigen::Index i = 0; i < 12 * n; ++i)  // the field goes on as the height does
    EXPECT_NEAR(drawn.values[i], drawn.points(i, 2), 0.03);
  EXPECT_EQ(drawn.values[12 * n], infinity);
  scene.discs(3, 1) = infinity;
  EXPECT_THROW(io::check_scene(scene), InputError);
}

TEST(SceneDiscs, CoverPointsThatAreFurtherApartOneWay) {
  PolygonSoup rows;
  rows.points.resize(9, 3);
  for (int v = 0; v < 9; ++v) rows.points.row(v) << v % 3, 0.4 * double(v / 3), 0;
  for (const int a : {0, 1, 3, 4}) {
    rows.add_face(std::array{a, a + 1, a + 4});
    rows.add_face(std::array{a, a + 4, a + 3});
  }
  io::Scene scene = io::make_scene(rows);
  const double scale = (scene.points.row(2) - scene.points.row(0)).norm() / 2;
  io::show_as_discs(scene);
  for (int v = 0; v < 9; ++v)
    EXPECT_NEAR(scene.discs(v, 3) / scale, 1.05 * std::hypot(0.5, 0.2), 1e-12);
}

TEST(SceneStyle, NiceSpacing) {
  EXPECT_DOUBLE_EQ(io::nice_spacing(0, 1, 10), 0.1);
  EXPECT_DOUBLE_EQ(io::nice_spacing(-3, 3, 20), 0.25);
  EXPECT_DOUBLE_EQ(io::nice_spacing(0, 1e300, 10), 1e299);
  EXPECT_EQ(io::nice_spacing(1, 1, 10), 0);
  EXPECT_EQ(io::nice_spacing(0, 1, 0), 0);
  EXPECT_EQ(io::nice_spacing(0, infinity, 10), 0);
  EXPECT_GT(io::nice_spacing(-1.7e308, 1.7e308, 10), 0);
  for (double count = 1; count < 300; count *= 1.3) {
    const double parts = 7.3 / io::nice_spacing(-2, 5.3, count);
    EXPECT_GT(parts / count, 0.6);
    EXPECT_LT(parts / count, 1.6);
  }
  EXPECT_EQ(io::nice_ticks(-0.5, 1, 0.5), (std::vector<double>{-0.5, 0, 0.5, 1}));
  EXPECT_TRUE(io::nice_ticks(0, 1, 0).empty());
  EXPECT_TRUE(io::nice_ticks(0, 1, 1e-9).empty());
}

TEST(SceneStyle, LabelsHaveTheDigitsThatTellThemApart) {
  EXPECT_EQ(io::label_text(0.1 + 0.2), "0.3");
  EXPECT_EQ(io::label_text(100000.5, 0.05), "100000.5");
  EXPECT_EQ(io::label_text(-99999.5, 0.05), "-99999.5");
  EXPECT_EQ(io::label_text(0, 0.05), "0");
}

// Shown first or among others, and where it is nothing but 0 and 1.
TEST(SceneStyle, ConfidenceHasColoursFromZeroToOne) {
  io::Scene scene = io::make_scene(test::octasphere_soup(4));
  scene.field_name = "confidence";
  for (const double least : {0.5, 0.0}) {
    scene.values =
        (scene.points.col(0).array() > 0.3).select(VecX::Ones(scene.points.rows()), least);
    for (const io::FieldStyle& style :
         {io::field_style(scene), io::field_style(scene, {"confidence", scene.values}),
          io::field_style(scene.values, "confidence")}) {
      EXPECT_FALSE(style.discrete);
      EXPECT_FALSE(style.diverging);
      EXPECT_EQ(style.colour_low, 0);
      EXPECT_EQ(style.colour_high, 1);
    }
  }
  scene.colour_range = {0.4, 0.6};
  EXPECT_EQ(io::field_style(scene).colour_low, 0.4);
  scene.values *= 100;  // of another program, in percent
  EXPECT_EQ(io::field_style(scene.values, "confidence").colour_high, 100);
}

TEST(SceneStyle, SequentialMapsGetSteadilyLighterOrDarker) {
  for (const io::ColourMap map :
       {io::ColourMap::sequential, io::ColourMap::viridis, io::ColourMap::cividis,
        io::ColourMap::grey, io::ColourMap::heat}) {
    const auto& colours = io::colour_map(map);
    const auto light = [&](int i) {
      const io::Rgb& c = colours[i];
      return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
    };
    const double way = light(255) > light(0) ? 1 : -1;
    EXPECT_GT(way * (light(255) - light(0)), 120) << io::colour_map_name(map);
    for (int i = 8; i < 256; i += 8)
      EXPECT_GT(way * (light(i) - light(i - 8)), 0) << io::colour_map_name(map) << ' ' << i;
  }
}

}  // namespace
}  // namespace littoral
