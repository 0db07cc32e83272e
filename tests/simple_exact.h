#pragma once
// Exact polyhedral distance, the simple way: windows one by one, none compared with another. What
// the library's is compared with. Slow where many triangles coincide.

#include <limits>
#include <numbers>
#include <queue>
#include <stdexcept>

#include "domain/mesh/edge_sides.h"
#include "simple_window.h"
#include "sources/surface/triangle_sources.h"

namespace littoral::test::simple {

inline constexpr double infinite = std::numeric_limits<double>::infinity();
inline constexpr double slack_share = 1e-12;  // of the longest distance in play: ties are kept
inline constexpr double coverage_share =
    1e-9;  // of a side: rays this near a window's end reach a vertex

inline double cross(Complex a, Complex b) { return a.real() * b.imag() - a.imag() * b.real(); }

/// Vertices at which a shortest path may bend: not inside a disk of at most a full turn.
inline std::vector<char> bending_vertices(const IntrinsicTriangulation& T, const EdgeSides& sides) {
  VecX turn = VecX::Zero(T.n_vertices);
  std::vector<int> corners(T.n_vertices, 0), spokes(T.n_vertices, 0), walked(T.n_vertices, 0);
  std::vector<char> bends(T.n_vertices, 0);
  std::vector<TriangleSide> corner_of(T.n_vertices, {-1, 0});
  for (int f = 0; f < T.n_faces(); ++f) {
    const TriangleShape t = T.shape(f);
    for (int k = 0; k < 3; ++k) {
      turn[T.faces(f, k)] += std::atan2(1.0, t.cot[k]);
      ++corners[T.faces(f, k)];
      corner_of[T.faces(f, k)] = {f, k};
    }
  }
  for (int e = 0; e < T.n_edges(); ++e)
    if (sides.at(e).size() != 2) bends[T.edges(e, 0)] = bends[T.edges(e, 1)] = 1;
  for (int v = 0; v < T.n_vertices; ++v) {
    if (turn[v] > 2 * std::numbers::pi + 1e-12) bends[v] = 1;
    if (bends[v] || corners[v] == 0) continue;
    // Walk around: a cone comes back to its first triangle after all its corners.
    int f = corner_of[v].face(), enter = corner_of[v].k(),
        n = 0;  // side `enter` starts or ends at v
    do {
      int k = 0;
      while (T.faces(f, k) != v) ++k;
      const int leave = enter == k ? (k + 2) % 3 : k;
      const auto at = sides.at(T.side_edge(f, leave));
      const TriangleSide next = at[0] == TriangleSide(f, leave) ? at[1] : at[0];
      f = next.face();
      enter = next.k();
    } while (++n < corners[v] && f != corner_of[v].face());
    if (n != corners[v] || f != corner_of[v].face()) bends[v] = 1;
  }
  return bends;
}

class SimpleFront {
 public:
  explicit SimpleFront(const IntrinsicTriangulation& T) : T_(T), sides_(edge_sides(T)) {
    bends_ = bending_vertices(T, sides_);
    d_ = VecX::Constant(T.n_vertices, infinite);
    const std::size_t n_sides = 3 * std::size_t(T.n_faces());
    apex_.resize(n_sides);
    winner_.assign(n_sides, {infinite, 0});
    corner_offsets_.assign(T.n_vertices + 1, 0);
    for (int f = 0; f < T.n_faces(); ++f)
      for (int k = 0; k < 3; ++k) {
        const double a = T.length(f, k), b = T.length(f, (k + 1) % 3), c = T.length(f, (k + 2) % 3);
        apex_[3 * f + k] = triangle_shape(a, b, c, false).p[2];
        ++corner_offsets_[T.faces(f, k) + 1];
      }
    for (int v = 0; v < T.n_vertices; ++v) corner_offsets_[v + 1] += corner_offsets_[v];
    corners_.resize(n_sides);
    std::vector<int> next(corner_offsets_.begin(), corner_offsets_.end() - 1);
    for (int f = 0; f < T.n_faces(); ++f)
      for (int k = 0; k < 3; ++k) corners_[next[T.faces(f, k)]++] = 3 * f + k;
  }

  void start_at(int vertex) {
    if (d_[vertex] == 0) return;
    d_[vertex] = 0;
    queue_.push({0, -1 - vertex});
  }

  /// Rays from a point in every direction inside one triangle that contains it.
  void start_in(const PointInFace& where) {
    const TriangleShape t = flat(where.face);
    const Complex p = point(t, where.b);
    for (int k = 0; k < 3; ++k) {
      offer(T_.faces(where.face, k), std::abs(t.p[k] - p));
      if (where.b[(k + 2) % 3] == 0) continue;
      SimpleWindow w;
      w.b1 = T_.length(where.face, k);
      w.image = p;
      cross_side(seen_from(w, t.p[k], t.side[k]), where.face, k);
    }
  }

  /// Rays perpendicular to a segment of one triangle, to both sides. Its ends are points.
  void start_along(const TriangleSources::Segment& s) {
    const TriangleShape t = flat(s.triangle);
    const Complex a = point(t, s.a), ab = point(t, s.b) - a;
    const double length = std::abs(ab);
    if (!(length > 0)) return;
    for (int k = 0; k < 3; ++k) {
      const double x =
          std::clamp((std::conj(ab) * (t.p[k] - a)).real() / (length * length), 0., 1.);
      offer(T_.faces(s.triangle, k), std::abs(t.p[k] - a - x * ab));
    }
    for (const double turn : {-1., 1.}) {
      const Complex n = Complex(0, turn) * ab / length;
      SimpleWindow w;
      w.parallel = true;
      w.image = n;
      w.d = -(std::conj(n) * a).real();
      for (int k = 0; k < 3; ++k) {
        const double L = T_.length(s.triangle, k);
        w.b0 = 0;
        w.b1 = L;
        // The stretch of the side beyond the segment: between its ends, and in front of it.
        auto clip = [&](Complex g, double c) {  // keeps x with Re(conj(g) (p_k + x side_k)) >= c
          const double v0 = (std::conj(g) * t.p[k]).real() - c;
          const double v1 = v0 + L * (std::conj(g) * t.side[k]).real();
          if (v0 < 0 && v1 < 0) w.b1 = w.b0;
          if (v0 < 0 && v1 >= 0) w.b0 = std::max(w.b0, L * v0 / (v0 - v1));
          if (v0 >= 0 && v1 < 0) w.b1 = std::min(w.b1, L * v0 / (v0 - v1));
        };
        const Complex g = ab / length;
        clip(g, (std::conj(g) * a).real());
        clip(-g, -(std::conj(g) * a).real() - length);
        clip(n, -w.d);
        if (w.b1 > w.b0 && s.a[(k + 2) % 3] + s.b[(k + 2) % 3] > 0)
          cross_side(seen_from(w, t.p[k], t.side[k]), s.triangle, k);
      }
    }
  }

  void run() {
    while (!queue_.empty()) {
      const auto [key, id] = queue_.top();
      queue_.pop();
      if (id < 0) {
        if (key <= d_[-1 - id]) leave_vertex(-1 - id);
        continue;
      }
      SimpleWindow w = pool_[id];
      free_.push_back(id);
      if (trim(w)) propagate(w);
    }
  }

  const VecX& distance() const { return d_; }
  double windows() const { return n_windows_; }

 private:
  struct Entry {
    double key;
    int id;  // of a window; -1 - vertex
    bool operator<(const Entry& other) const {
      return key > other.key || (key == other.key && id > other.id);
    }
  };
  struct Winner {
    double distance;  // least at the far corner among rays through a side
    double crossing;  // where they cross the side
  };

  TriangleShape flat(int f) const {
    return triangle_shape(T_.length(f, 0), T_.length(f, 1), T_.length(f, 2), false);
  }
  static Complex point(const TriangleShape& t, const std::array<double, 3>& b) {
    return b[0] * t.p[0] + b[1] * t.p[1] + b[2] * t.p[2];
  }

  void offer(int v, double distance) {
    if (!(distance < d_[v])) return;
    if (d_[v] == infinite) ++n_reached_;
    d_[v] = distance;
    if (bends_[v]) queue_.push({distance, -1 - v});
  }

  /// Paths that bend at a vertex: along its edges and into its triangles.
  void leave_vertex(int v) {
    for (int i = corner_offsets_[v]; i < corner_offsets_[v + 1]; ++i) {
      const int f = corners_[i] / 3, k = corners_[i] % 3, k1 = (k + 1) % 3, k2 = (k + 2) % 3;
      offer(T_.faces(f, k1), d_[v] + T_.length(f, k));
      offer(T_.faces(f, k2), d_[v] + T_.length(f, k2));
      SimpleWindow w;
      w.b1 = T_.length(f, k1);
      w.image = apex_[3 * f + k1];
      w.at_vertex = true;
      w.d = d_[v];
      cross_side(w, f, k1);
    }
  }

  /// Cuts off what the ends of the side reach sooner; false if nothing is left.
  bool trim(SimpleWindow& w) const {
    const int f = w.side / 3, k = w.side % 3;
    const double start = d_[T_.faces(f, k)], end = d_[T_.faces(f, (k + 1) % 3)];
    const double L = T_.length(f, k);
    if (start < infinite) w.trim_start(start, slack_share * (start + L));
    if (end < infinite && w.b1 > w.b0) w.trim_end(end, L, slack_share * (end + L));
    return w.b1 - w.b0 > slack_share * L;
  }

  /// Hands rays that leave triangle f through its side k to the triangles beyond.
  void cross_side(const SimpleWindow& w, int f, int k) {
    const double L = T_.length(f, k);
    for (const TriangleSide& s : sides_.at(T_.side_edge(f, k))) {
      if (s == TriangleSide(f, k)) continue;
      SimpleWindow v = from_other_side(w, L, T_.along(s.face(), s.k()) != T_.along(f, k));
      v.side = 3 * s.face() + s.k();
      if (!trim(v)) continue;
      ++n_windows_;
      int id = pool_.size();
      if (free_.empty()) {
        if (pool_.size() >= 200'000'000) throw std::length_error("2e8 open windows");
        pool_.push_back(v);
      } else {
        id = free_.back();
        free_.pop_back();
        pool_[id] = v;
      }
      queue_.push({v.least(), id});
    }
  }

  void propagate(const SimpleWindow& w) {
    const int f = w.side / 3, k = w.side % 3;
    const Complex p = apex_[w.side];
    const double L = T_.length(f, k), L1 = T_.length(f, (k + 1) % 3),
                 L2 = T_.length(f, (k + 2) % 3);
    const int v = T_.faces(f, (k + 2) % 3);
    const Complex g0 = w.direction(w.b0), g1 = w.direction(w.b1);
    bool left = cross(g0, p - w.b0)<0, right = cross(g1, p - w.b1)> 0;
    const double tolerance = coverage_share * L;
    if (cross(g0, p - (w.b0 - tolerance)) <= 0 && cross(g1, p - (w.b1 + tolerance)) >= 0) {
      const double distance = w.at(p);
      if (left && right) one_angle_one_split(w, p, distance, left, right);
      offer(v, distance);
    }
    // Beyond the line from an end of the window to the far corner, that corner may be nearer.
    const double slack = slack_share * (d_[v] + L);
    if (left && d_[v] + std::abs(p - w.b0) + slack < w.at(w.b0)) left = false;
    if (right && d_[v] + std::abs(p - w.b1) + slack < w.at(w.b1)) right = false;
    // Where a ray from b along g leaves, as a share of the way to the far corner.
    auto on_left = [&](double b, Complex g) {
      return std::clamp(-g.imag() * b / cross(g, p), 0.0, 1.0);
    };
    auto on_right = [&](double b, Complex g) {
      return std::clamp(g.imag() * (L - b) / cross(g, p - L), 0.0, 1.0);
    };
    if (right) {
      const Complex along = (p - L) / L1;
      SimpleWindow child = seen_from(w, L, along);
      child.b0 = L1 * on_right(w.b1, g1);
      child.b1 = cross(g0, p - w.b0) > 0 ? L1 * on_right(w.b0, g0) : L1;
      cross_side(child, f, (k + 1) % 3);
    }
    if (left) {
      const Complex along = -p / L2;
      SimpleWindow child = seen_from(w, p, along);
      child.b0 = cross(g1, p - w.b1) < 0 ? L2 * (1 - on_left(w.b1, g1)) : 0;
      child.b1 = L2 * (1 - on_left(w.b0, g0));
      cross_side(child, f, (k + 2) % 3);
    }
  }

  /// Of all rays through a side that reach the far corner only the nearest go on to both sides of
  /// it; others keep the side of the corner on which they cross the nearest ones (Chen and Han).
  void one_angle_one_split(const SimpleWindow& w, Complex p, double distance, bool& left,
                           bool& right) {
    if (w.parallel) return;
    const double crossing =
        w.image.real() - w.image.imag() * (p.real() - w.image.real()) / (p.imag() - w.image.imag());
    Winner& winner = winner_[w.side];
    if (distance < winner.distance) {
      // The proof wants no image within another fan of rays, as a source inside a face may be.
      if (w.at_vertex) winner = {distance, crossing};
    } else if (distance > winner.distance * (1 + slack_share)) {
      if (crossing < winner.crossing) right = false;
      if (crossing > winner.crossing) left = false;
    }
  }

  const IntrinsicTriangulation& T_;
  EdgeSides sides_;
  std::vector<char> bends_;
  VecX d_;                     // vertices; least distance found so far
  std::vector<Complex> apex_;  // sides; the far corner above the side
  std::vector<Winner> winner_;
  std::vector<int> corner_offsets_, corners_;  // vertex -> 3 triangle + corner
  std::vector<SimpleWindow> pool_;
  std::vector<int> free_;
  std::priority_queue<Entry> queue_;
  int n_reached_ = 0;
  double n_windows_ = 0;
};

}  // namespace littoral::test::simple

namespace littoral::test {

/// Distance at the vertices [T.unit] and the number of windows.
inline std::pair<VecX, double> simple_exact(const IntrinsicTriangulation& T,
                                            const TriangleSources& sources) {
  simple::SimpleFront front(T);
  for (const auto* points : {&sources.nodes, &sources.isolated}) {
    for (int v : points->vertices) front.start_at(v);
    for (const PointInFace& where : points->inside) front.start_in(where);
  }
  for (const TriangleSources::Segment& s : sources.segments) front.start_along(s);
  front.run();
  return {front.distance(), front.windows()};
}

}  // namespace littoral::test
