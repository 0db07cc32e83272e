#include "methods/geodesic/exact_polyhedral_starts.h"

#include <algorithm>

namespace littoral {

namespace {

Complex place_in(const TriangleShape& t, const std::array<double, 3>& b) {
  return b[0] * t.p[0] + b[1] * t.p[1] + b[2] * t.p[2];
}

TriangleShape flat_triangle(const IntrinsicTriangulation& T, int f) {
  return triangle_shape(T.length(f, 0), T.length(f, 1), T.length(f, 2), false);
}

}  // namespace

std::vector<PolyhedralStart> starts_of(const TriangleSources& sources, double& least) {
  least = sources.value.empty() ? 0 : *std::min_element(sources.value.begin(), sources.value.end());
  const auto value = [&](int source) { return sources.value_of(source) - least; };
  std::vector<PolyhedralStart> starts;
  for (const auto* points : {&sources.nodes, &sources.isolated}) {
    for (std::size_t i = 0; i < points->vertices.size(); ++i) {
      const int source = points->vertex_source[i];
      starts.push_back({value(source), source, points->vertices[i], nullptr, nullptr});
    }
    for (std::size_t i = 0; i < points->inside.size(); ++i) {
      const int source = points->inside_source[i];
      starts.push_back({value(source), source, -1, &points->inside[i], nullptr});
    }
  }
  for (const TriangleSources::Segment& s : sources.segments)
    starts.push_back({value(s.source), s.source, -1, nullptr, &s});
  std::stable_sort(starts.begin(), starts.end(),
                   [](const auto& a, const auto& b) { return a.value < b.value; });
  return starts;
}

TriangleRays rays_of_point(const IntrinsicTriangulation& T, const PointInFace& where) {
  const TriangleShape t = flat_triangle(T, where.face);
  const Complex p = place_in(t, where.b);
  TriangleRays rays;
  for (int k = 0; k < 3; ++k) {
    rays.corners[k] = std::abs(t.p[k] - p);
    if (where.b[(k + 2) % 3] == 0) continue;
    Window w;
    w.b1 = T.length(where.face, k);
    rays.leaving.push_back({3 * where.face + k, seen_from(w, p, t.p[k], t.side[k])});
  }
  return rays;
}

TriangleRays rays_of_segment(const IntrinsicTriangulation& T, const TriangleSources::Segment& s) {
  const TriangleShape t = flat_triangle(T, s.triangle);
  const Complex a = place_in(t, s.a), ab = place_in(t, s.b) - a;
  const double length = std::abs(ab);
  TriangleRays rays;
  for (int k = 0; k < 3; ++k) {
    const double x =
        length > 0 ? std::clamp((std::conj(ab) * (t.p[k] - a)).real() / (length * length), 0., 1.)
                   : 0;
    rays.corners[k] = std::abs(t.p[k] - a - x * ab);
  }
  if (!(length > 0)) return rays;
  for (const double turn : {-1., 1.}) {
    const Complex n = Complex(0, turn) * ab / length, g = ab / length;
    Window w;
    w.parallel = true;
    w.behind = -(std::conj(n) * a).real();
    for (int k = 0; k < 3; ++k) {
      const double L = T.length(s.triangle, k);
      w.b0 = 0;
      w.b1 = L;
      // The stretch of the side beyond the segment: between its ends, and in front of it.
      const auto clip = [&](Complex h,
                            double c) {  // keeps x with Re(conj(h) (p_k + x side_k)) >= c
        const double v0 = (std::conj(h) * t.p[k]).real() - c;
        const double v1 = v0 + L * (std::conj(h) * t.side[k]).real();
        if (v0 < 0 && v1 < 0) w.b1 = w.b0;
        if (v0 < 0 && v1 >= 0) w.b0 = std::max(w.b0, L * v0 / (v0 - v1));
        if (v0 >= 0 && v1 < 0) w.b1 = std::min(w.b1, L * v0 / (v0 - v1));
      };
      clip(g, (std::conj(g) * a).real());
      clip(-g, -(std::conj(g) * a).real() - length);
      clip(n, -w.behind);
      if (w.b1 > w.b0 && s.a[(k + 2) % 3] + s.b[(k + 2) % 3] > 0)
        rays.leaving.push_back({3 * s.triangle + k, seen_from(w, n, t.p[k], t.side[k])});
    }
  }
  return rays;
}

}  // namespace littoral
