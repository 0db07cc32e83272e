#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>

#include "base/index.h"
#include "base/option_table.h"
#include "base/parallel.h"
#include "contour/cell_surface.h"
#include "contour/isosurface.h"
#include "contour/rough_surface.h"
#include "littoral/error.h"

namespace littoral {

namespace {

// The grid, with a layer of nodes above the level around it if it is to be closed. Those nodes lie
// one spacing outside, and crossings on the way to them at the box.
class Samples {
 public:
  Samples(const Grid& grid, const VecX& values, double level, const IsosurfaceOptions& options)
      : grid_(grid),
        values_(values),
        level_(level),
        function_(options.function),
        pad_(options.close ? 1 : 0) {
    for (int k = 0; k < 3; ++k) n[k] = grid.n[k] + 2 * pad_;
    if (options.close)
      outside_ = std::max(1e-300, (0.5 * values.array() - 0.5 * level).abs().maxCoeff());
    const auto slice = std::size_t(n[0]) * n[1];
    positive_.resize(slice * n[2]);
    parallel_for(n[2], 1, [&](std::size_t k, std::size_t) {
      auto* sign = positive_.data() + k * slice;
      for (int j = 0; j < n[1]; ++j)
        for (int i = 0; i < n[0]; ++i) *sign++ = padded(i, j, k) || values[real(i, j, k)] > level;
    });
  }
  bool padded(int i, int j, int k) const {
    return pad_ != 0 &&
           (i == 0 || j == 0 || k == 0 || i == n[0] - 1 || j == n[1] - 1 || k == n[2] - 1);
  }
  bool positive(int i, int j, int k) const { return positive_[node(i, j, k)] != 0; }
  // Half the value minus the level: the difference of two huge numbers stays finite.
  double value(int i, int j, int k) const {
    return padded(i, j, k) ? outside_ : 0.5 * values_[real(i, j, k)] - 0.5 * level_;
  }
  Vec3 point(const Vec3& at) const {
    return grid_.origin + grid_.spacing.cwiseProduct(at - Vec3::Constant(pad_));
  }
  // Where between node p (0) and node q (1) the level is met.
  double crossing(const std::array<int, 3>& p, const std::array<int, 3>& q) const {
    if (padded(p[0], p[1], p[2])) return 1;
    if (padded(q[0], q[1], q[2])) return 0;
    const double a = value(p[0], p[1], p[2]), b = value(q[0], q[1], q[2]);
    if (a == b) return 0.5;
    return function_ ? root(p, q, a, b) : std::clamp(a / (a - b), 0.0, 1.0);
  }
  // Point p, 0 to 1, of the cell at `corner`, moved within it to where the function, if there is
  // one, takes the level, or as near to that as it gets.
  Vec3 inside(const Vec3& corner, Vec3 p) const {
    if (!function_) return point(corner + p);
    constexpr int most = 12;
    constexpr double enough = 1e-3, step = 1e-4, rim = 0.02;  // of a cell
    const double h = grid_.spacing.minCoeff();
    const auto off = [&](const Vec3& q) { return (function_(point(corner + q)) - level_) / h; };
    double here = off(p);
    for (int i = 0; i < most && std::abs(here) > enough; ++i) {
      Vec3 slope;
      for (int a = 0; a < 3; ++a)
        slope[a] = (off(p + step * Vec3::Unit(a)) - off(p - step * Vec3::Unit(a))) / (2 * step);
      const double square = slope.squaredNorm();
      if (!(square > 0) || !std::isfinite(square)) break;
      double length = 1;
      bool nearer = false;
      for (; !nearer && length > 0.1; length /= 2) {
        const Vec3 q = (p - length * here / square * slope).cwiseMax(rim).cwiseMin(1 - rim);
        const double there = off(q);
        nearer = std::abs(there) < std::abs(here);
        if (nearer) {
          p = q;
          here = there;
        }
      }
      if (!nearer) break;
    }
    return point(corner + p);
  }
  std::int64_t node(int i, int j, int k) const {
    return i + static_cast<std::int64_t>(n[0]) * (j + static_cast<std::int64_t>(n[1]) * k);
  }
  const Vec3& spacing() const { return grid_.spacing; }

  std::array<int, 3> n{};

 private:
  // The same by the function itself; half its value minus the level is a at p and b at q, of which
  // one is above zero. Regula falsi, where the end that stays counts half (Illinois).
  double root(const std::array<int, 3>& p, const std::array<int, 3>& q, double a, double b) const {
    constexpr double enough = 1e-3;  // of the edge
    constexpr int most = 40;
    const Vec3 from = point(Vec3(p[0], p[1], p[2])), to = point(Vec3(q[0], q[1], q[2]));
    const double flat = 0.5 * enough * (to - from).norm();  // a distance this far is that near
    double low = 0, high = 1, t = 0.5;
    int kept = 0;
    for (int i = 0; i < most && high - low > enough; ++i) {
      t = i % 4 == 3 ? 0.5 * (low + high) : (low * b - high * a) / (b - a);
      const double here = 0.5 * function_(from + t * (to - from)) - 0.5 * level_;
      if (!std::isfinite(here)) break;
      if (std::abs(here) <= 0.1 * flat) return std::clamp(t, 0.0, 1.0);
      if ((here > 0) == (b > 0)) {
        high = t;
        b = here;
        if (kept == 1) a *= 0.5;
        kept = 1;
      } else {
        low = t;
        a = here;
        if (kept == -1) b *= 0.5;
        kept = -1;
      }
    }
    return std::clamp(t, 0.0, 1.0);
  }
  Eigen::Index real(int i, int j, int k) const {
    return index(grid_.node(i - pad_, j - pad_, k - pad_));
  }
  const Grid& grid_;
  const VecX& values_;
  double level_;
  const std::function<double(const Vec3&)>& function_;
  int pad_;
  double outside_ = 1;
  std::vector<unsigned char> positive_;  // nodes: above the level?
};

void check(const Grid& grid, const VecX& values, double level) {
  for (int k = 0; k < 3; ++k) {
    if (grid.n[k] < 2) throw InputError("isosurface: a grid needs two nodes along each axis");
    if (!(grid.spacing[k] > 0) || !std::isfinite(grid.spacing[k]) ||
        !std::isfinite(grid.origin[k])) {
      throw InputError("isosurface: the grid's spacing must be positive, its box finite",
                       "option-value");
    }
  }
  if (values.size() != index(grid.n_nodes())) {
    throw InputError("isosurface: " + std::to_string(values.size()) + " values for " +
                         std::to_string(grid.n_nodes()) + " nodes",
                     "sizes-differ");
  }
  if (!std::isfinite(level))
    throw InputError("isosurface: the level must be a finite number", "option-value");
  const std::size_t n = values.size();
  std::atomic<std::size_t> first{n};
  parallel_for(n, 1 << 18, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (std::isfinite(values[i])) continue;
      for (std::size_t seen = first; i < seen && !first.compare_exchange_weak(seen, i);) continue;
      return;
    }
  });
  if (first < n) {
    const std::size_t x = first % grid.n[0], rest = first / grid.n[0];
    throw InputError("isosurface: the value of node (" + std::to_string(x) + ", " +
                         std::to_string(rest % grid.n[1]) + ", " +
                         std::to_string(rest / grid.n[1]) + ") is " + number_text(values[first]) +
                         "; a level set needs finite values",
                     "not-finite");
  }
}

// A crossed edge: where it starts in its slice, and along which axis it runs.
struct Crossed {
  int node, axis;
};

class Marcher {
 public:
  Marcher(const Samples& samples, const Task& task) : s_(samples), task_(task) {}

  RoughSurface run() {
    find_crossings();
    RoughSurface rough;
    const std::size_t slices = s_.n[2];
    rough.points.resize(start_[slices]);
    rough.separated_points.resize(start_[slices]);
    rough.node.resize(start_[slices]);
    where_.resize(start_[slices]);
    place_points(rough);
    std::vector<Layer> layers(slices - 1);
    std::atomic<std::size_t> done{0};
    parallel_for(slices - 1, 4, [&](std::size_t begin, std::size_t end) {
      std::vector<int> below(3 * slice_size(), -1), above(3 * slice_size(), -1);
      enter(begin, below, true);
      for (std::size_t k = begin; k < end; ++k) {
        task_.checkpoint(0.4 + 0.6 * static_cast<double>(done++) / static_cast<double>(slices));
        enter(k + 1, above, true);
        span_layer(k, below, above, layers[k]);
        enter(k, below, false);
        std::swap(below, above);
      }
    });
    join(layers, rough);
    return rough;
  }

 private:
  struct Layer {
    std::vector<Vec3> inner;
    std::vector<std::array<int, 3>> triangles;  // inner points as -1 - index
  };

  std::size_t slice_size() const { return std::size_t(s_.n[0]) * s_.n[1]; }

  void find_crossings() {
    const std::size_t slices = s_.n[2];
    crossed_.resize(slices);
    std::atomic<std::size_t> done{0};
    parallel_for(slices, 1, [&](std::size_t begin, std::size_t) {
      const int k = begin;
      task_.checkpoint(0.3 * static_cast<double>(done++) / static_cast<double>(slices));
      for (int j = 0; j < s_.n[1]; ++j) {
        for (int i = 0; i < s_.n[0]; ++i) {
          const bool here = s_.positive(i, j, k);
          const int node = i + s_.n[0] * j;
          const bool crosses[3] = {i + 1 < s_.n[0] && s_.positive(i + 1, j, k) != here,
                                   j + 1 < s_.n[1] && s_.positive(i, j + 1, k) != here,
                                   k + 1 < s_.n[2] && s_.positive(i, j, k + 1) != here};
          for (int axis = 0; axis < 3; ++axis) {
            if (crosses[axis]) crossed_[begin].push_back({node, axis});
          }
        }
      }
    });
    start_.assign(slices + 1, 0);
    for (std::size_t k = 0; k < slices; ++k) start_[k + 1] = start_[k] + crossed_[k].size();
    check_count(start_[slices]);
  }

  void place_points(RoughSurface& rough) {
    parallel_for(crossed_.size(), 1, [&](std::size_t k, std::size_t) {
      task_.checkpoint(0.35);
      for (std::size_t c = 0; c < crossed_[k].size(); ++c) {
        const Crossed& edge = crossed_[k][c];
        const std::array<int, 3> p{edge.node % s_.n[0], edge.node / s_.n[0], static_cast<int>(k)};
        std::array<int, 3> q = p;
        ++q[edge.axis];
        Vec3 along = Vec3::Zero();
        along[edge.axis] = 1;
        const double t = where_[start_[k] + c] = s_.crossing(p, q);
        const Vec3 base(p[0], p[1], p[2]);
        const auto& near = t < 0.5 ? p : q;
        place_crossing(rough, start_[k] + c, t, s_.node(near[0], near[1], near[2]),
                       [&](double u) { return s_.point(base + u * along); });
      }
    });
  }

  // Numbers of the crossed edges of a slice, by 3 node + axis; or takes them out again.
  void enter(std::size_t k, std::vector<int>& table, bool in) const {
    for (std::size_t c = 0; c < crossed_[k].size(); ++c) {
      const Crossed& edge = crossed_[k][c];
      table[3 * std::size_t(edge.node) + edge.axis] = in ? static_cast<int>(start_[k] + c) : -1;
    }
  }

  void span_layer(int k, const std::vector<int>& below, const std::vector<int>& above,
                  Layer& layer) const {
    cell::Cell one;
    one.spacing = s_.spacing();
    cell::Patch patch;
    for (int j = 0; j + 1 < s_.n[1]; ++j) {
      for (int i = 0; i + 1 < s_.n[0]; ++i) {
        one.positive = 0;
        for (int c = 0; c < 8; ++c) {
          if (s_.positive(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2))) one.positive |= 1u << c;
        }
        if (one.positive == 0 || one.positive == 255) continue;
        span(i, j, k, below, above, one, patch, layer);
      }
    }
  }

  void span(int i, int j, int k, const std::vector<int>& below, const std::vector<int>& above,
            cell::Cell& one, cell::Patch& patch, Layer& layer) const {
    one.trilinear = true;
    for (int c = 0; c < 8; ++c) {
      const int x = i + (c & 1), y = j + (c >> 1 & 1), z = k + (c >> 2);
      one.value[c] = s_.value(x, y, z);
      if (s_.padded(x, y, z)) one.trilinear = false;
    }
    std::array<int, 12> number{};
    for (int e = 0; e < 12; ++e) {
      const cell::Edge& edge = cell::edges()[e];
      if ((one.positive >> edge.tail & 1) == (one.positive >> edge.head & 1)) continue;
      std::array<int, 3> p;
      for (int a = 0; a < 3; ++a) p[a] = edge.tail >> a & 1;
      const std::size_t node = i + p[0] + std::size_t(s_.n[0]) * (j + p[1]);
      number[e] = (p[2] ? above : below)[3 * node + edge.axis];
      one.crossing[e] = Vec3(p[0], p[1], p[2]);
      // Crossings that are about to become one point must not put two inner points in one place.
      one.crossing[e][edge.axis] = std::clamp(where_[number[e]], close_to_node, 1 - close_to_node);
    }
    patch.clear();
    cell::span_cell(one, patch);
    const int inner = layer.inner.size();
    for (const Vec3& p : patch.inner)
      layer.inner.push_back(one.trilinear ? s_.inside(Vec3(i, j, k), p)
                                          : s_.point(Vec3(i, j, k) + p));
    for (const auto& t : patch.triangles) {
      std::array<int, 3> corners;
      for (int c = 0; c < 3; ++c) corners[c] = t[c] < 12 ? number[t[c]] : -1 - (inner + t[c] - 12);
      layer.triangles.push_back(corners);
    }
  }

  void join(const std::vector<Layer>& layers, RoughSurface& rough) const {
    std::size_t triangles = 0, points = rough.points.size();
    for (const Layer& layer : layers) {
      triangles += layer.triangles.size();
      points += layer.inner.size();
    }
    check_count(std::max(points, triangles));
    rough.triangles.reserve(triangles);
    for (const Layer& layer : layers) {
      task_.checkpoint(1);
      const int base = rough.points.size();
      for (const Vec3& p : layer.inner) add_point(rough, p);
      for (auto t : layer.triangles) {
        for (int& v : t) v = v < 0 ? base - 1 - v : v;
        rough.triangles.push_back(t);
      }
    }
  }

  const Samples& s_;
  const Task& task_;
  std::vector<std::vector<Crossed>> crossed_;  // by slice, in order of nodes
  std::vector<std::size_t> start_;             // slices + 1: number of a slice's first crossing
  std::vector<double> where_;                  // crossings: fraction of the edge
};

}  // namespace

PolygonSoup isosurface(const Grid& grid, const VecX& values, double level,
                       const IsosurfaceOptions& options, Report& report, Task task) {
  check(grid, values, level);
  const Samples samples(grid, values, level, options);
  const Task march = task.stage(0.7, "marching cubes");
  PolygonSoup surface =
      merge_close_points(Marcher(samples, march).run(), task.stage(0.3, "joining points"));
  report_boundary(surface, level, report);
  return surface;
}

}  // namespace littoral
