// The level set in one cell: what it spans, and that nothing depends on how the cell is turned.

#include "contour/cell_surface.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "base/index.h"

namespace littoral::cell {
namespace {

Vec3 corner(int c) { return Vec3(c & 1, c >> 1 & 1, c >> 2); }

Cell cell_of(const std::array<double, 8>& value) {
  Cell cell;
  cell.value = value;
  for (unsigned c = 0; c < 8; ++c) cell.positive |= unsigned(value[c] > 0) << c;
  for (std::size_t e = 0; e < 12; ++e) {
    const Edge& edge = edges()[e];
    const double a = value[std::size_t(edge.tail)], b = value[std::size_t(edge.head)];
    if ((a > 0) != (b > 0))
      cell.crossing[e] = corner(edge.tail) + a / (a - b) * (corner(edge.head) - corner(edge.tail));
  }
  return cell;
}

std::array<double, 8> random_values(std::mt19937& random) {
  std::uniform_real_distribution<double> some(-1, 1);
  std::array<double, 8> value{};
  for (double& v : value) v = some(random);
  return value;
}

double trilinear(const std::array<double, 8>& value, const Vec3& x) {
  double sum = 0;
  for (int c = 0; c < 8; ++c) {
    double weight = 1;
    for (int k = 0; k < 3; ++k) weight *= (c >> k & 1) ? x[k] : 1 - x[k];
    sum += weight * value[std::size_t(c)];
  }
  return sum;
}

Vec3 point(const Cell& cell, const Patch& patch, int id) {
  return id < 12 ? cell.crossing[std::size_t(id)] : patch.inner[std::size_t(id - 12)];
}

Vec3 area_vector(const Cell& cell, const Patch& patch, const std::array<int, 3>& t) {
  const Vec3 a = point(cell, patch, t[0]);
  return 0.5 * (point(cell, patch, t[1]) - a).cross(point(cell, patch, t[2]) - a);
}

double area(const Cell& cell, const Patch& patch) {
  double sum = 0;
  for (const auto& t : patch.triangles) sum += area_vector(cell, patch, t).norm();
  return sum;
}

TEST(CellSurface, EdgesJoinNeighbouringCornersOnTwoFaces) {
  std::set<std::pair<int, int>> pairs;
  for (const Edge& e : edges()) {
    EXPECT_EQ(e.head - e.tail, 1 << e.axis);
    pairs.emplace(e.tail, e.head);
    for (int a = 0; a < 3; ++a)
      for (int s = 0; s < 2; ++s)
        EXPECT_EQ(e.faces >> (2 * a + s) & 1,
                  unsigned((e.tail >> a & 1) == s && (e.head >> a & 1) == s));
  }
  EXPECT_EQ(pairs.size(), 12u);
}

TEST(CellSurface, APatchIsBoundedByTheChainsOnTheFaces) {
  std::mt19937 random(1);
  Patch patch;
  int tunnels = 0, several = 0;
  for (int round = 0; round < 20000; ++round) {
    const Cell cell = cell_of(random_values(random));
    patch.clear();
    span_cell(cell, patch);
    const Loops loops = trace_loops(cell.value, cell.positive);
    std::set<std::pair<int, int>> chain;
    for (int l = 0; l < loops.count; ++l)
      for (int i = 0; i < loops.size(l); ++i)
        chain.emplace(
            loops.edge[std::size_t(loops.begin[std::size_t(l)] + i)],
            loops.edge[std::size_t(loops.begin[std::size_t(l)] + (i + 1) % loops.size(l))]);
    std::set<std::pair<int, int>> sides;
    std::set<int> corners;
    for (const auto& t : patch.triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        ASSERT_TRUE(sides.emplace(t[k], t[(k + 1) % 3]).second);
        corners.insert(t[k]);
      }
    int inner_sides = 0;
    for (const auto& [a, b] : sides) {
      const bool inside = sides.count({b, a}) > 0;
      ASSERT_NE(inside, chain.count({a, b}) > 0) << "the boundary is the chains";
      if (!inside) continue;
      ++inner_sides;
      if (a < 12 && b < 12) {
        ASSERT_EQ(edges()[std::size_t(a)].faces & edges()[std::size_t(b)].faces, 0u);
      }
    }
    for (const auto& side : chain) ASSERT_TRUE(sides.count(side));
    for (const Vec3& p : patch.inner) ASSERT_TRUE(p.minCoeff() > 0 && p.maxCoeff() < 1);
    const bool tunnel = find_tunnel(cell.value, cell.positive, loops).has_value();
    const int euler =
        int_size(corners) - (int_size(chain) + inner_sides / 2) + int_size(patch.triangles);
    ASSERT_EQ(euler, loops.count - (tunnel ? 2 : 0));
    tunnels += tunnel;
    several += loops.count > 1;
  }
  EXPECT_GT(tunnels, 20);
  EXPECT_GT(several, 2000);
}

TEST(CellSurface, PositiveCornersAreBeforeTheFaces) {
  for (unsigned c = 0; c < 8; ++c) {
    std::array<double, 8> value{};
    value.fill(-1);
    value[c] = 2;
    const Cell cell = cell_of(value);
    Patch patch;
    span_cell(cell, patch);
    ASSERT_EQ(patch.triangles.size(), 1u);
    const Vec3 towards = corner(static_cast<int>(c)) - point(cell, patch, patch.triangles[0][0]);
    EXPECT_GT(area_vector(cell, patch, patch.triangles[0]).dot(towards), 0);
    EXPECT_NEAR(area(cell, patch), std::sqrt(3.0) / 2 * 4 / 9, 1e-12);  // sides 2/3 sqrt 2
  }
}

TEST(CellSurface, ALevelPlaneIsSpannedFlat) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> some(-1, 1);
  for (int round = 0; round < 500; ++round) {
    const Vec3 n = Vec3(some(random), some(random), some(random)).normalized();
    std::array<double, 8> value{};
    const double level = n.dot(Vec3(0.5, 0.5, 0.5)) + 0.3 * some(random);
    for (int c = 0; c < 8; ++c) value[std::size_t(c)] = n.dot(corner(c)) - level;
    const Cell cell = cell_of(value);
    Patch patch;
    span_cell(cell, patch);
    for (const auto& t : patch.triangles) EXPECT_GT(area_vector(cell, patch, t).dot(n), -1e-15);
    EXPECT_TRUE(patch.inner.empty());
  }
}

/// Corners with their bits moved on by one axis: x to y, y to z, z to x.
std::size_t turned(std::size_t c) { return (c << 1 & 6) | (c >> 2 & 1); }

TEST(CellSurface, ATurnedCellHasTheTurnedSurface) {
  std::mt19937 random(2);
  for (int round = 0; round < 4000; ++round) {
    const auto value = random_values(random);
    std::array<double, 8> other{};
    for (std::size_t c = 0; c < 8; ++c) other[turned(c)] = value[c];
    const Cell cell = cell_of(value), there = cell_of(other);
    Patch patch, moved;
    span_cell(cell, patch);
    span_cell(there, moved);
    ASSERT_EQ(patch.triangles.size(), moved.triangles.size());
    ASSERT_EQ(patch.inner.size(), moved.inner.size());
    // Ribbons around tubes begin at the first crossing, which is another one then.
    if (!find_tunnel(value, cell.positive, trace_loops(value, cell.positive))) {
      ASSERT_NEAR(area(cell, patch), area(there, moved), 1e-9);
    }
  }
}

/// The least sum of squared diagonals of triangulations of nodes i to j of a loop, none of which
/// lies on a face; infinity where there is none. By trying all.
double least_diagonals(const Cell& cell, const std::vector<int>& loop, std::size_t i,
                       std::size_t j) {
  if (j - i < 2) return 0;
  double own = 0;
  if (j - i + 1 < loop.size()) {
    const auto a = std::size_t(loop[i]), b = std::size_t(loop[j]);
    if (edges()[a].faces & edges()[b].faces) return infinity;
    own = cell.spacing.cwiseProduct(cell.crossing[a] - cell.crossing[b]).squaredNorm();
  }
  double least = infinity;
  for (std::size_t k = i + 1; k < j; ++k)
    least = std::min(least, least_diagonals(cell, loop, i, k) + least_diagonals(cell, loop, k, j));
  return own + least;
}

TEST(CellSurface, DiscsHaveTheShortestDiagonals) {
  std::mt19937 random(3);
  int fans = 0, discs = 0;
  for (int round = 0; round < 3000; ++round) {
    Cell cell = cell_of(random_values(random));
    cell.spacing = Vec3(1, 2, 0.5);
    const Loops loops = trace_loops(cell.value, cell.positive);
    if (loops.count != 1) continue;
    const std::vector<int> loop(loops.edge.begin(), loops.edge.begin() + loops.size(0));
    const double least = least_diagonals(cell, loop, 0, loop.size() - 1);
    Patch patch;
    span_cell(cell, patch);
    if (least == infinity) {
      ++fans;
      EXPECT_EQ(patch.inner.size(), 1u);
      EXPECT_EQ(patch.triangles.size(), loop.size());
      continue;
    }
    ++discs;
    EXPECT_TRUE(patch.inner.empty());
    double sum = 0;
    for (const auto& t : patch.triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        const auto a = std::size_t(t[k]), b = std::size_t(t[(k + 1) % 3]);
        sum += cell.spacing.cwiseProduct(cell.crossing[a] - cell.crossing[b]).squaredNorm() / 2;
      }
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const auto a = std::size_t(loop[i]), b = std::size_t(loop[(i + 1) % loop.size()]);
      sum -= cell.spacing.cwiseProduct(cell.crossing[a] - cell.crossing[b]).squaredNorm() / 2;
    }
    EXPECT_NEAR(sum, least, 1e-7);
  }
  EXPECT_GT(discs, 1000);
  EXPECT_GT(fans, 20);
}

/// Whether corners of one sign that the cell's faces keep apart are joined along lines of a grid in
/// it. On such a line the function is linear: what has one sign at two nodes has it between them.
bool joined_inside(const Cell& cell, const Loops& loops) {
  constexpr int n = 12;
  std::array<std::array<std::array<int, n + 1>, n + 1>, n + 1> part{};  // 0: not yet met
  std::array<int, 8> of_corner{};
  const auto is_positive = [&](const std::array<int, 3>& x) {
    return trilinear(cell.value, Vec3(x[0], x[1], x[2]) / n) > 0;
  };
  int parts = 0;
  for (int c = 0; c < 8; ++c) {
    const std::array<int, 3> start{n * (c & 1), n * (c >> 1 & 1), n * (c >> 2)};
    const auto met = [&](const std::array<int, 3>& x) -> int& {
      return part[std::size_t(x[0])][std::size_t(x[1])][std::size_t(x[2])];
    };
    if (met(start) == 0) {
      const bool sign = is_positive(start);
      std::vector<std::array<int, 3>> stack{start};
      met(start) = ++parts;
      while (!stack.empty()) {
        const std::array<int, 3> x = stack.back();
        stack.pop_back();
        for (std::size_t axis = 0; axis < 3; ++axis)
          for (const int step : {-1, 1}) {
            std::array<int, 3> y = x;
            y[axis] += step;
            if (y[axis] < 0 || y[axis] > n || met(y) != 0 || is_positive(y) != sign) continue;
            met(y) = parts;
            stack.push_back(y);
          }
      }
    }
    of_corner[std::size_t(c)] = met(start);
  }
  for (std::size_t a = 0; a < 8; ++a)
    for (std::size_t b = 0; b < a; ++b)
      if (of_corner[a] == of_corner[b] && loops.region[a] != loops.region[b]) return true;
  return false;
}

TEST(CellSurface, TunnelsAreWhereTheFunctionJoinsWhatTheFacesKeepApart) {
  std::mt19937 random(6);
  int both = 0, thin = 0, without = 0;
  for (int round = 0; round < 4000; ++round) {
    const Cell cell = cell_of(random_values(random));
    const Loops loops = trace_loops(cell.value, cell.positive);
    if (loops.count < 2) continue;
    const bool tunnel = find_tunnel(cell.value, cell.positive, loops).has_value();
    const bool joined = joined_inside(cell, loops);
    ASSERT_TRUE(tunnel || !joined) << round;
    ++(joined ? both : tunnel ? thin : without);
  }
  EXPECT_GT(both, 10);
  EXPECT_LT(thin, both);  // what the grid is too coarse for
  EXPECT_GT(without, 300);
}

TEST(CellSurface, RibbonsAroundTubesAreTheShortest) {
  std::mt19937 random(7);
  int tubes = 0;
  for (int round = 0; round < 12000; ++round) {
    Cell cell = cell_of(random_values(random));
    cell.trilinear = false;
    cell.spacing = Vec3(1, 2, 0.5);
    const Loops loops = trace_loops(cell.value, cell.positive);
    const auto tunnel = find_tunnel(cell.value, cell.positive, loops);
    if (!tunnel || loops.count != 2) continue;
    Patch patch;
    span_cell(cell, patch);
    const auto crossing = [&](int loop, int i) {
      return cell.crossing[std::size_t(
          loops.edge[std::size_t(loops.begin[std::size_t(loop)] + i % loops.size(loop))])];
    };
    const int n = loops.size(tunnel->first), m = loops.size(tunnel->second);
    const auto cost = [&](int i, int j) {
      const Vec3 d = crossing(tunnel->first, i) - crossing(tunnel->second, 2 * m - j % m);
      return cell.spacing.cwiseProduct(d).squaredNorm();
    };
    // Points inside are half way between the pairs that the ribbon passes, drawn to the middle.
    ASSERT_EQ(int(patch.inner.size()), n + m);
    double found = 0;
    for (const Vec3& p : patch.inner) {
      const Vec3 x = Vec3::Constant(0.5) + (p - Vec3::Constant(0.5)) / 0.9;
      double nearest = infinity, of_it = 0;
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < m; ++j) {
          const Vec3 middle =
              (crossing(tunnel->first, i) + crossing(tunnel->second, 2 * m - j)) / 2;
          if ((middle - x).norm() >= nearest) continue;
          nearest = (middle - x).norm();
          of_it = cost(i, j);
        }
      EXPECT_LE(nearest, 1e-12);
      found += of_it;
    }
    // Steps along the first loop (1) and the second (0): one of the first comes first, one of the
    // second last, and no pair comes twice.
    double least = infinity;
    for (int start = 0; start < m; ++start) {
      std::vector<int> steps(std::size_t(n + m - 2), 0);
      std::fill(steps.end() - (n - 1), steps.end(), 1);
      do {
        std::set<std::pair<int, int>> pairs{{0, start}};
        double sum = cost(0, start);
        int i = 1, j = start;
        for (std::size_t s = 0; s <= steps.size(); ++s) {
          pairs.emplace(i % n, j % m);
          sum += cost(i, j);
          if (s == steps.size()) break;
          i += steps[s];
          j += 1 - steps[s];
        }
        if (int_size(pairs) == n + m) least = std::min(least, sum);
      } while (std::next_permutation(steps.begin(), steps.end()));
    }
    EXPECT_NEAR(found, least, 1e-9 * least);
    ++tubes;
  }
  EXPECT_GT(tubes, 10);
}

TEST(CellSurface, OfEqualDiagonalsRoundingDoesNotChoose) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> some(-1e-13, 1e-13);
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {-1, 1}) {
      std::array<double, 8> value{};
      for (int c = 0; c < 8; ++c)  // a rectangle, slanted so that crossings change its sides
        value[std::size_t(c)] = sign * (corner(c)[axis] + 0.3 * corner(c)[(axis + 1) % 3] - 0.6);
      Patch plain;
      span_cell(cell_of(value), plain);
      ASSERT_EQ(plain.triangles.size(), 2u);
      for (int round = 0; round < 100; ++round) {
        auto other = value;
        for (double& v : other) v += some(random);
        Patch patch;
        span_cell(cell_of(other), patch);
        EXPECT_EQ(patch.triangles, plain.triangles);
      }
    }
}

TEST(CellSurface, PointsInsideLieOnTheLevelSetOfTheTrilinearFunction) {
  std::mt19937 random(4);
  int on = 0, all = 0;
  for (int round = 0; round < 30000; ++round) {
    const Cell cell = cell_of(random_values(random));
    Patch patch;
    span_cell(cell, patch);
    Cell plain = cell;
    plain.trilinear = false;
    Patch unmoved;
    span_cell(plain, unmoved);
    ASSERT_EQ(unmoved.inner.size(), patch.inner.size());
    ASSERT_EQ(unmoved.triangles, patch.triangles);
    for (std::size_t i = 0; i < patch.inner.size(); ++i, ++all) {
      const double before = std::abs(trilinear(cell.value, unmoved.inner[i]));
      const double after = std::abs(trilinear(cell.value, patch.inner[i]));
      EXPECT_LE(after, before + 1e-12);
      on += after < 1e-4;
    }
  }
  EXPECT_GT(all, 1000);
  EXPECT_GT(on, 0.95 * all);
}

}  // namespace
}  // namespace littoral::cell
