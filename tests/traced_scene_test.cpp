// Pictures of fields, sphere traced.
#include "api/space/traced_scene.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>

#include "base/parallel.h"
#include "constants.h"
#include "io/render/camera.h"
#include "io/render/picture.h"
#include "littoral/error.h"
#include "test_meshes.h"

namespace littoral {
namespace {

using test::pi;

/// n points on the torus of radii 0.8 and 0.3 about z, evenly enough.
PolygonSoup torus_cloud(int n) {
  PolygonSoup cloud;
  cloud.points.resize(n, 3);
  cloud.normals.resize(n, 3);
  for (int i = 0; i < n; ++i) {
    const double u = 2 * pi * (i + 0.5) / n, wound = 2 * pi * std::fmod(i * 0.6180339887498949, 1);
    // Equal areas: the angle round the tube whose area below it is the share `wound`.
    double v = wound;
    for (int k = 0; k < 20; ++k)
      v -= (0.8 * v + 0.3 * std::sin(v) - 0.8 * wound) / (0.8 + 0.3 * std::cos(v));
    const Vec3 normal(std::cos(v) * std::cos(u), std::cos(v) * std::sin(u), std::sin(v));
    cloud.points.row(i) = Vec3(0.8 * std::cos(u), 0.8 * std::sin(u), 0) + 0.3 * normal;
    cloud.normals.row(i) = normal;
  }
  return cloud;
}

CsgShapes shapes_of(PolygonSoup cloud) {
  CsgShapes shapes;
  shapes.all.resize(1);
  shapes.all[0].surface = std::move(cloud);
  shapes.all[0].request.method = Tori{};
  return shapes;
}

/// Two tori of points side by side, rounded where they meet and a little fatter, less a third.
CsgShapes bitten_pair(int n) {
  CsgShapes shapes = shapes_of(torus_cloud(n));
  for (const double x : {1.1, 0.5}) {
    PolygonSoup moved = torus_cloud(n);
    moved.points.col(0).array() += x;
    if (x < 1) moved.points.col(2).array() += 0.35;
    shapes.all.push_back(shapes_of(std::move(moved)).all.front());
  }
  shapes.csg.operations = {Boolean::unite, Boolean::subtract};
  shapes.csg.blend = 0.1;
  shapes.csg.offset = 0.02;
  return shapes;
}

io::Scene scene_of(const CsgShapes& shapes, const TracedView& view, int resolution = 24) {
  GridOptions request;
  request.resolution = resolution;
  request.padding = 0.15;
  Report report;
  return traced_scene(shapes, choose_grid(shapes, request), view, {}, report);
}

int inked(const io::Image& image) {
  int count = 0;
  for (std::size_t i = 0; i < image.rgb.size(); i += 3) count += image.rgb[i] < 240;
  return count;
}

TEST(TracedScene, RaysMeetTheTorus) {
  const io::Scene scene = scene_of(shapes_of(torus_cloud(3000)), {});
  ASSERT_NE(scene.trace, nullptr);
  Vec3 normal;
  for (double x : {0.55, 0.7, 0.8, 0.95, 1.05}) {
    const double t = scene.trace->hit({x, 0, 3}, -Vec3::UnitZ(), 0, 10, 1e-4, normal);
    EXPECT_NEAR(3 - t, std::sqrt(0.09 - (x - 0.8) * (x - 0.8)), 3e-3) << x;
    EXPECT_NEAR((normal - Vec3(x - 0.8, 0, 3 - t) / 0.3).norm(), 0, 0.03) << x;
  }
  for (double x : {0.0, 0.45, 1.15})
    EXPECT_EQ(scene.trace->hit({x, 0, 3}, -Vec3::UnitZ(), 0, 10, 1e-4, normal),
              std::numeric_limits<double>::infinity());
}

/// n points on an ellipsoid with axes 1, 1 and `flat`, evenly enough.
PolygonSoup lens_cloud(int n, double flat) {
  PolygonSoup cloud;
  cloud.points.resize(n, 3);
  cloud.normals.resize(n, 3);
  for (int i = 0; i < n; ++i) {
    const double z = 1 - (2 * i + 1.0) / n, r = std::sqrt(1 - z * z);
    const double angle = pi * (3 - std::sqrt(5.0)) * i;
    const Vec3 on_sphere(r * std::cos(angle), r * std::sin(angle), z);
    cloud.points.row(i) = Vec3(on_sphere[0], on_sphere[1], flat * z);
    cloud.normals.row(i) = Vec3(flat * on_sphere[0], flat * on_sphere[1], z).normalized();
  }
  return cloud;
}

TEST(TracedScene, CloudsThinnerThanTheGridHaveNoHolesInPictures) {
  const double flat = 0.08;  // cells are 0.11 wide
  CsgShapes shapes = shapes_of(lens_cloud(2000, flat));
  shapes.all[0].request.method = {};
  const io::Scene scene = scene_of(shapes, {});
  Vec3 normal;
  for (const double r : {0.3, 0.8, 0.85, 0.9})
    for (int k = 0; k < 60; ++k) {
      const double x = r * std::cos(k * pi / 30), y = r * std::sin(k * pi / 30);
      const double height = flat * std::sqrt(1 - r * r);
      const Vec3 known = Vec3(flat * x, flat * y, height / flat).normalized();
      const double t = scene.trace->hit({x, y, 3}, -Vec3::UnitZ(), 0, 10, 1e-4, normal);
      EXPECT_NEAR(3 - t, height, 3e-3) << r << " " << k;
      EXPECT_NEAR((normal - known).norm(), 0, 0.1) << r << " " << k;
    }
}

TEST(TracedScene, PicturesShowTheSurfaceForAnyNumberOfThreads) {
  const io::Scene scene = scene_of(shapes_of(torus_cloud(600)), {});
  io::PictureOptions options{.width = 64, .height = 64};
  options.towards_eye = Vec3::UnitZ();
  options.up = Vec3::UnitY();
  const io::Image image = draw_picture(scene, options);
  const auto red = [&](int x, int y) { return image.rgb[3 * (x + 64 * y)]; };
  EXPECT_GT(red(32, 32), 240);  // through the hole
  EXPECT_LT(red(7, 32), 215);
  EXPECT_LT(red(57, 32), 215);
  EXPECT_GT(red(2, 2), 240);
  set_thread_count(1);
  const io::Image one = draw_picture(scene, options);
  set_thread_count(0);
  EXPECT_EQ(image.rgb, one.rgb);
}

// Half a cell thick and far out: the grid does not see it, the rays do, and so must the picture.
TEST(TracedScene, ThinPartsAreInThePicture) {
  PolygonSoup soup = test::octasphere_soup(3);
  const double thin = 0.004;
  const int first = soup.n_vertices();
  soup.points.conservativeResize(first + 4, 3);
  soup.points.bottomRows(4) << 0, -thin, 0.5, 0, thin, 0.5, thin, 0, 0.5, 0, 0, 3;
  for (const std::array<int, 3>& f :
       {std::array{0, 2, 1}, std::array{0, 1, 3}, std::array{1, 2, 3}, std::array{2, 0, 3}})
    soup.add_face(std::array{first + f[0], first + f[1], first + f[2]});
  CsgShapes shapes = shapes_of(std::move(soup));
  shapes.all[0].request.method = {};
  const io::Scene scene = scene_of(shapes, {}, 24);
  double reach = 0;
  for (const int v : scene.triangles.reshaped()) reach = std::max(reach, scene.points(v, 2));
  EXPECT_EQ(reach, 3);
  TracedView shrunk;
  shrunk.level = -0.2;  // it is gone
  const io::Scene less = scene_of(shapes, shrunk, 24);
  reach = 0;
  for (const int v : less.triangles.reshaped()) reach = std::max(reach, less.points(v, 2));
  EXPECT_LT(reach, 1);
}

TEST(TracedScene, OffsetsDifferencesAndCutsShow) {
  const io::PictureOptions options{.width = 80,
                                   .height = 80,
                                   .towards_eye = Vec3::UnitZ(),
                                   .up = Vec3::UnitY(),
                                   .supersampling = 1,
                                   .colour_bar = false};
  CsgShapes shapes = shapes_of(torus_cloud(600));
  const int whole = inked(draw_picture(scene_of(shapes, {}), options));
  CsgShapes bitten = shapes;
  bitten.all.push_back(shapes.all[0]);
  bitten.all[1].surface.points.col(0).array() += 0.8;
  bitten.csg.operations = {Boolean::subtract};
  GridOptions request;
  request.bounds = std::array<double, 6>{-1.2, -1.2, -0.4, 1.2, 1.2, 0.4};
  request.resolution = 24;
  Report report;
  const Grid grid = choose_grid(shapes, request);
  const int without = inked(draw_picture(traced_scene(bitten, grid, {}, {}, report), options));
  EXPECT_LT(without, 0.95 * whole);
  EXPECT_GT(without, 0.5 * whole);
  // Half of it, and a slice through the middle.
  TracedView cut;
  cut.position = 0;
  const io::Scene half = traced_scene(shapes, grid, cut, {}, report);
  Vec3 normal;
  EXPECT_TRUE(std::isfinite(half.trace->hit({0.8, 0, 3}, -Vec3::UnitZ(), 0, 10, 1e-4, normal)));
  EXPECT_GE(half.trace->low[2], -0.06);
  EXPECT_EQ(half.values.size(), half.points.rows());
  // An offset is larger by as much.
  TracedView grown;
  grown.level = 0.1;
  const io::Scene fat = traced_scene(shapes, grid, grown, {}, report);
  EXPECT_NEAR(fat.trace->hit({0.8, 0, 3}, -Vec3::UnitZ(), 0, 10, 1e-4, normal), 2.6, 0.01);
}

// Half of the sky is seen from a wall's foot, and a little more beside a slice that soon ends.
TEST(TracedScene, OccludedShadingDarkensTheCornerBesideTheSlice) {
  TracedView view;
  view.position = 0;
  io::Scene scene = scene_of(shapes_of(torus_cloud(800)), view, 49);  // there are nodes at 0
  scene.isolines = 0;
  const int width = 240, height = 180;
  const io::PictureOptions options{.width = width,
                                   .height = height,
                                   .towards_eye = Vec3(1, 0, 0.7),
                                   .up = Vec3::UnitZ(),
                                   .supersampling = 1,
                                   .colour_bar = false};
  const double margin = 0.04 * height + 4;
  const io::Camera camera =
      io::fit_camera(scene, options, {margin, margin, width - margin, height - margin});
  const auto drawn = [&](io::Shading shading) {
    scene.shading = shading;
    return draw_picture(scene, options);
  };
  const io::Image occluded = drawn(io::Shading::occluded), smooth = drawn(io::Shading::smooth);
  const auto part = [&](const Vec3& place) {
    const Vec3 at = camera.project(place);
    const auto pixel =
        3 * (static_cast<std::size_t>(at[0]) + width * static_cast<std::size_t>(at[1]));
    return double(occluded.rgb[pixel]) / double(smooth.rgb[pixel]);
  };
  const auto outside = [](double z) { return Vec3(0.8 + std::sqrt(0.09 - z * z), 0, z); };
  EXPECT_LT(part(outside(0.04)), 0.85);
  EXPECT_GT(part(outside(0.04)), 0.6);
  EXPECT_GT(part(outside(0.299)), 0.93);
  EXPECT_LT(part({1.13, 0, 0}), 0.85);  // and of the slice beside it
  // Without a slice, the hole is darker than the outside.
  scene = scene_of(shapes_of(torus_cloud(800)), {}, 24);
  const io::PictureOptions above{.width = 96,
                                 .height = 96,
                                 .towards_eye = Vec3::UnitZ(),
                                 .up = Vec3::UnitY(),
                                 .supersampling = 1,
                                 .colour_bar = false};
  const auto mean = [&](io::Shading shading, bool inner) {
    scene.shading = shading;
    const io::Image image = draw_picture(scene, above);
    double sum = 0, count = 0;
    for (int y = 0; y < 96; ++y) {
      for (int x = 0; x < 96; ++x) {
        const double r = std::hypot(x - 47.5, y - 47.5) / 44 * 1.1;
        const int red = image.rgb[3 * (x + 96 * y)];
        if (red > 240 || r > 1 || (inner ? r > 0.65 : r < 0.85)) continue;
        sum += red;
        ++count;
      }
    }
    EXPECT_GT(count, 1000);
    return sum / count;
  };
  const auto shade = [&](bool inner) {
    return mean(io::Shading::occluded, inner) / mean(io::Shading::smooth, inner);
  };
  EXPECT_LT(shade(true), shade(false) - 0.05);
  EXPECT_GT(shade(false), 0.9);
}

TEST(TracedScene, BadRequestsAreNamed) {
  const CsgShapes shapes = shapes_of(torus_cloud(500));
  TracedView view;
  view.level = 100;
  EXPECT_THROW(scene_of(shapes, view), InputError);
  view.level = std::nan("");
  EXPECT_THROW(scene_of(shapes, view), InputError);
  view.level = 0;
  view.position = 99;
  EXPECT_THROW(scene_of(shapes, view), InputError);
  TracedView page;
  page.for_page = true;
  CsgShapes many = shapes;
  many.all.resize(9, shapes.all[0]);
  many.csg.operations.assign(8, Boolean::unite);
  EXPECT_THROW(scene_of(many, page), UnsupportedError);
  CsgShapes with_mesh = shapes;
  with_mesh.all.push_back({test::octasphere_soup(1), {}, {}});
  with_mesh.csg.operations = {Boolean::unite};
  EXPECT_THROW(scene_of(with_mesh, page), UnsupportedError);
  CsgShapes planar = shapes;
  planar.all[0].request.method = Planar{};
  EXPECT_THROW(scene_of(planar, page), UnsupportedError);
  const io::Scene one = scene_of(shapes, page);
  ASSERT_EQ(one.trace->clouds.size(), 1u);
  EXPECT_EQ(one.trace->clouds[0].tori.rows(), 500);
  EXPECT_EQ(one.trace->clouds[0].samples.size(), 0);
  EXPECT_THROW(scene_of(shapes_of({}), {}), InputError);
}

TEST(TracedScene, PagesHaveEachCloudOfACombination) {
  CsgShapes shapes = bitten_pair(500);
  shapes.all[1].request.method = AnyMethod::named("auto");
  TracedView page;
  page.for_page = true;
  const io::Scene scene = scene_of(shapes, page);
  const io::SceneTrace& trace = *scene.trace;
  ASSERT_EQ(trace.clouds.size(), 3u);
  EXPECT_EQ(trace.clouds[1].operation, "unite");
  EXPECT_EQ(trace.clouds[2].operation, "subtract");
  EXPECT_EQ(trace.blend, shapes.csg.blend);
  EXPECT_EQ(trace.offset, shapes.csg.offset);
  // What they are combined to is the volume.
  const VecX& values = scene.volume->thin.values;
  for (Eigen::Index v = 0; v < values.size(); v += 7) {
    std::vector<DistanceSample> fields;
    for (const io::TracedCloud& cloud : trace.clouds)
      fields.push_back({cloud.samples[v], Vec3::Zero()});
    EXPECT_NEAR(values[v], combine(shapes.csg, fields).value, 1e-12);
  }
}

/// A page, and beside it, as JSON, what rays of the library's own tracer meet, in the page's units.
void write_with_rays(const std::string& path, const io::Scene& scene) {
  io::write_page(path, scene);
  const Grid& grid = scene.volume->thin.grid;
  const Vec3 high = grid.point(grid.n[0] - 1, grid.n[1] - 1, grid.n[2] - 1);
  const Vec3 centre = (grid.origin + high) / 2, eye(1.5, -1.2, 2.4);
  const double radius = (high - grid.origin).norm() / 2;
  const Vec3 ahead = -eye.normalized(), right = ahead.cross(Vec3::UnitZ()).normalized();
  const double wide = 0.36;  // tangent of half the opening
  const Vec3 up = right.cross(ahead);
  constexpr int n = 64;
  std::ofstream out(std::string(path) + ".json");
  const auto triple = [&](const Vec3& v) {
    out << "[" << v[0] << "," << v[1] << "," << v[2] << "],";
  };
  out.precision(12);
  out << "{\"n\":" << n << ",\"radius\":" << radius << ",\"frame\":[";
  triple(eye);
  triple(wide * right);
  triple(wide * up);
  triple(ahead);
  out << "0],\"t\":[";
  for (int y = 0; y < n; ++y) {
    for (int x = 0; x < n; ++x) {
      const double u = (2 * x + 1.0) / n - 1, v = (2 * y + 1.0) / n - 1;
      const Vec3 ray = (ahead + wide * (u * right + v * up)).normalized();
      Vec3 normal;
      const double t = scene.trace->hit(centre + radius * eye, ray, 0, 8 * radius, 1e-4, normal);
      out << (x + y ? "," : "") << (std::isfinite(t) ? t / radius : -1);
    }
  }
  out << "]}\n";
  ASSERT_TRUE(out.good());
}

// Pages for the browser's test (viewer/test/trace.test.mjs).
TEST(TracePageForBrowserTest, IsWritten) {
  const char* path = std::getenv("LITTORAL_TRACE_PAGE_OUT");
  if (!path) GTEST_SKIP() << "LITTORAL_TRACE_PAGE_OUT is not set";
  TracedView view;
  view.for_page = true;
  io::Scene scene = scene_of(shapes_of(torus_cloud(2000)), view, 48);
  scene.title = "torus";
  write_with_rays(path, scene);
  io::Scene several = scene_of(bitten_pair(2000), view, 48);
  several.title = "three clouds";
  write_with_rays(std::string(path) + ".clouds.html", several);
}

}  // namespace
}  // namespace littoral
