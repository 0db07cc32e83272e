#include "methods/geodesic/fast_marching.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <span>
#include <string>

#include "base/index.h"
#include "domain/mesh/edge_sides.h"
#include "methods/heat/finalize.h"

namespace littoral {

namespace {

double cross(Complex a, Complex b) { return a.real() * b.imag() - a.imag() * b.real(); }
double dot(Complex a, Complex b) { return a.real() * b.real() + a.imag() * b.imag(); }

/// A vertex v and the two ends a, b of the edge from which a front reaches it.
struct Stencil {
  int v, a, b;
  double aa, bb, ab;  // scalar products of v->a and v->b
  int unfolded;       // the end that is no neighbour of v, or -1
};

/// All stencils, found by the vertices a and b.
class Stencils {
 public:
  explicit Stencils(const IntrinsicTriangulation& T) : T_(T), sides_(edge_sides(T)) {
    all.reserve(3 * std::size_t(T.n_faces()));  // obtuse corners have two
    for (int f = 0; f < T.n_faces(); ++f)
      for (int k = 0; k < 3; ++k) add_corner(f, k);
    offsets_.assign(T.n_vertices + 1, 0);
    for (const Stencil& s : all) ++offsets_[s.a + 1], ++offsets_[s.b + 1];
    for (int v = 0; v < T.n_vertices; ++v) offsets_[v + 1] += offsets_[v];
    users_.resize(offsets_.back());
    std::vector<int> next(offsets_.begin(), offsets_.end() - 1);
    for (int i = 0; i < int_size(all); ++i) users_[next[all[i].a]++] = users_[next[all[i].b]++] = i;
  }
  std::span<const int> using_vertex(int v) const {
    return {users_.data() + offsets_[v], users_.data() + offsets_[v + 1]};
  }

  std::vector<Stencil> all;
  int n_unsplit = 0;  // obtuse corners where the mesh ends before a vertex in front is found

 private:
  void add_corner(int f, int k) {
    const int k1 = (k + 1) % 3, k2 = (k + 2) % 3, v = T_.faces(f, k);
    const TriangleShape t =
        triangle_shape(T_.length(f, k), T_.length(f, k1), T_.length(f, k2), false);
    const Complex A = t.p[1], B = t.p[2];  // v at 0
    const int a = T_.faces(f, k1), b = T_.faces(f, k2);
    if (t.cot[0] < 0) {
      const auto [d, D] = vertex_in_front(f, k1, A, B);
      if (d >= 0 && d != v) {
        add(v, a, A, d, D, d);
        add(v, d, D, b, B, d);
        return;
      }
      ++n_unsplit;
    }
    add(v, a, A, b, B, -1);
  }
  void add(int v, int a, Complex A, int b, Complex B, int unfolded) {
    all.push_back({v, a, b, std::norm(A), std::norm(B), dot(A, B), unfolded});
  }

  /// Unfolds the triangles beyond the side at A, B (counter-clockwise about 0, more than a right
  /// angle apart) until a corner lies at most a right angle from both: its vertex and position.
  std::pair<int, Complex> vertex_in_front(int f, int k, Complex A, Complex B) const {
    const Complex middle = Complex(0, 1) * A / std::abs(A) - Complex(0, 1) * B / std::abs(B);
    Complex P = A, Q = B;     // ends of the edge about to be crossed
    bool starts_at_P = true;  // does side k of f?
    for (int step = 0; step < 64; ++step) {
      const auto at = sides_.at(T_.side_edge(f, k));
      if (at.size() != 2) break;
      const TriangleSide next = at[0].face == f && at[0].k == k ? at[1] : at[0];
      if (T_.along(next.face, next.k) != T_.along(f, k)) starts_at_P = !starts_at_P;
      f = next.face;
      k = next.k;
      const int k1 = (k + 1) % 3, k2 = (k + 2) % 3;
      const Complex apex =
          triangle_shape(T_.length(f, k), T_.length(f, k1), T_.length(f, k2), false).p[2];
      const double along = starts_at_P ? apex.real() : T_.length(f, k) - apex.real();
      const Complex R = P + (Q - P) / std::abs(Q - P) * Complex(along, -apex.imag());
      if (dot(A, R) >= 0 && dot(B, R) >= 0) return {T_.faces(f, k2), R};
      // On through the edge that the ray midway between the two right angles crosses.
      const bool through_PR = cross(middle, R) > 0;
      (through_PR ? Q : P) = R;
      k = through_PR == starts_at_P ? k2 : k1;
      starts_at_P = !starts_at_P;
    }
    return {-1, 0};
  }

  const IntrinsicTriangulation& T_;
  EdgeSides sides_;
  std::vector<int> offsets_, users_;
};

/// Where a front moving at speed 1 in a straight line, that passed a at ta and b at tb, passes v;
/// inf if it does not come from between them.
double arrival(const Stencil& s, double ta, double tb) {
  // |grad| = 1: (p 1 - t)^T Q (p 1 - t) = 1 with Q the inverse of the Gram matrix.
  const double det = s.aa * s.bb - s.ab * s.ab;
  const double sum_a = s.bb - s.ab, sum_b = s.aa - s.ab;  // det Q 1
  const double a = sum_a + sum_b, half_b = sum_a * ta + sum_b * tb;
  const double c = s.bb * ta * ta - 2 * s.ab * ta * tb + s.aa * tb * tb - det;
  const double discriminant = half_b * half_b - a * c;
  if (!(discriminant >= 0) || !(a > 0)) return infinity;
  const double p = (half_b + std::sqrt(discriminant)) / a;
  const double qa = s.bb * (p - ta) - s.ab * (p - tb), qb = s.aa * (p - tb) - s.ab * (p - ta);
  return qa >= 0 && qb >= 0 ? p : infinity;
}

class MarchingFront {
 public:
  MarchingFront(const IntrinsicTriangulation& T, const TriangleSources& sources)
      : T_(T), stencils_(T), d_(VecX::Constant(T.n_vertices, infinity)) {
    sign_.assign(T.n_vertices, 0);
    beside_.assign(T.n_vertices, 0);
    fixed_.assign(T.n_vertices, 0);
    if (!sources.value.empty())
      least_ = *std::min_element(sources.value.begin(), sources.value.end());
    const auto value = [&](int source) { return sources.value_of(source) - least_; };
    const TriangleSources::Points& points = sources.isolated;
    for (std::size_t i = 0; i < points.vertices.size(); ++i)
      offer(points.vertices[i], value(points.vertex_source[i]), 0);
    for (std::size_t i = 0; i < points.inside.size(); ++i) {
      const PointInFace& where = points.inside[i];
      const TriangleShape t = T.shape(where.face);
      for (int k = 0; k < 3; ++k)
        offer(T.faces(where.face, k),
              value(points.inside_source[i]) + std::abs(t.p[k] - point(t, where.b)), 0);
    }
    for (const TriangleSources::Segment& s : sources.segments) add_segment(s, value(s.source));
    find_sides(sources);
  }

  void run(const Task& task) {
    int n_fixed = 0;
    while (!queue_.empty()) {
      const auto [key, v] = queue_.top();
      queue_.pop();
      if (fixed_[v] || key > d_[v]) continue;
      fixed_[v] = 1;
      if ((++n_fixed & 0xfff) == 0) task.checkpoint(double(n_fixed) / T_.n_vertices);
      for (int i : stencils_.using_vertex(v)) reach(stencils_.all[i], v);
    }
  }

  /// Signed; nodes on a curve and those that only unsigned sources reach are not negative.
  VecX distance() const {
    VecX phi = d_;
    for (Eigen::Index v = 0; v < phi.size(); ++v)
      if (sign_[v] < 0) phi[v] = -phi[v];
    return phi.array() + least_;
  }
  int n_unsplit() const { return stencils_.n_unsplit; }

 private:
  struct Entry {
    double key;
    int v;
    bool operator<(const Entry& other) const {
      return key > other.key || (key == other.key && v > other.v);
    }
  };

  static Complex point(const TriangleShape& t, const std::array<double, 3>& b) {
    return b[0] * t.p[0] + b[1] * t.p[1] + b[2] * t.p[2];
  }

  void offer(int v, double distance, int sign) {
    if (!(distance < d_[v])) return;
    d_[v] = distance;
    sign_[v] = static_cast<signed char>(sign != 0 ? sign : beside_[v]);
    queue_.push({distance, v});
  }

  /// Corners of a triangle that holds a straight piece of a curve: exact in the triangle's plane.
  void add_segment(const TriangleSources::Segment& s, double value) {
    const TriangleShape t = T_.shape(s.triangle);
    const Complex a = point(t, s.a), ab = point(t, s.b) - a;
    const double length2 = std::norm(ab);
    if (!(length2 > 0)) return;
    for (int k = 0; k < 3; ++k) {
      const Complex ap = t.p[k] - a;
      const double distance =
          value + std::abs(ap - std::clamp(dot(ab, ap) / length2, 0.0, 1.0) * ab);
      const double left = cross(ab, ap);
      const bool on_line = std::abs(left) <= 1e-12 * (length2 + std::norm(ap));
      offer(T_.faces(s.triangle, k), distance, !s.is_signed || on_line ? 0 : left > 0 ? 1 : -1);
    }
  }

  /// Around a vertex on a signed curve, triangles that hold no piece of it lie on one side: their
  /// corners take each other's sign.
  void find_sides(const TriangleSources& sources) {
    std::vector<char> holds(T_.n_faces(), 0), on_curve(T_.n_vertices, 0);
    for (const TriangleSources::Segment& s : sources.segments) {
      if (!s.is_signed) continue;
      holds[s.triangle] = 1;
      for (int k = 0; k < 3; ++k)
        if (d_[T_.faces(s.triangle, k)] == 0) on_curve[T_.faces(s.triangle, k)] = 1;
    }
    std::vector<std::vector<int>> near(T_.n_vertices);  // vertex -> triangles that touch the curve
    for (int f = 0; f < T_.n_faces(); ++f)
      if (!holds[f] &&
          (on_curve[T_.faces(f, 0)] || on_curve[T_.faces(f, 1)] || on_curve[T_.faces(f, 2)]))
        for (int k = 0; k < 3; ++k) near[T_.faces(f, k)].push_back(f);
    std::queue<int> todo;
    for (int v = 0; v < T_.n_vertices; ++v)
      if (sign_[v] != 0 && d_[v] > 0) {
        beside_[v] = sign_[v];
        todo.push(v);
      }
    while (!todo.empty()) {
      const int v = todo.front();
      todo.pop();
      for (int f : near[v])
        for (int k = 0; k < 3; ++k) {
          const int w = T_.faces(f, k);
          if (on_curve[w] || beside_[w] != 0) continue;
          beside_[w] = beside_[v];
          todo.push(w);
        }
    }
  }

  void reach(const Stencil& s, int fixed) {
    if (fixed_[s.v] || beside_[s.v] * sign_[fixed] < 0) return;  // never across the curve
    const int other = s.a == fixed ? s.b : s.a;
    const double edge = std::sqrt(s.a == fixed ? s.aa : s.bb);
    // A straight line over unfolded triangles may cross a curve beside its far end.
    if (fixed != s.unfolded || beside_[fixed] == 0 || beside_[s.v] != 0)
      offer(s.v, d_[fixed] + edge, sign_[fixed]);
    if (!fixed_[other] || sign_[fixed] * sign_[other] < 0 || beside_[s.v] * sign_[other] < 0)
      return;
    offer(s.v, arrival(s, d_[s.a], d_[s.b]), sign_[fixed] != 0 ? sign_[fixed] : sign_[other]);
  }

  const IntrinsicTriangulation& T_;
  Stencils stencils_;
  double least_ = 0;  // of the sources' values
  VecX d_;            // vertices, unsigned, without it
  std::vector<signed char> sign_;
  std::vector<signed char> beside_;  // side of the curve next to it, 0 elsewhere
  std::vector<char> fixed_;
  std::priority_queue<Entry> queue_;
};

}  // namespace

VecX fast_marching(const IntrinsicTriangulation& T, const TriangleSources& sources,
                   const Task& task, Report& report) {
  MarchingFront front(T, sources);
  front.run(task);
  report.sizes.emplace_back("obtuse_corners_left", front.n_unsplit());
  return finalize_field(T.component, T.n_components, T.unit, sources.reached, front.distance(),
                        report);
}

}  // namespace littoral
