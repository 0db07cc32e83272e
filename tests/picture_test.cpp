#include "io/render/picture.h"

#include <gtest/gtest.h>
#include <png.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <random>
#include <sstream>

#include "base/parallel.h"
#include "io/render/raster.h"
#include "io/render/scene_style.h"
#include "littoral/error.h"
#include "test_meshes.h"

namespace littoral {
namespace {

namespace fs = std::filesystem;

io::PictureOptions small() {
  io::PictureOptions options;
  options.width = 240;
  options.height = 180;
  options.colour_bar = false;
  return options;
}

// The unit square with the field x - 1/2, without isolines.
io::Scene square_scene() {
  io::Scene scene = io::make_scene(test::grid_soup(8, 8));
  scene.values = scene.points.col(0).array() - 0.5;
  scene.isolines = 0;
  return scene;
}

io::Rgb pixel(const io::Image& image, double x, double y) {
  const auto i = static_cast<std::size_t>(static_cast<int>(y * image.height) * image.width +
                                          static_cast<int>(x * image.width));
  return {image.rgb[3 * i], image.rgb[3 * i + 1], image.rgb[3 * i + 2]};
}

int difference(const io::Rgb& a, const io::Rgb& b) {
  int worst = 0;
  for (std::size_t k = 0; k < 3; ++k) worst = std::max(worst, std::abs(int{a[k]} - int{b[k]}));
  return worst;
}

int dark_pixels(const io::Image& image) {
  int count = 0;
  for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
    count += image.rgb[i] < 70 && image.rgb[i + 1] < 70 && image.rgb[i + 2] < 70;
  }
  return count;
}

int count_like(const io::Image& image, const io::Rgb& colour) {
  int count = 0;
  for (std::size_t i = 0; i < image.rgb.size(); i += 3) {
    count += difference({image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]}, colour) < 12;
  }
  return count;
}

TEST(Picture, FlatFieldColoursAreTheMap) {
  const io::Image image = io::draw_picture(square_scene(), small());
  ASSERT_EQ(image.rgb.size(), 240u * 180u * 3u);
  const auto& map = io::colour_map(io::ColourMap::diverging);
  EXPECT_LE(difference(pixel(image, 0.5, 0.5), map[128]), 3);
  EXPECT_LE(difference(pixel(image, 0.175, 0.5), map[4]), 16);    // x near 0: left
  EXPECT_LE(difference(pixel(image, 0.825, 0.5), map[251]), 16);  // x near 1: right
  EXPECT_GT(std::min({pixel(image, 0.02, 0.5)[0], pixel(image, 0.5, 0.02)[2]}), 240);  // paper
}

TEST(Picture, FlippedFacesLookTheSame) {
  io::Scene scene = io::make_scene(test::octasphere_soup(4));
  scene.values = scene.points.col(1);
  const io::Image straight = io::draw_picture(scene, small());
  for (Eigen::Index t = 0; t < scene.triangles.rows(); t += 3) {
    std::swap(scene.triangles(t, 0), scene.triangles(t, 1));
  }
  const io::Image flipped = io::draw_picture(scene, small());
  int worst = 0;
  for (std::size_t i = 0; i < straight.rgb.size(); ++i) {
    worst = std::max(worst, std::abs(int{straight.rgb[i]} - int{flipped.rgb[i]}));
  }
  EXPECT_LE(worst, 2);
}

TEST(Picture, ZeroLineIsDarkAndAtItsPlace) {
  io::Scene scene = square_scene();
  scene.isolines = 10;
  const io::Image image = io::draw_picture(scene, small());
  EXPECT_LT(pixel(image, 0.5, 0.5)[0], 90);
  EXPECT_LT(pixel(image, 0.5, 0.3)[0], 90);
  // Explicit levels: only those.
  scene.levels = {0.25};
  const io::Image one = io::draw_picture(scene, small());
  EXPECT_GT(pixel(one, 0.5, 0.5)[0], 200);
  scene.levels = {0.0};
  EXPECT_LT(pixel(io::draw_picture(scene, small()), 0.5, 0.5)[0], 90);
}

TEST(Picture, LinesKeepTheirWidthWhateverTheScale) {
  int count[3];
  int at = 0;
  for (const double scale : {1.0, 1e-6, 1e6}) {
    io::Scene scene = square_scene();
    scene.levels = {0.0};
    scene.points *= scale;
    scene.values *= scale;
    count[at++] = dark_pixels(io::draw_picture(scene, small()));
  }
  EXPECT_GT(count[0], 250);
  EXPECT_LT(count[0], 700);
  EXPECT_EQ(count[0], count[1]);
  EXPECT_EQ(count[0], count[2]);
}

// On a plane with uneven triangles the slope at vertices is that of the field, also where it turns.
TEST(Picture, WhatIsLevelAtZeroIsNotFilledWithTheLine) {
  io::Scene scene = square_scene();
  scene.isolines = 10;
  const int line = dark_pixels(io::draw_picture(scene, small()));
  for (double& x : scene.values)
    if (std::abs(x) < 0.2) x = 0;  // a band of zeros, two cells wide
  const io::Image image = io::draw_picture(scene, small());
  EXPECT_GT(pixel(image, 0.54, 0.45)[0], 200);
  EXPECT_LT(dark_pixels(image), 3 * line);
}

TEST(Picture, WhereAFieldIsAsSmallAsItGetsThereIsNoLine) {
  io::Scene scene = square_scene();
  scene.isolines = 10;
  for (double& x : scene.values) x = std::max(x, 0.0);
  const io::Image image = io::draw_picture(scene, small());
  for (const double x : {0.492, 0.496, 0.5, 0.504}) EXPECT_GT(pixel(image, x, 0.45)[0], 200) << x;
}

TEST(Picture, SlopesAtVerticesAreTheFieldsOwn) {
  PolygonSoup soup = test::grid_soup(6, 6);
  for (Eigen::Index v = 0; v < soup.points.rows(); ++v)
    soup.points(v, 1) += 0.03 * std::sin(40.0 * static_cast<double>(v));
  const io::Scene scene = io::make_scene(soup);
  const VecX linear = 1.0 * scene.points.col(0) + 2.0 * scene.points.col(1);
  const auto tensors = io::slope_tensors(scene.points, scene.triangles, linear, 2.0);
  const Eigen::Matrix<double, 1, 6> expected{{4, 16, 0, 8, 0, 0}};  // per radius: times 2 squared
  EXPECT_LT((tensors.rowwise() - expected).cwiseAbs().maxCoeff(), 1e-9);
  const VecX kink = (scene.points.col(0).array() - 0.5).abs();
  const auto turned = io::slope_tensors(scene.points, scene.triangles, kink, 1.0);
  for (Eigen::Index v = 0; v < turned.rows(); ++v) EXPECT_NEAR(turned(v, 0), 1, 1e-9);
}

TEST(Picture, RegionsHaveColoursOfTheirOwn) {
  io::Scene scene = square_scene();
  scene.field_name = "region";
  scene.values = scene.points.col(0).unaryExpr([](double x) { return x < 0.45 ? -1.0 : 1.0; });
  const io::Image image = io::draw_picture(scene, small());
  EXPECT_LT(difference(pixel(image, 0.35, 0.5), io::region_colour(-1)), 8);
  EXPECT_LT(difference(pixel(image, 0.65, 0.5), io::region_colour(1)), 8);
}

TEST(Picture, SourcesAreVisibleInFrontAndHiddenBehind) {
  io::Scene scene = io::make_scene(test::octasphere_soup(4));
  io::PictureOptions options = small();
  options.towards_eye = Vec3(0, 0, 1);
  options.up = Vec3(0, 1, 0);
  MatX3 line(2, 3);
  line << -0.3, 0, 0.96, 0.3, 0, 0.96;
  scene.curves = {{line, true}};
  scene.source_points = MatX3(1, 3);
  scene.source_points << 0, 0.4, 0.92;
  io::Image image = io::draw_picture(scene, options);
  EXPECT_GT(count_like(image, io::signed_colour), 60);
  EXPECT_GT(count_like(image, io::unsigned_colour), 30);
  options.towards_eye = Vec3(0, 0, -1);
  image = io::draw_picture(scene, options);
  EXPECT_EQ(count_like(image, io::signed_colour), 0);
  EXPECT_EQ(count_like(image, io::unsigned_colour), 0);
}

TEST(Picture, InfiniteValuesAreHatchedGrey) {
  io::Scene scene = square_scene();
  for (Eigen::Index v = 0; v < scene.values.size(); ++v) {
    if (scene.points(v, 0) > 0.6) scene.values[v] = std::numeric_limits<double>::infinity();
  }
  const io::Image hatched = io::draw_picture(scene, small());
  int light = 0, dark = 0;
  for (int i = 0; i < 36; ++i) {
    const io::Rgb colour = pixel(hatched, 0.7 + 0.004 * i, 0.5);
    EXPECT_LE(std::abs(int{colour[0]} - int{colour[2]}), 6);
    light += difference(colour, io::infinite_colour) <= 4;
    dark += difference(colour, {108, 108, 108}) <= 4;
  }
  EXPECT_GT(light, 12);
  EXPECT_GT(dark, 3);
  scene.values.resize(0);
  EXPECT_LE(difference(pixel(io::draw_picture(scene, small()), 0.8, 0.5), io::plain_colour), 2);
}

TEST(PictureSlow, SameBytesForAnyThreadCount) {
  io::Scene scene = io::make_scene(test::torus_soup(60, 40));
  scene.values = scene.points.col(0);
  scene.source_points = scene.points.topRows(3);
  set_thread_count(1);
  const std::string one = io::encode_png(io::draw_picture(scene));
  set_thread_count(2);
  const std::string two = io::encode_png(io::draw_picture(scene));
  set_thread_count(0);
  EXPECT_EQ(one, two);
}

TEST(Picture, FileIsAPngOfTheSizeAskedFor) {
  const fs::path path = fs::path(testing::TempDir()) / "littoral_picture_test.png";
  io::PictureOptions options = small();
  options.colour_bar = true;
  const io::Scene scene = square_scene();
  io::write_picture(path, scene, options);
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  ASSERT_TRUE(png_image_begin_read_from_file(&header, path.c_str()));
  EXPECT_EQ(header.width, 240u);
  EXPECT_EQ(header.height, 180u);
  header.format = PNG_FORMAT_RGB;
  std::vector<unsigned char> rgb(PNG_IMAGE_SIZE(header));
  ASSERT_TRUE(png_image_finish_read(&header, nullptr, rgb.data(), 0, nullptr));
  EXPECT_EQ(rgb, io::draw_picture(scene, options).rgb);
  fs::remove(path);
  EXPECT_THROW(io::write_picture("/nonexistent-folder/picture.png", scene, options), IoError);
}

TEST(Picture, PngOfAnyImageIsReadByLibpng) {
  std::mt19937 random(3);
  for (const auto& [width, height] : {std::pair{1, 1}, {7, 1}, {1, 9}, {64, 48}, {301, 200}})
    for (const int kind : {0, 1, 2}) {  // noise, ramps along x and y, their sum with noise
      io::Image image{width, height, {}};
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
          for (int c = 0; c < 3; ++c) {
            const unsigned noise = random();
            const int ramp = (x * (c + 1) + 3 * y) % 256;
            image.rgb.push_back(static_cast<unsigned char>(
                kind == 0 ? noise : ramp + (kind == 1 ? 0 : static_cast<int>(noise % 5))));
          }
      const std::string bytes = io::encode_png(image);
      png_image header{};
      header.version = PNG_IMAGE_VERSION;
      ASSERT_TRUE(png_image_begin_read_from_memory(&header, bytes.data(), bytes.size()));
      EXPECT_EQ(header.warning_or_error, 0u) << header.message;
      EXPECT_EQ(static_cast<int>(header.width), width);
      EXPECT_EQ(static_cast<int>(header.height), height);
      header.format = PNG_FORMAT_RGB;
      std::vector<unsigned char> rgb(PNG_IMAGE_SIZE(header));
      ASSERT_TRUE(png_image_finish_read(&header, nullptr, rgb.data(), 0, nullptr));
      EXPECT_EQ(rgb, image.rgb);
      // The differences of a ramp are few numbers.
      if (kind == 1 && width > 100) {
        EXPECT_LT(bytes.size(), image.rgb.size() / 50);
      }
    }
}

TEST(Picture, RefusesBadOptionsAndScenes) {
  const io::Scene scene = square_scene();
  const auto refused = [&](void (*spoil)(io::PictureOptions&)) {
    io::PictureOptions options = small();
    spoil(options);
    EXPECT_THROW(io::draw_picture(scene, options), InputError);
  };
  refused([](io::PictureOptions& o) { o.width = 0; });
  refused([](io::PictureOptions& o) { o.height = 1 << 20; });
  refused([](io::PictureOptions& o) { o.width = o.height = 16000; });
  refused([](io::PictureOptions& o) { o.supersampling = 0; });
  refused([](io::PictureOptions& o) { o.towards_eye = Vec3::Zero(); });
  refused([](io::PictureOptions& o) { o.up = Vec3(0, 0, std::nan("")); });
  refused([](io::PictureOptions& o) { o.towards_eye = o.up = Vec3(1, 2, 3); });
  io::Scene bad = scene;
  bad.values[3] = std::nan("");
  EXPECT_THROW(io::draw_picture(bad, small()), InputError);
  EXPECT_THROW(io::draw_picture(io::Scene{}, small()), InputError);
}

TEST(Picture, DegenerateAndExtremeInputsGiveAPicture) {
  for (const double scale : {0.0, 1e-300, 1e-160, 1e150, 1e300}) {
    io::Scene scene = square_scene();
    scene.points *= scale;
    scene.values *= scale;
    EXPECT_EQ(io::draw_picture(scene, small()).rgb.size(), 240u * 180u * 3u);
  }
  io::Scene needle = square_scene();
  needle.points.col(1).setZero();
  EXPECT_EQ(io::draw_picture(needle, small()).rgb.size(), 240u * 180u * 3u);
  io::PictureOptions tiny;
  tiny.width = tiny.height = 16;
  EXPECT_EQ(io::draw_picture(square_scene(), tiny).rgb.size(), 16u * 16u * 3u);
}

// Around a corner of weight 0 the value is constant along rays: that of the opposite side.
TEST(Picture, CornersWithoutWeightTakeEveryValue) {
  PolygonSoup soup;
  soup.points.resize(3, 3);
  soup.points << 0, 0, 0, 1, 0, 0, 0, 1, 0;
  test::add_triangle(soup, 0, 1, 2);
  soup.scalars["winding"] = Vec3(5, 0, 1);  // the 5 counts for nothing
  soup.scalars["weight"] = Vec3(0, 1, 1);
  io::Scene scene = io::make_scene(soup, "winding");
  scene.isolines = 0;
  scene.values[0] = 0.5;
  const io::Image image = io::draw_picture(scene, small());
  scene.weights.resize(0);
  scene.triangles.row(0) << 0, 1, 2;
  const io::Image linear = io::draw_picture(scene, small());
  EXPECT_NE(image.rgb, linear.rgb);
  // A scene of many thin triangles with the exact values looks the same.
  constexpr int n = 400;
  io::Scene fan;
  fan.points.resize(2 * n + 2, 3);
  fan.values.resize(2 * n + 2);
  fan.triangles.resize(n, 3);
  for (int i = 0; i <= n; ++i) {
    const double s = double(i) / n;
    fan.points.row(2 * i) << 0, 0, 0;
    fan.points.row(2 * i + 1) << 1 - s, s, 0;
    fan.values[2 * i] = fan.values[2 * i + 1] = s;
    if (i < n) fan.triangles.row(i) << 2 * i, 2 * i + 1, 2 * i + 3;
  }
  fan.isolines = 0;
  const io::Image expected = io::draw_picture(fan, small());
  int far = 0;
  for (std::size_t i = 0; i < image.rgb.size(); ++i)
    far += std::abs(int{image.rgb[i]} - int{expected.rgb[i]}) > 8;
  EXPECT_LT(far, 60);
}

}  // namespace
}  // namespace littoral
