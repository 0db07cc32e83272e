// Lengths near the ends of the range of numbers: squares of them leave it, distances must not.

#include <gtest/gtest.h>

#include <cmath>

#include "api/surface/surface_domain.h"
#include "base/stable_length.h"
#include "one_call.h"
#include "test_meshes.h"

namespace littoral {
namespace {

PolygonSoup bent_quads() {
  PolygonSoup soup;
  soup.points.resize(16, 3);
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i) soup.points.row(4 * j + i) << i, j, 0.2 * i * (3 - j);
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) {
      const int v = 4 * j + i, face[4] = {v, v + 1, v + 5, v + 4};
      soup.add_face(face);
    }
  return soup;
}

void expect_scales(const PolygonSoup& soup, const Sources& sources, const AnyMethod& method) {
  Report report;
  const VecX d = test::surface_distance(SurfaceMesh(soup), sources, method, report);
  for (const int power : {-530, 530}) {
    PolygonSoup scaled = soup;
    scaled.points *= std::exp2(power);
    const VecX s = test::surface_distance(SurfaceMesh(scaled), sources, method, report);
    EXPECT_LE((s * std::exp2(-power) - d).cwiseAbs().maxCoeff(), 1e-9 * d.cwiseAbs().maxCoeff())
        << method.name() << " 2^" << power;
  }
}

TEST(ScaleRange, PlacesInPolygonsAreFound) {
  Sources inside;
  inside.points = {SurfacePoint::in_face(4, 0.5, 0.3, 0.2),
                   SurfacePoint::in_face(8, 0.2, 0.2, 0.6)};
  for (const char* method : {"auto", "unsigned-heat", "belyaev-fayolle"})
    expect_scales(bent_quads(), inside, AnyMethod::named(method));
}

TEST(ScaleRange, BrokenCurvesAreCompleted) {
  Sources gaps;  // to both ends of the mesh
  Curve curve;
  for (const int face : {40, 57, 75})
    curve.nodes.push_back(SurfacePoint::in_face(face, 0.5, 0.3, 0.2));
  gaps.curves.push_back(curve);
  expect_scales(test::grid_soup(9, 7), gaps, AnyMethod::named("auto"));
}

TEST(ScaleRange, ALengthIsTheSameWhereverTheVectorLies) {
  struct alignas(32) Shifted {
    Vec3 even;
    Vec3 odd;  // where no vector register begins
  };
  for (int i = 0; i < 1000; ++i) {
    Shifted two;
    two.even = two.odd = Vec3(std::sin(i), std::cos(3 * i), std::sin(7 * i + 1));
    EXPECT_EQ(stable_length(two.even), stable_length(two.odd));
  }
  for (const double size : {1e-310, 1e-200, 1e200, 1.5e307})
    EXPECT_DOUBLE_EQ(stable_length(size * Vec3(2, 3, 6)) / size, 7);
  EXPECT_EQ(stable_length(Vec3::Zero()), 0);
  EXPECT_EQ(stable_length(Vec3(1, -HUGE_VAL, 2)), HUGE_VAL);
}

}  // namespace
}  // namespace littoral
