// Ways through tets round what hides the source: as long as they are, and never shorter.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "constants.h"
#include "domain/tet/tet_locator.h"
#include "methods/geodesic/taut_way.h"
#include "one_call.h"
#include "space_helpers.h"
#include "tet_helpers.h"

namespace littoral {
namespace {

using test::automatic_tets;
using test::infinity;
using test::tet_errors;
using test::tet_vertex_at;
using test::TetErrors;
using test::tets_where;

/// The unit cube without a hole of that radius about its middle line, or about its middle.
TetMesh tets_round_a_hole(int n, double radius, int dimensions) {
  const auto from_middle = [&](const auto& x) {
    return Eigen::VectorXd(x.head(dimensions).array() - 0.5);
  };
  TetMesh mesh =
      tets_where(n, [&](const Vec3& x) { return from_middle(x).cwiseAbs().maxCoeff() > radius; });
  for (auto p : mesh.points.rowwise()) {  // squares to circles
    const Eigen::VectorXd d = from_middle(p);
    const double square = d.cwiseAbs().maxCoeff();
    if (square > 0) p.head(dimensions) = (d / d.norm() * square).array() + 0.5;
  }
  return mesh;
}

/// The way from a to b, seen from the middle of a circle or ball, round it.
double round_a_circle(double radius, const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  const double free =
      std::acos(std::min(1.0, radius / a.norm())) + std::acos(std::min(1.0, radius / b.norm()));
  const double angle = std::acos(std::clamp(a.dot(b) / a.norm() / b.norm(), -1.0, 1.0));
  if (angle <= free) return (a - b).norm();
  return std::sqrt(std::max(0.0, a.squaredNorm() - radius * radius)) +
         std::sqrt(std::max(0.0, b.squaredNorm() - radius * radius)) + radius * (angle - free);
}

/// The same round a convex polygon with corners in this order: by some of them, one way or the
/// other. A way by corners in that order is never shorter than the shortest.
double round_a_polygon(const std::vector<Eigen::Vector2d>& corners, const Eigen::Vector2d& a,
                       const Eigen::Vector2d& b) {
  const auto cross = [](const Eigen::Vector2d& u, const Eigen::Vector2d& v) {
    return u[0] * v[1] - u[1] * v[0];
  };
  const std::size_t n = corners.size();
  const auto is_free = [&](const Eigen::Vector2d& p, const Eigen::Vector2d& q) {
    double low = 0, high = 1;  // the part within
    for (std::size_t i = 0; i < n; ++i) {
      const Eigen::Vector2d side = corners[(i + 1) % n] - corners[i];
      const double hp = cross(side, p - corners[i]), hq = cross(side, q - corners[i]);
      if (hp < 1e-12 && hq < 1e-12) return true;
      if (hp < 0) low = std::max(low, hp / (hp - hq));
      if (hq < 0) high = std::min(high, hp / (hp - hq));
    }
    return low >= high - 1e-9;
  };
  if (is_free(a, b)) return (a - b).norm();
  double best = infinity;
  for (std::size_t i = 0; i < n; ++i) {
    if (!is_free(a, corners[i])) continue;
    for (const std::size_t step : {std::size_t{1}, n - 1}) {
      double length = (corners[i] - a).norm();
      for (std::size_t j = i, k = 0; k < n; ++k, j = (j + step) % n) {
        if (is_free(corners[j], b)) best = std::min(best, length + (b - corners[j]).norm());
        length += (corners[(j + step) % n] - corners[j]).norm();
      }
    }
  }
  return best;
}

TEST(WaysThroughTets, RoundACylinderAreExact) {
  // From one side of it to the other a way follows the sides of its prism.
  const double radius = 0.25;
  for (const int n : {8, 12}) {
    const TetMesh mesh = tets_round_a_hole(n, radius, 2);
    std::vector<Eigen::Vector2d> corners;
    const std::vector<char> used = test::used_vertices(mesh);
    for (int v = 0; v < mesh.n_vertices(); ++v) {
      const Eigen::Vector2d d = mesh.points.row(v).head<2>().transpose().array() - 0.5;
      if (used[v] != 0 && mesh.points(v, 2) == 0 && d.norm() < radius + 1e-9) corners.push_back(d);
    }
    std::sort(corners.begin(), corners.end(), [](const auto& u, const auto& v) {
      return std::atan2(u[1], u[0]) < std::atan2(v[1], v[0]);
    });
    const Vec3 from(0, 0.5, 0.5);
    const VecX phi = automatic_tets(mesh, {{}, {tet_vertex_at(mesh, from)}});
    const TetErrors errors = tet_errors(mesh, phi, [&](const Vec3& x) {
      return std::hypot(
          round_a_polygon(corners, from.head<2>().array() - 0.5, x.head<2>().array() - 0.5),
          x[2] - from[2]);
    });
    EXPECT_LT(errors.largest, 1e-8) << n;
  }
}

/// Moves the vertices at random where no tet is turned inside out; those of the hole on its ball.
void shake(TetMesh& mesh, double by, double radius, unsigned seed) {
  const MatX3 was = mesh.points;
  const Vec3 middle = Vec3::Constant(0.5);
  std::vector<char> is_boundary(static_cast<std::size_t>(mesh.n_vertices()), 0);
  const MatX3i boundary = boundary_faces(mesh);
  for (const int v : boundary.reshaped()) is_boundary[v] = 1;
  std::vector<std::vector<int>> tets_at(static_cast<std::size_t>(mesh.n_vertices()));
  for (int t = 0; t < mesh.n_tets(); ++t)
    for (const int v : mesh.tets.row(t)) tets_at[v].push_back(t);
  const auto volume = [&](const MatX3& points, int t) {
    Eigen::Matrix3d edges;
    for (int k = 0; k < 3; ++k)
      edges.row(k) = points.row(mesh.tets(t, k + 1)) - points.row(mesh.tets(t, 0));
    return edges.determinant();
  };
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> jitter(-by, by);
  for (int v = 0; v < mesh.n_vertices(); ++v) {
    const Vec3 x = was.row(v), d(jitter(random), jitter(random), jitter(random));
    if (is_boundary[v] == 0)
      mesh.points.row(v) += d;
    else if ((x - middle).norm() < radius + 1e-9)
      mesh.points.row(v) = middle + radius * (x - middle + d).normalized();
    const std::vector<int>& tets = tets_at[v];
    if (std::any_of(tets.begin(), tets.end(),
                    [&](int t) { return volume(mesh.points, t) / volume(was, t) < 0.1; }))
      mesh.points.row(v) = x;
  }
}

TEST(WaysThroughTets, RoundABallAreNeitherTooShortNorTooLong) {
  // The corners of its facets lie on the ball: ways round the ball stay in the tets, and no way is
  // shorter than one round the ball that touches the facets from within.
  const double radius = 0.25;
  const Vec3 from(0, 0.5, 0.5), middle = Vec3::Constant(0.5);
  for (const unsigned seed : {0u, 1u, 2u}) {
    TetMesh mesh = tets_round_a_hole(8, radius, 3);
    if (seed > 0) shake(mesh, 0.02, radius, seed);
    double inner = radius;
    const MatX3i boundary = boundary_faces(mesh);
    for (const auto& f : boundary.rowwise()) {
      const Vec3 a = mesh.points.row(f[0]), b = mesh.points.row(f[1]), c = mesh.points.row(f[2]);
      inner = std::min(inner, std::abs((b - a).cross(c - a).normalized().dot(a - middle)));
    }
    const VecX phi = automatic_tets(mesh, {{}, {tet_vertex_at(mesh, from)}});
    const std::vector<char> used = test::used_vertices(mesh);
    for (int v = 0; v < mesh.n_vertices(); ++v) {
      if (used[v] == 0) continue;
      const Vec3 a = from - middle, b = mesh.points.row(v).transpose() - middle;
      EXPECT_GT(phi[v], round_a_circle(inner, a, b) - 1e-9) << seed << " at " << b.transpose();
      EXPECT_LT(phi[v], round_a_circle(radius, a, b) + 1e-3) << seed << " at " << b.transpose();
    }
  }
}

TEST(WaysThroughTets, ThatMayBeWrongWhereTetsAreFoldedAreToldOf) {
  const auto warnings = [](const TetMesh& mesh) {
    Report report;
    automatic_tets(mesh, {{}, {tet_vertex_at(mesh, {0, 0.5, 0.5})}}, report);
    return report.warnings;
  };
  TetMesh mesh = tets_round_a_hole(4, 0.25, 3);
  EXPECT_THAT(warnings(mesh), testing::IsEmpty());
  for (int t = 0; t < mesh.n_tets(); t += 2) std::swap(mesh.tets(t, 0), mesh.tets(t, 1));
  EXPECT_THAT(warnings(mesh), testing::IsEmpty());  // how corners are ordered tells nothing
  mesh.points.row(tet_vertex_at(mesh, {0.75, 0.5, 0.5})) << 0.2, 0.9, 0.9;
  EXPECT_THAT(warnings(mesh),
              testing::Contains(testing::Field(&Warning::code, testing::StrEq("tets-folded"))));
}

/// Doubles the vertices on the wall between tets: those with x < `at` keep theirs.
void add_wall(TetMesh& mesh, double at, const std::function<bool(const Vec3&)>& is_wall) {
  const int n = mesh.n_vertices();
  std::vector<int> twin(static_cast<std::size_t>(n), -1);
  std::vector<Vec3> added;
  for (int t = 0; t < mesh.n_tets(); ++t) {
    double middle = 0;
    for (const int v : mesh.tets.row(t)) middle += mesh.points(v, 0) / 4;
    for (int k = 0; k < 4 && middle > at; ++k) {
      const int v = mesh.tets(t, k);
      const Vec3 x = mesh.points.row(v);
      if (std::abs(x[0] - at) > 1e-12 || !is_wall(x)) continue;
      int& other = twin[v];
      if (other < 0) {
        other = n + static_cast<int>(added.size());
        added.push_back(x);
      }
      mesh.tets(t, k) = other;
    }
  }
  mesh.points.conservativeResize(n + static_cast<Eigen::Index>(added.size()), 3);
  for (std::size_t i = 0; i < added.size(); ++i)
    mesh.points.row(n + static_cast<Eigen::Index>(i)) = added[i];
}

TEST(WaysThroughTets, RoundASlitAreExact) {
  TetMesh mesh = test::tet_box(6);
  const int n = mesh.n_vertices();
  add_wall(mesh, 0.5, [](const Vec3& x) { return x[1] > 0.5; });
  EXPECT_EQ(mesh.n_vertices(), n + 3 * 7);
  const Vec3 from(1, 1, 0.5);
  const VecX phi = automatic_tets(mesh, {{}, {tet_vertex_at(mesh, from)}});
  for (int v = 0; v < mesh.n_vertices(); ++v) {
    const Vec3 x = mesh.points.row(v);
    const Eigen::Vector2d a = from.head<2>().array() - 0.5, b = x.head<2>().array() - 0.5;
    const bool is_behind = b[0] < 0 || (b[0] == 0 && v < n);
    const double across = a[1] + (b[1] - a[1]) * a[0] / (a[0] - b[0]);  // y at the wall's plane
    const double flat = is_behind && across > 0 ? a.norm() + b.norm() : (a - b).norm();
    EXPECT_NEAR(phi[v], std::hypot(flat, x[2] - from[2]), 1e-8) << x.transpose();
  }
}

/// The least value of a convex function between 0 and 1.
template <class F>
double least(const F& f) {
  double low = 0, high = 1;
  for (int i = 0; i < 60; ++i) {
    const double a = low + (high - low) * 0.4, b = low + (high - low) * 0.6;
    (f(a) < f(b) ? high : low) = f(a) < f(b) ? b : a;
  }
  return f((low + high) / 2);
}

TEST(WaysThroughTets, FromOneSideOfASlitLeadRoundItToTheOther) {
  TetMesh mesh = test::tet_box(4);
  const int n = mesh.n_vertices();
  add_wall(mesh, 0.5, [](const Vec3& x) { return x[1] > 0.5; });
  int left = -1, right = -1;  // vertices in one place
  for (int v = 0; v < mesh.n_vertices(); ++v)
    if (mesh.points.row(v).transpose() == Vec3(0.5, 0.75, 0.5)) (v < n ? left : right) = v;
  const VecX from_left = automatic_tets(mesh, {{}, {left}});
  EXPECT_EQ(from_left[left], 0);
  EXPECT_NEAR(from_left[right], 0.5, 1e-9);
  EXPECT_NEAR(from_left[tet_vertex_at(mesh, {1, 0.75, 0.5})], 0.25 + std::hypot(0.5, 0.25), 1e-9);
  EXPECT_NEAR(from_left[tet_vertex_at(mesh, {0, 0.75, 0.5})], 0.5, 1e-9);
  const VecX from_both = automatic_tets(mesh, {{}, {left, right}});
  for (int v = 0; v < mesh.n_vertices(); ++v) {
    const double straight = (mesh.points.row(v) - mesh.points.row(left)).norm();
    EXPECT_NEAR(from_both[v], straight, 1e-9) << mesh.points.row(v);
  }
}

TEST(WaysThroughTets, RoundTwoEdgesThatAreNotParallelAreExact) {
  // Walls at x = 1/3, open at y < 1/2, and at x = 2/3, open at z < 1/2.
  TetMesh mesh = test::tet_box(6);
  const double one = 2.0 / 6, two = 4.0 / 6;
  add_wall(mesh, one, [](const Vec3& x) { return x[1] > 0.5; });
  add_wall(mesh, two, [](const Vec3& x) { return x[2] > 0.5; });
  const Vec3 from(0, 1, 1);
  const VecX phi = automatic_tets(mesh, {{}, {tet_vertex_at(mesh, from)}});
  const auto at = [](const Vec3& a, const Vec3& b, double x) {
    return Vec3(a + (x - a[0]) / (b[0] - a[0]) * (b - a));
  };
  const auto exact = [&](const Vec3& q) {
    double best = infinity;
    const auto free_at_one = [&](const Vec3& a, const Vec3& b) { return at(a, b, one)[1] <= 0.5; };
    const auto free_at_two = [&](const Vec3& a, const Vec3& b) { return at(a, b, two)[2] <= 0.5; };
    if (free_at_one(from, q) && free_at_two(from, q)) best = (q - from).norm();
    const auto length = [&](double z, double y) {
      const Vec3 c(one, 0.5, z), d(two, y, 0.5);
      return (c - from).norm() + (d - c).norm() + (q - d).norm();
    };
    // With one turn: a way by an edge is straight where its two planes are turned into one.
    const Vec3 c(one, 0.5, 0), d(two, 0, 0.5);
    const auto unfolded = [](double u, double away, double v, double behind) {
      return (u * behind + v * away) / (away + behind);
    };
    const double z = unfolded(from[2], std::hypot(from[0] - c[0], from[1] - c[1]), q[2],
                              std::hypot(q[0] - c[0], q[1] - c[1]));
    if (const Vec3 turn(one, 0.5, z); free_at_two(turn, q))
      best = std::min(best, (turn - from).norm() + (q - turn).norm());
    const double y = unfolded(from[1], std::hypot(from[0] - d[0], from[2] - d[2]), q[1],
                              std::hypot(q[0] - d[0], q[2] - d[2]));
    if (const Vec3 turn(two, y, 0.5); free_at_one(from, turn))
      best = std::min(best, (turn - from).norm() + (q - turn).norm());
    return std::min(best,
                    least([&](double v) { return least([&](double u) { return length(u, v); }); }));
  };
  for (int v = 0; v < mesh.n_vertices(); ++v)
    if (const Vec3 x = mesh.points.row(v); x[0] > 0.75) {
      EXPECT_NEAR(phi[v], exact(x), 1e-8) << x.transpose();
    }
}

double length_by(const MatX3& points, const Vec3& start, const Vec3& end,
                 const std::vector<EdgeTurn>& turns) {
  double length = 0;
  Vec3 last = start;
  for (const EdgeTurn& turn : turns) {
    const Vec3 at = place_of(points, turn);
    length += (at - last).norm();
    last = at;
  }
  return length + (end - last).norm();
}

// The length is a convex function of where the way turns; the best places are found one by one.
TEST(TautWay, IsAsShortAsWaysOverTheseEdgesCanBe) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> u(-1, 1);
  int at_ends = 0;
  double worst = 0;
  for (int round = 0; round < 300; ++round) {
    MatX3 points(6, 3);
    std::vector<EdgeTurn> turns;
    for (int i = 0; i < 3; ++i) {
      const Vec3 middle(i - 1.0, 0.3 * u(random), 0.3 * u(random));
      const Vec3 half(0.2 * u(random), 0.5 * u(random), 0.5 * u(random));
      points.row(2 * i) = middle - half;
      points.row(2 * i + 1) = middle + half;
      turns.push_back({2 * i, 2 * i + 1, 0.5 + 0.5 * u(random)});
    }
    const Vec3 start(-2, u(random), u(random)), end(2, u(random), u(random));
    std::vector<EdgeTurn> best = turns;
    for (int sweep = 0; sweep < 100; ++sweep)
      for (EdgeTurn& turn : best) {
        double low = 0, high = 1;
        while (high - low > 1e-12) {
          const double a = low + (high - low) / 3, b = high - (high - low) / 3;
          turn.t = a;
          const double at_a = length_by(points, start, end, best);
          turn.t = b;
          if (at_a < length_by(points, start, end, best))
            high = b;
          else
            low = a;
        }
        turn.t = low < 1e-11 ? 0 : high > 1 - 1e-11 ? 1 : low;
      }
    for (const EdgeTurn& turn : best) at_ends += turn.t == 0 || turn.t == 1;
    make_taut(
        points, [&](const Vec3&) { return start; }, end, turns);
    worst =
        std::max(worst, length_by(points, start, end, turns) - length_by(points, start, end, best));
  }
  EXPECT_LT(worst, 1e-9);
  EXPECT_GT(at_ends, 50);
}

}  // namespace
}  // namespace littoral
