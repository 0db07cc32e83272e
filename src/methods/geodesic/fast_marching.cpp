#include "methods/geodesic/fast_marching.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <queue>
#include <string>
#include <tuple>
#include <utility>

#include "base/counted.h"
#include "base/falling_keys.h"
#include "base/fetch_ahead.h"
#include "base/index.h"
#include "methods/geodesic/marching_stencils.h"
#include "methods/heat/finalize.h"
#include "methods/heat/time_scale.h"

namespace littoral {

namespace {

constexpr double round_off = 1e-6;

/// 1: the segment has sides. 0: it has none, as it is unsigned, or others run back along it. -1: it
/// is one of these, of which there are fewer.
std::vector<signed char> sides_of(const std::vector<TriangleSources::Segment>& segments) {
  using Place = std::array<long long, 3>;
  const auto place = [](const std::array<double, 3>& b) {  // the same but for rounding
    Place out;
    for (int k = 0; k < 3; ++k) out[k] = std::llround(std::ldexp(b[k], 30));
    return out;
  };
  std::map<std::tuple<int, Place, Place>, int> runs;
  const auto forth = [&](const auto& s) { return std::tuple(s.triangle, place(s.a), place(s.b)); };
  const auto back = [&](const auto& s) { return std::tuple(s.triangle, place(s.b), place(s.a)); };
  for (const TriangleSources::Segment& s : segments)
    if (s.is_signed) ++runs[forth(s)];
  std::vector<signed char> out(segments.size(), 0);
  for (std::size_t i = 0; i < segments.size(); ++i) {
    if (!segments[i].is_signed) continue;
    const int excess = runs[forth(segments[i])] - runs[back(segments[i])];
    out[i] = static_cast<signed char>(std::clamp(excess, -1, 1));
  }
  return out;
}

/// Triangles that hold a piece of a curve with sides.
std::vector<char> triangles_with_sides(int n_triangles,
                                       const std::vector<TriangleSources::Segment>& segments,
                                       const std::vector<signed char>& sides) {
  std::vector<char> out(std::size_t(n_triangles), 0);
  for (std::size_t i = 0; i < segments.size(); ++i)
    if (sides[i] > 0) out[segments[i].triangle] = 1;
  return out;
}

/// Where a front moving at speed 1 in a straight line, that passed the ends of an edge at `last`
/// and `other`, passes the vertex; inf if it does not come from between them.
double arrival(const Products& s, double last, double other) {
  // |grad| = 1: (p 1 - t)^T Q (p 1 - t) = 1 with Q the inverse of the Gram matrix.
  const double det = s.last * s.other - s.both * s.both;
  const double sum_a = s.other - s.both, sum_b = s.last - s.both;  // det Q 1
  const double a = sum_a + sum_b, half_b = sum_a * last + sum_b * other;
  const double c = s.other * last * last - 2 * s.both * last * other + s.last * other * other - det;
  const double discriminant = half_b * half_b - a * c;
  if (!(discriminant >= 0) || !(a > 0)) return infinity;
  const double p = (half_b + std::sqrt(discriminant)) / a;
  const double qa = s.other * (p - last) - s.both * (p - other),
               qb = s.last * (p - other) - s.both * (p - last);
  return qa >= 0 && qb >= 0 ? p : infinity;
}

class MarchingFront {
 public:
  MarchingFront(const IntrinsicTriangulation& T, const TriangleSources& sources, const Task& task)
      : T_(T),
        sides_(sides_of(sources.segments)),
        with_sides_(triangles_with_sides(T.n_faces(), sources.segments, sides_)),
        stencils_(T, with_sides_, task),
        d_(VecX::Constant(T.n_vertices, infinity)),
        queue_(T.n_vertices) {
    sign_.assign(T.n_vertices, 0);
    beside_.assign(T.n_vertices, 0);
    on_curve_.assign(T.n_vertices, 0);
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
              value(points.inside_source[i]) + std::abs(t.p[k] - t.at(where.b)), 0);
    }
    for (std::size_t i = 0; i < sides_.size(); ++i)
      if (sides_[i] >= 0)
        add_segment(sources.segments[i], sides_[i] > 0, value(sources.segments[i].source));
    find_sides();
  }

  void run(const Task& task) {
    march(task);
    // What only curves' own vertices reach, with no telling on which side, has its distance too.
    any_side_ = true;
    const std::vector<char> before = fixed_;
    for (int v = 0; v < T_.n_vertices; ++v)
      if (fixed_[v] && on_curve_[v]) reach_from(v);
    march(task);
    for (int v = 0; v < T_.n_vertices; ++v)
      if (fixed_[v] && !before[v] && sign_[v] == 0) ++n_without_side_;
  }

  /// Signed; nodes on a curve and those that only unsigned sources reach are not negative.
  VecX distance() const {
    VecX phi = d_;
    for (Eigen::Index v = 0; v < phi.size(); ++v)
      if (sign_[v] < 0) phi[v] = -phi[v];
    return phi.array() + least_;
  }
  int n_unsplit() const { return stencils_.n_unsplit; }
  int n_without_side() const { return n_without_side_; }

  /// Edges between vertices of different sign that are together farther from the sources than from
  /// each other: no curve crosses them.
  int n_sign_jumps() const {
    std::vector<char> jumps(T_.n_edges(), 0);
    for (int f = 0; f < T_.n_faces(); ++f)
      for (int k = 0; k < 3; ++k) {
        const int v = T_.faces(f, k), w = T_.faces(f, (k + 1) % 3);
        if (sign_[v] * sign_[w] < 0 && d_[v] + d_[w] > (1 + round_off) * T_.length(f, k))
          jumps[T_.side_edge(f, k)] = 1;
      }
    return static_cast<int>(std::count(jumps.begin(), jumps.end(), 1));
  }

 private:
  void march(const Task& task) {
    while (!queue_.empty()) {
      const int v = queue_.take();
      fixed_[v] = 1;
      if ((++n_fixed_ & 0xfff) == 0) task.checkpoint(double(n_fixed_) / T_.n_vertices);
      reach_from(v);
    }
  }
  void reach_from(int v) {
    for (const int c : stencils_.corners_at(v)) {
      fetch_ahead(T_.faces.row(c / 3).data());
      fetch_ahead(T_.length.row(c / 3).data());
    }
    for (const int c : stencils_.corners_at(v)) cross_triangle(c / 3, c % 3);
    stencils_.for_unfolded_at(v, [&](const UnfoldedStencil& s) { reach_unfolded(s, v); });
  }

  void offer(int v, double distance, int sign) {
    if (!(distance < d_[v])) return;
    d_[v] = distance;
    sign_[v] = static_cast<signed char>(sign != 0 ? sign : beside_[v]);
    queue_.put(v, distance);
  }

  /// Corners of a triangle that holds a straight piece of a curve: exact in the triangle's plane.
  void add_segment(const TriangleSources::Segment& s, bool sided, double value) {
    const TriangleShape t = T_.shape(s.triangle);
    const Complex a = t.at(s.a), ab = t.at(s.b) - a;
    const double length2 = std::norm(ab);
    if (!(length2 > 0)) return;
    for (int k = 0; k < 3; ++k) {
      const Complex ap = t.p[k] - a;
      const double distance =
          value + std::abs(ap - std::clamp(plane::dot(ab, ap) / length2, 0.0, 1.0) * ab);
      const double left = plane::cross(ab, ap);
      const bool on_line = std::abs(left) <= 1e-12 * (length2 + std::norm(ap));
      offer(T_.faces(s.triangle, k), distance, !sided || on_line ? 0 : left > 0 ? 1 : -1);
    }
  }

  /// Around a vertex on a signed curve, triangles that hold no piece of it lie on one side: their
  /// corners take each other's sign.
  void find_sides() {
    if (std::none_of(sides_.begin(), sides_.end(), [](signed char side) { return side > 0; }))
      return;
    for (int f = 0; f < T_.n_faces(); ++f)
      for (int k = 0; with_sides_[f] && k < 3; ++k)
        if (d_[T_.faces(f, k)] == 0) on_curve_[T_.faces(f, k)] = 1;
    std::vector<std::vector<int>> near(T_.n_vertices);  // vertex -> triangles that touch the curve
    for (int f = 0; f < T_.n_faces(); ++f)
      if (!with_sides_[f] &&
          (on_curve_[T_.faces(f, 0)] || on_curve_[T_.faces(f, 1)] || on_curve_[T_.faces(f, 2)]))
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
          if (on_curve_[w] || beside_[w] != 0) continue;
          beside_[w] = beside_[v];
          todo.push(w);
        }
    }
  }

  /// Reaches the two others from corner k of f, which has been fixed.
  void cross_triangle(int f, int k) {
    const int k1 = (k + 1) % 3, k2 = (k + 2) % 3;
    const int v = T_.faces(f, k), v1 = T_.faces(f, k1), v2 = T_.faces(f, k2);
    const double to_1 = T_.length(f, k), between = T_.length(f, k1), to_2 = T_.length(f, k2);
    if (!fixed_[v1] && !stencils_.unfolds(f, k1))
      reach(v1, v, v2, to_1, false, [&] { return of_corner(to_1, between, to_2); });
    if (!fixed_[v2] && !stencils_.unfolds(f, k2))
      reach(v2, v, v1, to_2, false, [&] { return of_corner(to_2, between, to_1); });
  }

  void reach_unfolded(const UnfoldedStencil& s, int fixed) {
    if (fixed_[s.v]) return;
    const bool in_front = fixed == s.in_front;
    const double last = in_front ? s.to_in_front : s.to_side_end,
                 other = in_front ? s.to_side_end : s.to_in_front;
    reach(s.v, fixed, in_front ? s.side_end : s.in_front, std::sqrt(last), in_front, [&] {
      return Products{last, other, s.both};
    });
  }

  /// Vertex v from the one that was fixed last, `edge` away, and the other end of the stencil.
  template <class MakeProducts>
  void reach(int v, int last, int other, double edge, bool in_front, const MakeProducts& products) {
    if (beside_[v] * sign_[last] < 0) return;  // never across the curve
    // A straight line over unfolded triangles may cross a curve beside its far end; from a vertex
    // on a curve it leaves on the side where the other end is.
    const int side = sign_[last] != 0 ? sign_[last] : on_curve_[last] ? beside_[other] : 0;
    const bool known = any_side_ || !on_curve_[last] || side != 0 || beside_[v] != 0;
    if (known && (!in_front || beside_[last] == 0 || beside_[v] != 0))
      offer(v, d_[last] + edge, side);
    if (!fixed_[other] || sign_[last] * sign_[other] < 0 || beside_[v] * sign_[other] < 0) return;
    if (!any_side_ && on_curve_[last] && on_curve_[other] && beside_[v] == 0) return;
    offer(v, arrival(products(), d_[last], d_[other]),
          sign_[last] != 0 ? sign_[last] : sign_[other]);
  }

  const IntrinsicTriangulation& T_;
  std::vector<signed char> sides_;  // segments
  std::vector<char> with_sides_;    // triangles
  Stencils stencils_;
  double least_ = 0;  // of the sources' values
  VecX d_;            // vertices, unsigned, without it
  std::vector<signed char> sign_;
  std::vector<signed char> beside_;  // side of the curve next to it, 0 elsewhere
  std::vector<char> on_curve_;       // of those that are signed
  std::vector<char> fixed_;
  int n_fixed_ = 0;
  int n_without_side_ = 0;  // vertices of which it cannot be told on which side of curves they are
  bool any_side_ = false;   // also where a curve's side cannot be told
  FallingKeys queue_;
};

}  // namespace

VecX fast_marching(const IntrinsicTriangulation& T, const TriangleSources& sources,
                   const Task& task, Report& report) {
  MarchingFront front(T, sources, task);
  front.run(task);
  report.sizes.emplace_back("obtuse_corners_left", front.n_unsplit());
  const int jumps = front.n_sign_jumps();
  report.sizes.emplace_back("edges_where_the_sign_jumps", jumps);
  if (jumps > 0)
    report.warn("sign-uncertain",
                "the sign jumps at " + counted(jumps, "edge", "edges") +
                    " that no curve crosses: curves have gaps or ends inside, or contradict each "
                    "other. Method auto closes gaps");
  if (const int n = front.n_without_side(); n > 0)
    report.warn("sign-uncertain",
                "it cannot be told on which side of the curve " +
                    counted(n, "vertex is", "vertices are") +
                    ": only its own vertices lead there. The distance is positive");
  return finalize_field(T.component, T.n_components, T.unit, sources.reached, front.distance(),
                        report);
}

double off_unit_share(const IntrinsicTriangulation& T, const VecX& d) {
  double off = 0, all = 0;
  for (int f = 0; f < T.n_faces(); ++f) {
    const double d0 = d[T.faces(f, 0)], d1 = d[T.faces(f, 1)], d2 = d[T.faces(f, 2)];
    if (!std::isfinite(d0 + d1 + d2)) continue;
    if (std::min({d0, d1, d2}) < 0 && std::max({d0, d1, d2}) > 0) continue;
    const TriangleShape t = triangle_shape(T.length(f, 0), T.length(f, 1), T.length(f, 2), false);
    const double x = (d1 - d0) / t.p[1].real();
    const double y = (d2 - d0 - x * t.p[2].real()) / t.p[2].imag();
    all += t.area;
    if (!(std::abs(std::hypot(x, y) / T.unit - 1) <= off_unit_by)) off += t.area;
  }
  return all > 0 ? off / all : 0;
}

}  // namespace littoral
