// Straight lines within tets, where tets are folded, and edges about which a mesh turns sharply.
#include "domain/tet/tet_sight.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "operators/tet_operators.h"
#include "tet_helpers.h"

namespace littoral {
namespace {

/// A mesh with what its sight refers to.
struct Seen {
  TetMesh mesh;
  TetOperators ops;
  TetSight sight;
  explicit Seen(TetMesh of)
      : mesh(std::move(of)),
        ops(tet_operators(mesh)),
        sight(mesh, ops.tet_faces, ops.n_faces, ops.gradients) {}
  Seen(const Seen&) = delete;
};

struct Hole {
  Vec3 low, high;
};

/// Whether the inside of a box holds part of a segment.
bool passes(const Hole& box, const Vec3& a, const Vec3& b) {
  double low = 0, high = 1;
  for (int k = 0; k < 3; ++k) {
    const double from = box.low[k] + 1e-4, to = box.high[k] - 1e-4, d = b[k] - a[k];
    if (d == 0) {
      if (a[k] < from || a[k] > to) return false;
      continue;
    }
    const double s = (from - a[k]) / d, t = (to - a[k]) / d;
    low = std::max(low, std::min(s, t));
    high = std::min(high, std::max(s, t));
  }
  return low < high;
}

bool within(const Hole& box, const Vec3& x) {
  return (x.array() > box.low.array()).all() && (x.array() < box.high.array()).all();
}

TetMesh without(const std::vector<Hole>& holes, int n) {
  return test::tets_where(n, [&](const Vec3& x) {
    return std::none_of(holes.begin(), holes.end(), [&](const Hole& b) { return within(b, x); });
  });
}

// A block in the middle, and one cut out of a corner.
const std::vector<Hole> two_holes{{{0.25, 0.5, 0.25}, {0.75, 0.75, 0.5}},
                                  {{0.5, -1, 0.75}, {2, 0.5, 2}}};

TEST(TetSight, VerticesSeeEachOtherWhereNothingIsBetween) {
  const Seen seen(without(two_holes, 4));
  const std::vector<char> used = test::used_vertices(seen.mesh);
  TetSight::Walk walk;
  int in_sight = 0, hidden = 0;
  for (int a = 0; a < seen.mesh.n_vertices(); ++a)
    for (int b = 0; b < seen.mesh.n_vertices(); ++b) {
      if (used[a] == 0 || used[b] == 0 || a == b) continue;
      const Vec3 from = seen.mesh.points.row(a), to = seen.mesh.points.row(b);
      const bool free = std::none_of(two_holes.begin(), two_holes.end(),
                                     [&](const Hole& box) { return passes(box, from, to); });
      ++(free ? in_sight : hidden);
      ASSERT_EQ(seen.sight.sees(a, to, walk), free) << from.transpose() << " to " << to.transpose();
      ASSERT_EQ(seen.sight.sees(a, to, walk, {b, -1}), free);
    }
  EXPECT_GT(hidden, 1000);
  EXPECT_GT(in_sight, 8000);
}

TEST(TetSight, PointsOfEdgesSeeVerticesWhereNothingIsBetween) {
  const Seen seen(without(two_holes, 4));
  const TetMesh& mesh = seen.mesh;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(0.05, 0.95);
  TetSight::Walk walk;
  int hidden = 0;
  for (int i = 0; i < 4000; ++i) {
    const int t = static_cast<int>(random() % static_cast<unsigned>(mesh.n_tets()));
    const int other = static_cast<int>(random() % static_cast<unsigned>(mesh.n_tets()));
    const int k = static_cast<int>(random() % 4), l = (k + 1 + static_cast<int>(random() % 3)) % 4;
    const int a = mesh.tets(t, k), b = mesh.tets(t, l);
    const Vec3 from = mesh.points.row(a) + u(random) * (mesh.points.row(b) - mesh.points.row(a));
    const Vec3 to = mesh.points.row(mesh.tets(other, 0));
    const bool free = std::none_of(two_holes.begin(), two_holes.end(),
                                   [&](const Hole& box) { return passes(box, from, to); });
    hidden += !free;
    ASSERT_EQ(seen.sight.sees(a, b, from, to, walk), free)
        << from.transpose() << " to " << to.transpose();
    ASSERT_EQ(seen.sight.sees(b, a, from, to, walk, {mesh.tets(other, 0), -1}), free);
  }
  EXPECT_GT(hidden, 400);
}

TEST(TetSight, LinesThatLeaveEndInTheTetWhereTheyLeave) {
  const Seen seen(test::tet_box(3));
  TetSight::Walk walk;
  const int corner = test::tet_vertex_at(seen.mesh, Vec3::Zero());
  const Vec3 out(2, 0.7, 1.1), leaves = out / 2;  // through x = 1
  EXPECT_FALSE(seen.sight.sees(corner, out, walk));
  ASSERT_GE(walk.last, 0);
  Vec3 low = Vec3::Ones(), high = Vec3::Zero();
  for (const int v : seen.mesh.tets.row(walk.last)) {
    low = low.cwiseMin(seen.mesh.points.row(v).transpose());
    high = high.cwiseMax(seen.mesh.points.row(v).transpose());
  }
  EXPECT_TRUE(((leaves - low).array() > -1e-9).all() && ((high - leaves).array() > -1e-9).all());
}

TEST(TetSight, AnAimIsReachedInItsOwnTetsOnly) {
  // Two tets with a face in one place that is not the same: no line goes from one to the other.
  TetMesh mesh;
  mesh.points.resize(8, 3);
  mesh.points << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, -1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
  mesh.tets.resize(2, 4);
  mesh.tets << 0, 1, 2, 3, 4, 5, 6, 7;
  const Seen seen(mesh);
  TetSight::Walk walk;
  const Vec3 x(1, 0, 0);
  EXPECT_TRUE(seen.sight.sees(3, x, walk));
  EXPECT_TRUE(seen.sight.sees(3, x, walk, {1, -1}));
  EXPECT_TRUE(seen.sight.sees(3, x, walk, {1, 2}));
  EXPECT_FALSE(seen.sight.sees(3, x, walk, {5, -1}));
  EXPECT_FALSE(seen.sight.sees(3, x, walk, {1, 5}));
  EXPECT_TRUE(seen.sight.sees(7, x, walk, {5, -1}));
  EXPECT_FALSE(seen.sight.sees(7, x, walk, {-1, 1}));
  EXPECT_FALSE(seen.sight.sees(7, {0, 0, -1}, walk));
}

// A tet on a triangle and another that shares it, its tip at a height; corners and tets in any
// order.
int folded(double height, const std::array<int, 4>& first, const std::array<int, 4>& second,
           bool swapped, bool third = false) {
  TetMesh mesh;
  mesh.points.resize(6, 3);
  mesh.points << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0.2, 0.2, 1, 0.3, 0.3, height, 0.25, 0.3, 0.7;
  mesh.tets.resize(third ? 3 : 2, 4);
  const std::array<int, 4> other{0, 1, 2, 4};
  for (int k = 0; k < 4; ++k) {
    mesh.tets(swapped ? 1 : 0, k) = first[k];
    mesh.tets(swapped ? 0 : 1, k) = other[second[k]];
  }
  if (third) mesh.tets.row(2) << 0, 1, 2, 5;
  const Seen seen(mesh);
  return folded_tets(seen.mesh, seen.sight);
}

TEST(TetSight, TetsFoldedOverAnotherAreCountedInAnyOrder) {
  std::array<int, 4> first{0, 1, 2, 3};
  do {
    for (const bool swapped : {false, true}) {
      EXPECT_EQ(folded(0.5, first, first, swapped), 1);
      EXPECT_EQ(folded(2, first, {0, 1, 2, 3}, swapped), 1);
      EXPECT_EQ(folded(-0.5, first, {2, 3, 1, 0}, swapped), 0);
    }
  } while (std::next_permutation(first.begin(), first.end()));
  EXPECT_EQ(folded(1e-8, first, first, false), 1);
  EXPECT_EQ(folded(1e-10, first, first, false), 0) << "flat";
  EXPECT_EQ(folded(0.5, first, first, false, true), 0) << "three at a face";
}

TEST(TetSight, FoldsAreCountedOncePerFace) {
  TetMesh mesh = test::tet_box(2);
  EXPECT_EQ(folded_tets(Seen(mesh).mesh, Seen(mesh).sight), 0);
  const int middle = test::tet_vertex_at(mesh, Vec3::Constant(0.5));
  mesh.points.row(middle) << 1.7, 0.5, 0.5;
  const Seen seen(mesh);
  // The tets at the middle whose opposite face it passes: those right of it are turned over, and
  // folded over their neighbours across faces with the middle that are not.
  std::vector<char> turned(static_cast<std::size_t>(mesh.n_tets()));
  const TetMesh was = test::tet_box(2);
  const auto volume = [](const TetMesh& m, int t) {
    Eigen::Matrix3d edges;
    for (int k = 0; k < 3; ++k)
      edges.row(k) = m.points.row(m.tets(t, k + 1)) - m.points.row(m.tets(t, 0));
    return edges(0, 0) * (edges(1, 1) * edges(2, 2) - edges(1, 2) * edges(2, 1)) -
           edges(0, 1) * (edges(1, 0) * edges(2, 2) - edges(1, 2) * edges(2, 0)) +
           edges(0, 2) * (edges(1, 0) * edges(2, 1) - edges(1, 1) * edges(2, 0));
  };
  for (int t = 0; t < mesh.n_tets(); ++t) turned[t] = volume(mesh, t) * volume(was, t) < 0;
  int expected = 0;
  for (int a = 0; a < mesh.n_tets(); ++a)
    for (int b = 0; b < a; ++b) {
      int common = 0;
      for (const int v : mesh.tets.row(a)) common += (mesh.tets.row(b).array() == v).any();
      expected += common == 3 && turned[a] != turned[b];
    }
  EXPECT_GT(expected, 3);
  EXPECT_EQ(folded_tets(seen.mesh, seen.sight), expected);
}

TEST(TetSight, ReentrantEdgesAreThoseOfHolesAndNotches) {
  const int n = 4;
  const Seen seen(without(two_holes, n));
  const auto ends = reentrant_edges(seen.mesh, seen.sight);
  std::set<std::pair<int, int>> found, expected;
  for (int v = 0; v < seen.mesh.n_vertices(); ++v) {
    EXPECT_TRUE(std::is_sorted(ends[v].begin(), ends[v].end()));
    for (const int w : ends[v]) found.emplace(v, w);
  }
  const auto line = [&](const Vec3& from, const Vec3& to) {
    const int steps = static_cast<int>(std::lround((to - from).norm() * n));
    for (int i = 0; i < steps; ++i) {
      const int a = test::tet_vertex_at(seen.mesh, from + double(i) / steps * (to - from));
      const int b = test::tet_vertex_at(seen.mesh, from + double(i + 1) / steps * (to - from));
      expected.emplace(a, b);
      expected.emplace(b, a);
    }
  };
  const Hole& block = two_holes[0];
  for (int axis = 0; axis < 3; ++axis)
    for (int corner = 0; corner < 4; ++corner) {
      Vec3 from = block.low;
      if (corner & 1) from[(axis + 1) % 3] = block.high[(axis + 1) % 3];
      if (corner & 2) from[(axis + 2) % 3] = block.high[(axis + 2) % 3];
      Vec3 to = from;
      to[axis] = block.high[axis];
      line(from, to);
    }
  line({0.5, 0, 0.75}, {0.5, 0.5, 0.75});  // of the notch, where it is within
  line({0.5, 0.5, 0.75}, {1, 0.5, 0.75});
  line({0.5, 0.5, 0.75}, {0.5, 0.5, 1});
  EXPECT_EQ(found, expected);
}

}  // namespace
}  // namespace littoral
