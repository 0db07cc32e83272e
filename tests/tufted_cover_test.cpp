// The tufted cover: gluing, flips, and what they keep.

#include "domain/intrinsic/tufted_cover.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "spatial/triangulate.h"
#include "test_meshes.h"

namespace littoral {
namespace {

using Face = TuftedCover::Face;

void expect_glued(const TuftedCover& cover) {
  const auto& faces = cover.faces();
  for (int f = 0; f < static_cast<int>(faces.size()); ++f)
    for (int k = 0; k < 3; ++k) {
      const int t = faces[f].twin[k];
      const Face& other = faces[t / 3];
      EXPECT_EQ(other.twin[t % 3], 3 * f + k);
      EXPECT_EQ(other.v[t % 3], faces[f].v[(k + 1) % 3]);  // runs the other way
      EXPECT_EQ(other.v[(t % 3 + 1) % 3], faces[f].v[k]);
      EXPECT_EQ(other.length[t % 3], faces[f].length[k]);
    }
}

double area(const TuftedCover& cover) {
  double sum = 0;
  for (const Face& f : cover.faces()) {
    const double s = 0.5 * (f.length[0] + f.length[1] + f.length[2]);
    sum += std::sqrt(s * (s - f.length[0]) * (s - f.length[1]) * (s - f.length[2]));
  }
  return sum;
}

TEST(TuftedCover, SidesOfAManifoldAreSheets) {
  const PolygonSoup sphere = test::octasphere_soup(2);
  const TuftedCover cover(sphere.points, triangles_of(sphere));
  expect_glued(cover);
  for (int f = 0; f < static_cast<int>(cover.faces().size()); ++f)
    for (int t : cover.faces()[f].twin) EXPECT_EQ(t / 3 % 2, f % 2);  // fronts meet fronts
}

TEST(TuftedCover, BoundariesFoldOver) {
  MatX3 points(3, 3);
  points << 0, 0, 0, 1, 0, 0, 0, 1, 0;
  const TuftedCover cover(points, MatX3i(Eigen::RowVector3i(0, 1, 2)));
  expect_glued(cover);
  for (int t : cover.faces()[0].twin) EXPECT_EQ(t / 3, 1);
}

TEST(TuftedCover, FansAreGluedInTheirOrderAroundTheEdge) {
  // Five half planes at an edge, listed in no order and turned either way.
  MatX3 points(7, 3);
  points.row(0) << 0, 0, 0;
  points.row(1) << 0, 0, 1;
  const double angle[5] = {3.1, 0.2, 5.5, 1.7, 4.4};
  MatX3i F(5, 3);
  for (int t = 0; t < 5; ++t) {
    points.row(2 + t) << std::cos(angle[t]), std::sin(angle[t]), 0.5;
    if (t % 2)
      F.row(t) << 1, 0, 2 + t;
    else
      F.row(t) << 0, 1, 2 + t;
  }
  const TuftedCover cover(points, F);
  expect_glued(cover);
  const int next[5] = {4, 3, 1, 0, 2};  // by growing angle
  for (int t = 0; t < 5; ++t) {
    const int side = t % 2 ? 6 * t + 5 : 6 * t;  // of the face that runs 0 -> 1
    EXPECT_EQ(cover.faces()[side / 3].twin[side % 3] / 6, next[t]);
  }
}

TEST(TuftedCover, FlipsMakeAnyTrianglesDelaunayAndKeepTheArea) {
  std::mt19937 random(5);
  // Random triangles among few points: as far from a manifold as can be.
  MatX3 points(12, 3);
  std::uniform_real_distribution<double> x(0, 1);
  for (Eigen::Index i = 0; i < points.size(); ++i) points.data()[i] = x(random);
  MatX3i F(60, 3);
  for (Eigen::Index t = 0; t < F.rows(); ++t) {
    std::array<int, 12> all;
    for (int v = 0; v < 12; ++v) all[v] = v;
    std::shuffle(all.begin(), all.end(), random);
    F.row(t) << all[0], all[1], all[2];
  }
  TuftedCover cover(points, F);
  expect_glued(cover);
  const double before = area(cover);
  EXPECT_GT(cover.flip_to_delaunay(Task()), 0);
  expect_glued(cover);
  EXPECT_NEAR(area(cover), before, 1e-9 * before);
  for (int s = 0; s < static_cast<int>(3 * cover.faces().size()); ++s) {
    const Face& f = cover.faces()[s / 3];
    const int twin = f.twin[s % 3];
    const int apex = f.v[(s % 3 + 2) % 3], other = cover.faces()[twin / 3].v[(twin % 3 + 2) % 3];
    if (apex != other) {  // an edge from a vertex to itself is never made
      EXPECT_GE(cover.delaunay_sum(s), -1e-8);
    }
  }
}

TEST(TuftedCover, NeedlesTerminate) {
  MatX3 points(6, 3);
  points << 0, 0, 0, 1, 0, 0, 0.5, 0, 0, 0.5, 1e-13, 0, 0.25, 0, 0, 1, 1, 0;
  MatX3i F(4, 3);
  F << 0, 1, 2, 0, 1, 3, 0, 2, 4, 0, 1, 5;
  TuftedCover cover(points, F);
  cover.flip_to_delaunay(Task());
  expect_glued(cover);
  EXPECT_TRUE(std::isfinite(area(cover)));
}

}  // namespace
}  // namespace littoral
