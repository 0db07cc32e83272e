// The tet lattice beside cubes halved one by one.
#include "domain/tet/tet_lattice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <random>
#include <set>
#include <vector>

#include "littoral/error.h"
#include "space_helpers.h"

namespace littoral {
namespace {

using Cube = std::array<int, 4>;  // lowest corner and side, in halves of the finest

/// Halves a cube and what comes of it while `is_too_large` says so.
template <class F>
void halve(std::set<Cube>& cubes, const Cube& c, const F& is_too_large) {
  if (c[3] == 2 || !is_too_large(c)) {
    cubes.insert(c);
    return;
  }
  const int half = c[3] / 2;
  for (int w = 0; w < 8; ++w)
    halve(cubes, {c[0] + (w & 1) * half, c[1] + (w >> 1 & 1) * half, c[2] + (w >> 2) * half, half},
          is_too_large);
}

/// Whether they have a part of a face or of an edge in common.
bool touch(const Cube& a, const Cube& b) {
  int overlaps = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const int from = std::max(a[k], b[k]), to = std::min(a[k] + a[3], b[k] + b[3]);
    if (from > to) return false;
    overlaps += from < to;
  }
  return overlaps >= 1;
}

std::set<Cube> cubes_about(const MatX3& points, const Vec3& origin, double side, int depth) {
  const int whole = 2 << depth;
  std::set<Cube> cubes;
  halve(cubes, {0, 0, 0, whole}, [&](const Cube& c) {
    for (const auto& p : points.rowwise()) {
      const Vec3 at = (p.transpose() - origin) * whole / side;
      for (int w = 0; w < 8; ++w) {  // half the finest cube to either side
        bool inside = true;
        for (int k = 0; k < 3; ++k) {
          const double x = at[k] + (w >> k & 1 ? 1 : -1);
          inside = inside && x >= c[k] && x < c[k] + c[3];
        }
        if (inside) return true;
      }
    }
    return false;
  });
  for (bool changed = true; changed;) {
    changed = false;
    for (const Cube& c : std::vector<Cube>(cubes.begin(), cubes.end()))
      if (std::any_of(cubes.begin(), cubes.end(),
                      [&](const Cube& d) { return c[3] > 2 * d[3] && touch(c, d); })) {
        cubes.erase(c);
        bool once = true;
        halve(cubes, c, [&](const Cube& d) { return d == c && once; });
        changed = true;
      }
  }
  return cubes;
}

std::set<Cube> cubes_of(const TetLattice& lattice, const Vec3& origin, double side, int depth) {
  const TetMesh& mesh = lattice.mesh();
  std::vector<Vec3> low(static_cast<std::size_t>(lattice.n_cubes()), Vec3::Constant(1e9));
  std::vector<Vec3> high(low.size(), Vec3::Constant(-1e9));
  for (int t = 0; t < mesh.n_tets(); ++t)
    for (const int v : mesh.tets.row(t)) {
      const int c = lattice.cube_of(t);
      low[c] = low[c].cwiseMin(mesh.points.row(v).transpose());
      high[c] = high[c].cwiseMax(mesh.points.row(v).transpose());
    }
  std::set<Cube> out;
  for (std::size_t c = 0; c < low.size(); ++c) {
    const Vec3 at = (low[c] - origin) * (2 << depth) / side;
    const Vec3 size = (high[c] - low[c]) * (2 << depth) / side;
    EXPECT_LT((size.array() - size[0]).abs().maxCoeff(), 1e-9);
    out.insert({static_cast<int>(std::lround(at[0])), static_cast<int>(std::lround(at[1])),
                static_cast<int>(std::lround(at[2])), static_cast<int>(std::lround(size[0]))});
  }
  EXPECT_EQ(out.size(), low.size());
  return out;
}

TEST(TetLatticeCubes, AreHalvedAtPointsAndBesideSmallerOnesOnly) {
  const Vec3 origin(-1, 2, 0.5);
  const double side = 3;
  for (const int depth : {1, 2, 4, 5})
    for (const unsigned seed : {1u, 2u, 3u}) {
      MatX3 points = test::random_points(seed == 3 ? 1 : 3, 1.4, seed);
      points.rowwise() += (origin + Vec3::Constant(side / 2)).transpose();
      const TetLattice lattice(origin, side, depth, points);
      EXPECT_EQ(cubes_of(lattice, origin, side, depth), cubes_about(points, origin, side, depth))
          << depth << ", " << seed;
      EXPECT_EQ(lattice.finest(), side / (1 << depth));
    }
}

TEST(TetLatticeCubes, PointsOnTheBoundaryAndOutsideHalveWhatTheyAreBeside) {
  const Vec3 origin = Vec3::Zero();
  MatX3 points(4, 3);
  points << 0, 0.3, 0.7, 1, 1, 1, 1 + 1. / 40, 0.5, 0.1, 0.5, 0.5, -0.2;
  const TetLattice lattice(origin, 1, 4, points);
  const auto expected = cubes_about(points, origin, 1, 4);
  EXPECT_EQ(cubes_of(lattice, origin, 1, 4), expected);
  EXPECT_GT(expected.size(), 50u);
  EXPECT_EQ(TetLattice(origin, 1, 4, points.bottomRows(1)).n_cubes(), 1);
  EXPECT_EQ(TetLattice(origin, 1, 4, MatX3(0, 3)).mesh().n_tets(), 12);
}

TEST(TetLatticeCubes, PlacesAreFoundInTheirCubeAndNoneOutside) {
  const Vec3 origin(-1, 2, 0.5);
  MatX3 points(2, 3);
  points << 0.1, 3.3, 1.2, 1.9, 4.9, 3.4;
  const TetLattice lattice(origin, 3, 5, points);
  const TetMesh& mesh = lattice.mesh();
  const Vec3 slope(2, -1, 0.5);
  const VecX field = (mesh.points * slope).array() + 7;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> u(0, 3);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 x = origin + Vec3(u(random), u(random), u(random));
    const TetPoint at = lattice.locate(x);
    ASSERT_GE(at.tet, 0);
    EXPECT_GE(*std::min_element(at.barycentric.begin(), at.barycentric.end()), -1e-9);
    EXPECT_NEAR(interpolated(mesh, field, at), slope.dot(x) + 7, 1e-12);
  }
  for (int v = 0; v < mesh.n_vertices(); ++v)  // those on the boundary of the box, too
    EXPECT_NEAR(interpolated(mesh, field, lattice.locate(mesh.points.row(v))), field[v], 1e-12);
  for (int axis = 0; axis < 3; ++axis)
    for (const double off : {-1e-9, 3 + 1e-9, -2.5, 6.0}) {
      Vec3 x = origin + Vec3::Constant(1.25);
      x[axis] = origin[axis] + off;
      EXPECT_EQ(lattice.locate(x).tet, -1) << axis << ", " << off;
    }
}

}  // namespace
}  // namespace littoral
