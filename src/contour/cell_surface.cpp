#include "contour/cell_surface.h"

#include <algorithm>
#include <cmath>

#include "base/index.h"

namespace littoral::cell {

namespace {

constexpr int first_inner = 12;
constexpr double rounding = 1e-9;  // relative, of sums of squares

class Spanner {
 public:
  Spanner(const Cell& cell, Patch& patch) : cell_(cell), patch_(patch) {}

  void run() {
    loops_ = trace_loops(cell_.value, cell_.positive);
    const auto tunnel = find_tunnel(cell_.value, cell_.positive, loops_);
    for (int loop = 0; loop < loops_.count; ++loop) {
      if (!tunnel || (loop != tunnel->first && loop != tunnel->second)) disc(loop);
    }
    if (tunnel) tube(tunnel->first, tunnel->second);
  }

 private:
  int node(int loop, int i) const {
    return loops_.edge[loops_.begin[loop] + i % loops_.size(loop)];
  }
  const Vec3& point(int id) const {
    return id < first_inner ? cell_.crossing[id] : patch_.inner[id - first_inner];
  }
  double squared_distance(int a, int b) const {
    return cell_.spacing.cwiseProduct(point(a) - point(b)).squaredNorm();
  }
  static bool on_common_face(int e, int f) { return (edges()[e].faces & edges()[f].faces) != 0; }
  void add(int a, int b, int c) { patch_.triangles.push_back({a, b, c}); }

  // Shortest sum of squared diagonals: best[i][j] spans the nodes i..j of the loop. Of equal ones,
  // as in rectangles, the first: rounding, which differs between machines, has no say.
  void disc(int loop) {
    const int n = loops_.size(loop);
    if (n == 3) return add(node(loop, 0), node(loop, 1), node(loop, 2));
    std::array<std::array<double, 12>, 12> best{};
    std::array<std::array<int, 12>, 12> middle{};
    for (int length = 2; length < n; ++length) {
      for (int i = 0; i + length < n; ++i) {
        const int j = i + length;
        best[i][j] = infinity;
        const bool is_diagonal = length < n - 1;
        if (is_diagonal && on_common_face(node(loop, i), node(loop, j))) continue;
        const double own = is_diagonal ? squared_distance(node(loop, i), node(loop, j)) : 0;
        for (int k = i + 1; k < j; ++k) {
          const double total = own + best[i][k] + best[k][j];
          if (total < (1 - rounding) * best[i][j]) {
            best[i][j] = total;
            middle[i][j] = k;
          }
        }
      }
    }
    if (!(best[0][n - 1] < infinity)) return fan(loop);
    const auto emit = [&](const auto& self, int i, int j) -> void {
      if (j - i < 2) return;
      const int k = middle[i][j];
      add(node(loop, i), node(loop, k), node(loop, j));
      self(self, i, k);
      self(self, k, j);
    };
    emit(emit, 0, n - 1);
  }

  void fan(int loop) {
    const int n = loops_.size(loop);
    Vec3 centre = Vec3::Zero();
    for (int i = 0; i < n; ++i) centre += point(node(loop, i)) / n;
    const int inner = add_inner(centre);
    for (int i = 0; i < n; ++i) add(node(loop, i), node(loop, i + 1), inner);
  }

  // A ribbon between two loops, cut across along a ring of points half way: so no edge joins two
  // crossings. The loops run in opposite senses around the tube.
  void tube(int first, int second) {
    const int n = loops_.size(first), m = loops_.size(second);
    const auto b = [&](int j) { return node(second, 2 * m - j % m); };
    // Shortest ribbon over all starts: step along the first loop or the second.
    double least = infinity;
    std::vector<std::pair<int, int>> ribbon, trial;
    for (int start = 0; start < m; ++start) {
      const double length = shortest_ribbon(first, second, start, trial);
      if (length < least) {
        least = length;
        ribbon = trial;
      }
    }
    std::vector<int> ring;
    for (const auto& [i, j] : ribbon) {
      ring.push_back(add_inner(0.5 * point(node(first, i)) + 0.5 * point(b(j))));
    }
    const std::size_t count = ribbon.size();
    for (std::size_t s = 0; s < count; ++s) {
      const auto& [i, j] = ribbon[s];
      const int here = ring[s], there = ring[(s + 1) % count];
      const auto& next = ribbon[(s + 1) % count];
      const bool moves_first = s + 1 < count ? next.first != i : i != n;
      if (moves_first) {
        add(node(first, i), node(first, i + 1), there);
        add(node(first, i), there, here);
        add(here, there, b(j));
      } else {
        add(b(j + 1), b(j), here);
        add(b(j + 1), here, there);
        add(here, node(first, i), there);
      }
    }
  }

  // Pairs (i, j) that a ribbon from (0, start) to (n, start + m) passes, the last one left out. It
  // begins along the first loop, ends along the second and goes around neither at one pair's place
  // of the other, so no pair comes twice.
  double shortest_ribbon(int first, int second, int start,
                         std::vector<std::pair<int, int>>& steps) const {
    const int n = loops_.size(first), m = loops_.size(second);
    std::array<std::array<double, 13>, 13> best;
    for (auto& row : best) row.fill(infinity);
    const auto cost = [&](int i, int j) {
      return squared_distance(node(first, i), node(second, 2 * m - (start + j) % m));
    };
    for (int i = 0; i <= n; ++i) {
      for (int j = 0; j <= m; ++j) {
        if ((i == 0 && j > 0) || (i == n && j == 0) || (i < n && j == m)) continue;
        double before = i + j == 0 ? 0 : infinity;
        if (i > 0) before = std::min(before, best[i - 1][j]);
        if (j > 0) before = std::min(before, best[i][j - 1]);
        best[i][j] = before + cost(i, j);
      }
    }
    steps.clear();
    for (int i = n, j = m; i + j > 0;) {
      if (j == 0 || (i > 0 && best[i - 1][j] < best[i][j - 1])) {
        --i;
      } else {
        --j;
      }
      steps.emplace_back(i, start + j);
    }
    std::reverse(steps.begin(), steps.end());
    return best[n][m] - cost(n, m);  // which is the first pair again
  }

  int add_inner(Vec3 p) {
    p = Vec3::Constant(0.5) + 0.9 * (p - Vec3::Constant(0.5));  // off the faces
    if (cell_.trilinear) move_onto_level(p);
    patch_.inner.push_back(p);
    return first_inner + int_size(patch_.inner) - 1;
  }

  // A few damped Newton steps along the gradient of the trilinear function, inside the cell.
  void move_onto_level(Vec3& p) const {
    double scale = 0;
    for (double v : cell_.value) scale = std::max(scale, std::abs(v));
    if (!(scale > 0)) return;
    Vec3 at = p;
    for (int round = 0; round < 4; ++round) {
      double f = 0;
      Vec3 gradient = Vec3::Zero();
      for (int c = 0; c < 8; ++c) {
        Vec3 weight;
        for (int k = 0; k < 3; ++k) weight[k] = (c >> k & 1) ? at[k] : 1 - at[k];
        const double v = cell_.value[c] / scale;
        f += v * weight.prod();
        for (int k = 0; k < 3; ++k) {
          const double side = (c >> k & 1) ? 1 : -1;
          gradient[k] += side * v * weight[(k + 1) % 3] * weight[(k + 2) % 3];
        }
      }
      const double slope = gradient.squaredNorm();
      if (!(slope > 1e-6)) return;
      Vec3 step = -f / slope * gradient;
      if (step.norm() > 0.2) step *= 0.2 / step.norm();
      at += step;
      if (at.minCoeff() < 0.02 || at.maxCoeff() > 0.98) return;
    }
    p = at;
  }

  const Cell& cell_;
  Patch& patch_;
  Loops loops_;
};

}  // namespace

void span_cell(const Cell& cell, Patch& patch) { Spanner(cell, patch).run(); }

}  // namespace littoral::cell
