#include "methods/implicit/level_patch.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "base/index.h"
#include "base/parallel.h"
#include "contour/cell_surface.h"
#include "spatial/triangle_bvh.h"

namespace littoral {

namespace {

using Field = std::function<double(const Vec3&)>;
using Corner = std::array<int, 3>;

constexpr int extra_levels = 3;  // below the spacing, beside the boundary
constexpr int most_levels = 18;  // above it: corners of 21 bits
constexpr double margin = 0.5;   // around the boundary, in the longest side of its box
constexpr double clear = 1.1;    // from the boundary, in sides: here values modulo 1 are a function
constexpr double steepness =
    0.35;  // of values times the distance to the boundary; 1 / 2 pi beside one edge
constexpr double beside_edge =
    0.75;                          // of the distance to that half plane, as there are other edges
constexpr double integral = 0.4;   // modulo 1 farther from the level: the surface's sides
constexpr double off_patch = 0.1;  // to both sides of a triangle, in sides
constexpr std::size_t most_cells = 130000;

/// A cube of the octree, its centre's value modulo 1 in [-1/2, 1/2].
struct Cube {
  int level;
  Corner at;  // in cubes of its level
  double value;
};

struct Octree {
  Vec3 origin;
  double side;  // of the root
  int spacing_level, finest;
  double side_at(int level) const { return std::ldexp(side, -level); }
  Vec3 centre(int level, const Corner& at) const {
    return origin + side_at(level) * (Vec3(at[0], at[1], at[2]).array() + 0.5).matrix();
  }
  Vec3 corner(const Corner& at) const {  // in cubes of the finest level
    return origin + side_at(finest) * Vec3(at[0], at[1], at[2]);
  }
};

double modulo(double value) { return value - std::round(value); }

TriangleBvh edge_tree(const MatX3& points, const std::vector<std::array<int, 2>>& boundary) {
  MatX3i sides(boundary.size(), 3);
  for (std::size_t e = 0; e < boundary.size(); ++e)
    sides.row(index(e)) << boundary[e][0], boundary[e][1], boundary[e][1];
  return {points, sides};
}

Octree octree_around(const MatX3& points, const std::vector<std::array<int, 2>>& boundary,
                     double spacing) {
  Vec3 low = points.row(boundary.front()[0]), high = low;
  for (const auto& edge : boundary)
    for (const int v : edge) {
      low = low.cwiseMin(points.row(v).transpose());
      high = high.cwiseMax(points.row(v).transpose());
    }
  const double longest = std::max((1 + 2 * margin) * (high - low).maxCoeff(), spacing);
  Octree tree;
  tree.spacing_level = std::clamp(static_cast<int>(std::ceil(std::log2(longest / spacing))), 0,
                                  most_levels - extra_levels);
  tree.finest = tree.spacing_level + extra_levels;
  tree.side = std::max(longest, std::ldexp(spacing, tree.spacing_level));
  // Rims often lie in planes of symmetry: corners should not.
  tree.origin = low + (high - low) / 2 - Vec3::Constant(tree.side / 2) +
                tree.side_at(tree.spacing_level) * Vec3(0.213, 0.141, 0.173);
  return tree;
}

/// Cubes that the level set may pass and in which values modulo 1 are a function.
class Search {
 public:
  Search(const Field& inside, const TriangleBvh& boundary, Octree& tree, const Task& task)
      : inside_(inside), boundary_(boundary), tree_(tree), task_(task) {}

  std::vector<Cube> run(bool& complete) {
    std::vector<Cube> halved{{-1, {0, 0, 0}, 0}};
    std::size_t looked_at = 0;
    for (int level = 0; !halved.empty(); ++level) {
      const std::size_t count = level == 0 ? 1 : 8 * halved.size();
      looked_at += count;
      if (level > tree_.spacing_level && looked_at > most_cells) {
        complete = false;
        break;
      }
      halved = visit(level, halved, count);
    }
    return std::move(found_);
  }

 private:
  enum class Verdict { leave, keep, halve };

  Verdict judge(int level, double value, double distance) const {
    const double side = tree_.side_at(level), reach = side * std::sqrt(0.75);
    if (std::abs(value) * (distance - reach) > steepness * reach) return Verdict::leave;
    // Beside one edge the value is an angle, and the level set a half plane.
    if (beside_edge * distance * std::min(1.0, 4 * std::abs(value)) > reach) return Verdict::leave;
    if (level < tree_.spacing_level) return Verdict::halve;
    if (distance >= clear * side) return Verdict::keep;
    return level < tree_.finest ? Verdict::halve : Verdict::leave;
  }

  std::vector<Cube> visit(int level, const std::vector<Cube>& parents, std::size_t count) {
    std::vector<Cube> cubes(count);
    std::vector<Verdict> verdicts(count);
    parallel_for(count, 256, [&](std::size_t begin, std::size_t end) {
      task_.checkpoint();
      int near = -1;
      for (std::size_t i = begin; i < end; ++i) {
        Cube& cube = cubes[i];
        cube = {level, {0, 0, 0}, 0};
        if (level > 0)
          for (std::size_t a = 0; a < 3; ++a)
            cube.at[a] = 2 * parents[i / 8].at[a] + static_cast<int>(i >> a & 1);
        const Vec3 centre = tree_.centre(level, cube.at);
        const NearestPoint foot = boundary_.closest_point(centre, near);
        near = foot.face;
        const bool too_near = foot.distance < clear * tree_.side_at(level);
        if (too_near && (level == tree_.finest || level <= tree_.spacing_level)) {
          verdicts[i] = level == tree_.finest ? Verdict::leave : Verdict::halve;
          continue;
        }
        cube.value = modulo(inside_(centre));
        verdicts[i] = judge(level, cube.value, foot.distance);
      }
    });
    std::vector<Cube> halved;
    for (std::size_t begin = 0; begin < count; begin += 8) {
      const std::size_t end = std::min(begin + 8, count);
      // Around a piece of boundary that matters values take every angle; on both sides of a crack
      // they are those of the surface.
      double nearest = 1;
      for (std::size_t i = begin; i < end; ++i)
        nearest = std::min(nearest, std::abs(cubes[i].value));
      if (level > tree_.spacing_level && level < tree_.finest && nearest > integral) continue;
      for (std::size_t i = begin; i < end; ++i) {
        if (verdicts[i] == Verdict::keep) found_.push_back(cubes[i]);
        if (verdicts[i] == Verdict::halve) halved.push_back(cubes[i]);
      }
    }
    finest_visited_ = level;
    return halved;
  }

  const Field& inside_;
  const TriangleBvh& boundary_;
  Octree& tree_;
  const Task& task_;
  std::vector<Cube> found_;

 public:
  int finest_visited_ = 0;
};

/// Values at the corners of cubes, each asked once.
class CornerValues {
 public:
  CornerValues(const Field& inside, const Octree& tree, const std::vector<Cube>& cubes,
               const Task& task)
      : tree_(tree) {
    for (const Cube& cube : cubes)
      for (int c = 0; c < 8; ++c) keys_.push_back(key(corner_of(cube, c)));
    std::sort(keys_.begin(), keys_.end());
    keys_.erase(std::unique(keys_.begin(), keys_.end()), keys_.end());
    values_.resize(keys_.size());
    parallel_for(keys_.size(), 1024, [&](std::size_t begin, std::size_t end) {
      task.checkpoint();
      for (std::size_t i = begin; i < end; ++i) values_[i] = inside(tree.corner(corner(keys_[i])));
    });
  }
  Corner corner_of(const Cube& cube, int c) const {
    Corner out;
    for (std::size_t a = 0; a < 3; ++a)
      out[a] = (cube.at[a] + (c >> a & 1)) << (tree_.finest - cube.level);
    return out;
  }
  double operator()(const Cube& cube, int c) const {
    const auto at = std::lower_bound(keys_.begin(), keys_.end(), key(corner_of(cube, c)));
    return values_[at - keys_.begin()];
  }

 private:
  static std::uint64_t key(const Corner& p) {
    std::uint64_t out = 0;
    for (const int x : p) out = out << 21 | static_cast<std::uint64_t>(x);
    return out;
  }
  static Corner corner(std::uint64_t key) {
    constexpr std::uint64_t mask = (1 << 21) - 1;
    return {static_cast<int>(key >> 42), static_cast<int>(key >> 21 & mask),
            static_cast<int>(key & mask)};
  }

  const Octree& tree_;
  std::vector<std::uint64_t> keys_;
  std::vector<double> values_;
};

/// Triangles of one cube, three points each.
void contour(const Cube& cube, const Octree& tree, const CornerValues& values, const Field& inside,
             std::vector<Vec3>& out) {
  cell::Cell cell;
  for (int c = 0; c < 8; ++c) {
    const double value = values(cube, c), lifted = cube.value + modulo(value - cube.value);
    cell.value[c] = -lifted;
    if (lifted < 0) cell.positive |= 1u << c;
  }
  if (cell.positive == 0 || cell.positive == 255) return;
  const double side = tree.side_at(cube.level);
  const Vec3 low = tree.centre(cube.level, cube.at) - Vec3::Constant(side / 2);
  for (std::size_t e = 0; e < 12; ++e) {
    const cell::Edge& edge = cell::edges()[e];
    double a = cell.value[edge.tail], b = cell.value[edge.head];
    if ((a > 0) == (b > 0)) continue;
    Vec3 from(edge.tail & 1, edge.tail >> 1 & 1, edge.tail >> 2);
    double t0 = 0, t1 = 1;
    // The function bends beside the boundary: once more between the crossing of the chord and the
    // end on its other side.
    const double t = a / (a - b);
    Vec3 x = from;
    x[edge.axis] = t;
    const double there = -(cube.value + modulo(inside(low + side * x) - cube.value));
    if ((there > 0) == (a > 0))
      t0 = t, a = there;
    else
      t1 = t, b = there;
    x[edge.axis] = a == b ? t : t0 + (t1 - t0) * a / (a - b);
    cell.crossing[e] = x;
  }
  cell.spacing.setConstant(side);
  cell::Patch patch;
  cell::span_cell(cell, patch);
  for (const auto& triangle : patch.triangles) {
    std::array<Vec3, 3> p;
    for (std::size_t k = 0; k < 3; ++k)
      p[k] = low +
             side * (triangle[k] < 12 ? cell.crossing[triangle[k]] : patch.inner[triangle[k] - 12]);
    // Of other levels, and along sheets that the level comes near from one side, the sign does not
    // change.
    const Vec3 normal = (p[1] - p[0]).cross(p[2] - p[0]).normalized();
    const Vec3 centre = (p[0] + p[1] + p[2]) / 3;
    if (inside(centre - off_patch * side * normal) > 0 &&
        inside(centre + off_patch * side * normal) <= 0)
      out.insert(out.end(), p.begin(), p.end());
  }
}

}  // namespace

LevelPatch level_patch(const Field& inside, const MatX3& points,
                       const std::vector<std::array<int, 2>>& boundary, double spacing,
                       const Task& task) {
  LevelPatch patch;
  if (boundary.empty()) return patch;
  const TriangleBvh edges = edge_tree(points, boundary);
  Octree tree = octree_around(points, boundary, spacing);
  Search search(inside, edges, tree, task);
  const std::vector<Cube> cubes = search.run(patch.complete);
  patch.finest = tree.side_at(search.finest_visited_);
  const CornerValues values(inside, tree, cubes, task);

  constexpr std::size_t grain = 256;
  std::vector<std::vector<Vec3>> parts(cubes.size() / grain + 1);
  parallel_for(cubes.size(), grain, [&](std::size_t begin, std::size_t end) {
    task.checkpoint();
    for (std::size_t i = begin; i < end; ++i)
      contour(cubes[i], tree, values, inside, parts[begin / grain]);
  });
  std::size_t corners = 0;
  for (const auto& part : parts) corners += part.size();
  patch.points.resize(corners, 3);
  patch.faces.resize(corners / 3, 3);
  Eigen::Index at = 0;
  for (const auto& part : parts)
    for (const Vec3& p : part) patch.points.row(at++) = p;
  for (Eigen::Index f = 0; f < patch.faces.rows(); ++f) {
    patch.faces.row(f) << 3 * f, 3 * f + 1, 3 * f + 2;
    const Vec3 a = patch.points.row(3 * f), b = patch.points.row(3 * f + 1),
               c = patch.points.row(3 * f + 2);
    patch.area += (b - a).cross(c - a).norm() / 2;
  }
  return patch;
}

}  // namespace littoral
