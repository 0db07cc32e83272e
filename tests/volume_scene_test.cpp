#include "io/render/volume_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>

#include "constants.h"
#include "io/render/picture.h"
#include "io/render/scene_style.h"
#include "littoral/error.h"
#include "volume_helpers.h"

namespace littoral {
namespace {

using test::infinity;

Volume ball(int n) {
  const Grid grid{{n, n, n}, Vec3::Constant(-1), Vec3::Constant(2.0 / (n - 1))};
  return test::sampled(grid, [](const Vec3& p) { return p.norm() - 0.6; });
}

TEST(VolumeScene, SliceAndTheSurfaceBeforeIt) {
  const io::Scene scene = io::make_volume_scene(ball(21), {.axis = 0, .position = 0.22});
  io::check_scene(scene);
  double nearest = 1;
  int on_surface = 0;
  for (Eigen::Index v = 0; v < scene.points.rows(); ++v) {
    const Vec3 p = scene.points.row(v);
    nearest = std::min(nearest, p[0]);
    EXPECT_NEAR(scene.values[v], p.norm() - 0.6, 6e-3);
    if (p[0] > 0.21) {
      EXPECT_EQ(scene.values[v], 0);
      ++on_surface;
    }
  }
  EXPECT_NEAR(nearest, 0.2, 1e-12);  // the nearest layer of nodes
  EXPECT_GT(on_surface, 100);
  EXPECT_NEAR(io::field_style(scene).high, std::sqrt(3.0) - 0.6, 1e-12);
}

TEST(VolumeScene, LevelsAndSwitches) {
  const Volume volume = ball(11);
  EXPECT_EQ(io::make_volume_scene(volume).volume->level, 0);
  Volume above = volume;
  above.values.array() += 5;
  const auto known = io::make_volume_scene(above).volume;
  EXPECT_NEAR(known->level, 0.5 * (known->low + known->high), 1e-12);
  EXPECT_EQ(io::make_volume_scene(volume, {.isosurface = false}).triangles.rows(), 200);
  Volume infinite = volume;
  infinite.values[0] = infinity;
  EXPECT_EQ(io::make_volume_scene(infinite).triangles.rows(), 200);
  EXPECT_TRUE(io::field_style(io::make_volume_scene(infinite)).infinite);
}

TEST(VolumeScene, PagesGetAThinnedCopyOfTheSameBox) {
  const Grid grid{{300, 5, 2}, Vec3(1, 2, 3), Vec3(0.01, 0.1, 0.2)};
  const auto plane = [](const Vec3& p) { return 2 * p[0] - p[1] + p[2] - 2; };
  const auto thin = io::make_volume_scene(test::sampled(grid, plane)).volume->thin;
  EXPECT_EQ(thin.grid.n, (std::array<int, 3>{256, 5, 2}));
  const Volume exact = test::sampled(thin.grid, plane);
  EXPECT_LT((thin.values - exact.values).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_NEAR(thin.grid.point(255, 4, 1)[0], grid.point(299, 4, 1)[0], 1e-12);
}

TEST(VolumeScene, Refuses) {
  const Volume volume = ball(5);
  EXPECT_THROW(io::make_volume_scene(volume, {.axis = 3}), InputError);
  EXPECT_THROW(io::make_volume_scene(volume, {.position = 1.5}), InputError);
  EXPECT_THROW(io::make_volume_scene(volume, {.level = infinity}), InputError);
  Volume bad = volume;
  bad.values[3] = std::nan("");
  EXPECT_THROW(io::make_volume_scene(bad), InputError);
  bad.values.setConstant(infinity);
  EXPECT_THROW(io::make_volume_scene(bad), InputError);
}

TEST(VolumeScene, PictureShowsBothSignsOrTheShell) {
  struct Colours {
    int blue = 0, orange = 0, grey = 0;
  };
  const auto drawn = [](bool shell) {
    const io::Image image = io::draw_picture(io::make_volume_scene(ball(21), {.isosurface = shell}),
                                             {.width = 160, .height = 120, .colour_bar = false});
    Colours seen;
    for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
      const int red = image.rgb[i], blue = image.rgb[i + 2];
      seen.blue += blue > red + 60;
      seen.orange += red > blue + 60;
      seen.grey += std::abs(red - blue) < 20 && red < 235;
    }
    return seen;
  };
  const Colours slice = drawn(false), both = drawn(true);
  EXPECT_GT(slice.blue, 300);
  EXPECT_GT(slice.orange, 300);
  EXPECT_EQ(both.blue, 0);  // the shell stands before the inside
  EXPECT_GT(both.orange, 300);
  EXPECT_GT(both.grey, slice.grey + 300);
}

// A page for the browser's test (viewer/test/volume.test.mjs), where one is asked for.
TEST(VolumePageForBrowserTest, IsWritten) {
  const char* path = std::getenv("LITTORAL_VOLUME_PAGE_OUT");
  if (!path) GTEST_SKIP() << "LITTORAL_VOLUME_PAGE_OUT is not set";
  io::Scene scene = io::make_volume_scene(ball(65));
  scene.title = "ball";
  io::write_page(path, scene);
}

}  // namespace
}  // namespace littoral
