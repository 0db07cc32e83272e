#include "domain/intrinsic/intrinsic_mesh_editor.h"

#include <algorithm>
#include <cmath>

#include "base/fetch_ahead.h"
#include "base/index.h"

namespace littoral {

namespace {

bool is_collinear(double a, double b, double c) {
  const double longest = std::max({a, b, c});
  return !(a + b + c - 2 * longest > collinear_margin * longest);
}

/// Barycentric coordinates, forced into the triangle.
std::array<double, 3> barycentrics(Complex x, const std::array<Complex, 3>& p) {
  std::array<double, 3> b;
  double sum = 0;
  for (int k = 0; k < 3; ++k) {
    b[k] = std::max(0.0, plane::cross(p[(k + 2) % 3] - p[(k + 1) % 3], x - p[(k + 1) % 3]));
    sum += b[k];
  }
  for (double& v : b) v /= sum;
  return b;
}

}  // namespace

int IntrinsicMeshEditor::side_of(int f, int e) const {
  const auto& list = faces[f].e;
  return std::find(list.begin(), list.end(), e) - list.begin();
}

void IntrinsicMeshEditor::add_segment(CurveNetwork::Segment segment) {
  (segment.edge >= 0 ? on_edge_[segment.edge] : in_face_[segment.face]).push_back(segment);
}

TriangleShape IntrinsicMeshEditor::shape(int f) const {
  const auto& e = faces[f].e;
  return triangle_shape(edges[e[0]].length, edges[e[1]].length, edges[e[2]].length, false);
}

int IntrinsicMeshEditor::longest_edge(int f) const {
  int best = faces[f].e[0];
  for (int e : faces[f].e)
    if (edges[e].length > edges[best].length || (edges[e].length == edges[best].length && e > best))
      best = e;
  return best;
}

double IntrinsicMeshEditor::delaunay_sum(int e) const {
  const Edge& edge = edges[e];
  if (edge.faces.empty()) return infinity;
  double sum = 0;
  for (const int f : edge.faces) {
    std::array<double, 2> others{};
    int n = 0;
    for (const int s : faces[f].e)
      if (s != e && n < 2) others[n++] = edges[s].length;
    sum += cotangent_across(others[0], others[1], edge.length);
  }
  return sum;
}

void IntrinsicMeshEditor::fetch(int e, int step) const {
  if (step == 0) {
    fetch_ahead(&edges[e]);
  } else if (step == 1) {
    for (const int f : edges[e].faces) fetch_ahead(&faces[f]);
  } else {
    for (const int f : edges[e].faces)
      for (const int s : faces[f].e) fetch_ahead(&edges[s].length);
  }
}

Complex IntrinsicMeshEditor::position(const SurfacePoint& p,
                                      const std::vector<std::pair<int, Corners>>& layout) const {
  for (const auto& [f, at] : layout) {
    const Face& face = faces[f];
    for (int k = 0; k < 3; ++k) {
      if (p.on == SurfacePoint::On::vertex && face.v[k] == p.element) return at[k];
      if (p.on == SurfacePoint::On::edge && face.e[k] == p.element) {
        const bool along = edges[p.element].tail == face.v[k];
        return p.b[along ? 0 : 1] * at[k] + p.b[along ? 1 : 0] * at[(k + 1) % 3];
      }
    }
    if (p.on == SurfacePoint::On::face && p.element == f)
      return p.b[0] * at[0] + p.b[1] * at[1] + p.b[2] * at[2];
  }
  return 0;
}

IntrinsicMeshEditor::Drawing IntrinsicMeshEditor::lift(
    const std::vector<std::pair<int, Corners>>& layout, int edge) {
  Drawing drawing;
  if (nodes_.empty()) return drawing;
  auto take_nodes = [&](std::vector<int>& list) {
    for (int i : list) drawing.inside.emplace_back(i, position(nodes_[i], layout));
    list.clear();
  };
  auto take_segments = [&](std::vector<CurveNetwork::Segment>& list) {
    for (const auto& s : list)
      drawing.strokes.push_back({s, position(nodes_[s.a], layout), position(nodes_[s.b], layout)});
    list.clear();
  };
  for (const auto& [f, at] : layout) {
    take_nodes(nodes_in_face_[f]);
    take_segments(in_face_[f]);
  }
  if (edge >= 0) {
    take_nodes(nodes_on_edge_[edge]);
    take_segments(on_edge_[edge]);
  }
  return drawing;
}

void IntrinsicMeshEditor::place(const Drawing& drawing, int edge, int left, const Corners& at_left,
                                int right, const Corners& at_right) {
  if (nodes_.empty()) return;
  const int tail = std::find(faces[left].v.begin(), faces[left].v.end(), edges[edge].tail) -
                   faces[left].v.begin();
  const Complex P = at_left[tail], Q = at_left[(tail + 1) % 3], PQ = Q - P;
  auto side = [&](Complex x) {
    const double s = plane::cross(PQ, x - P) / std::norm(PQ);
    return std::abs(s) <= 1e-13 ? 0.0 : s;
  };
  auto on_edge = [&](Complex x) {
    return SurfacePoint::on_edge(
        edge, std::clamp((std::conj(PQ) * (x - P)).real() / std::norm(PQ), 0.0, 1.0));
  };
  for (const auto& [i, x] : drawing.inside) {
    const double s = side(x);
    if (s == 0) {
      nodes_[i] = on_edge(x);
      nodes_on_edge_[edge].push_back(i);
    } else {
      const int f = s > 0 ? left : right;
      const auto b = barycentrics(x, s > 0 ? at_left : at_right);
      nodes_[i] = SurfacePoint::in_face(f, b[0], b[1], b[2]);
      nodes_in_face_[f].push_back(i);
    }
  }
  // An end belongs to the side whose triangle holds it, however close to the line it is.
  auto side_of_end = [&](int i, Complex x) {
    const SurfacePoint& p = nodes_[i];
    auto holds = [&](int f) {
      const auto& list = p.on == SurfacePoint::On::vertex ? faces[f].v : faces[f].e;
      return p.on == SurfacePoint::On::face
                 ? p.element == f
                 : std::find(list.begin(), list.end(), p.element) != list.end();
    };
    const bool l = holds(left), r = holds(right);
    const double s = std::max(std::abs(plane::cross(PQ, x - P)) / std::norm(PQ), 1e-300);
    return l == r ? 0.0 : l ? s : -s;
  };
  for (const auto& [segment, a, b] : drawing.strokes) {
    const double sa = side_of_end(segment.a, a), sb = side_of_end(segment.b, b);
    CurveNetwork::Segment first = segment;
    first.edge = first.face = -1;
    if (sa == 0 && sb == 0) {
      first.edge = edge;
    } else if (sa * sb >= 0) {
      first.face = sa + sb > 0 ? left : right;
    } else {
      const double t = sa / (sa - sb);
      CurveNetwork::Segment second = first;
      first.b = second.a = nodes_.size();
      first.to = second.from = segment.from + t * (segment.to - segment.from);
      nodes_.push_back(on_edge(a + t * (b - a)));
      nodes_on_edge_[edge].push_back(first.b);
      first.face = sa > 0 ? left : right;
      second.face = sa > 0 ? right : left;
      add_segment(second);
    }
    add_segment(first);
  }
}

bool IntrinsicMeshEditor::fixed(int e) const {
  if (e < int_size(keep) && keep[e]) return true;
  if (edges[e].faces.size() != 2) return true;
  const int f = edges[e].faces[0], g = edges[e].faces[1];
  const int i = side_of(f, e), j = side_of(g, e);
  return f == g || faces[f].v[i] != faces[g].v[(j + 1) % 3] ||
         faces[f].side_sign[i] == faces[g].side_sign[j];
}

bool IntrinsicMeshEditor::flip(int e) {
  if (fixed(e)) return false;
  const int f = edges[e].faces[0], g = edges[e].faces[1];
  const int i = side_of(f, e), j = side_of(g, e);
  const Face F = faces[f], G = faces[g];
  const int a = F.v[i], b = F.v[(i + 1) % 3], c = F.v[(i + 2) % 3], d = G.v[(j + 2) % 3];
  if (c == d) return false;
  // The two triangles in the plane: a at 0, b on the real axis, c above, d below.
  const double ab = edges[e].length, bc = edges[F.e[(i + 1) % 3]].length,
               ca = edges[F.e[(i + 2) % 3]].length, ad = edges[G.e[(j + 1) % 3]].length,
               db = edges[G.e[(j + 2) % 3]].length;
  const Complex A = 0, B = ab, C = triangle_shape(ab, bc, ca, false).p[2],
                D = triangle_shape(ab, db, ad, true).p[2];
  const double cd = std::abs(C - D);
  if (!(plane::cross(C - D, A - D) > 0) || !(plane::cross(C - D, B - D) < 0)) return false;
  if (is_collinear(ca, ad, cd) || is_collinear(db, bc, cd)) return false;

  Corners at_f, at_g;
  at_f[i] = A, at_f[(i + 1) % 3] = B, at_f[(i + 2) % 3] = C;
  at_g[j] = B, at_g[(j + 1) % 3] = A, at_g[(j + 2) % 3] = D;
  const Drawing drawing = nodes_.empty() ? Drawing{} : lift({{f, at_f}, {g, at_g}}, e);
  auto move = [&](int edge, int from, int to) {
    std::replace(edges[edge].faces.begin(), edges[edge].faces.end(), from, to);
  };
  move(G.e[(j + 1) % 3], g, f);
  move(F.e[(i + 1) % 3], f, g);
  faces[f] = {{c, a, d},
              {F.e[(i + 2) % 3], G.e[(j + 1) % 3], e},
              {F.side_sign[(i + 2) % 3], G.side_sign[(j + 1) % 3], 1}};
  faces[g] = {{d, b, c},
              {G.e[(j + 2) % 3], F.e[(i + 1) % 3], e},
              {G.side_sign[(j + 2) % 3], F.side_sign[(i + 1) % 3], -1}};
  edges[e].tail = d;
  edges[e].head = c;
  edges[e].length = cd;
  place(drawing, e, f, {C, A, D}, g, {D, B, C});
  return true;
}

bool IntrinsicMeshEditor::split(int e) {
  for (const int f : edges[e].faces) {  // a needle's long side: its halves would be collinear
    const int i = side_of(f, e);
    const TriangleShape t = shape(f);
    const double half = 0.5 * edges[e].length,
                 median = std::abs(t.p[(i + 2) % 3] - 0.5 * (t.p[i] + t.p[(i + 1) % 3]));
    if (is_collinear(half, median, edges[faces[f].e[(i + 1) % 3]].length) ||
        is_collinear(half, median, edges[faces[f].e[(i + 2) % 3]].length))
      return false;
  }
  const int tail = edges[e].tail, head = edges[e].head, m = n_vertices();
  points_.push_back(0.5 * points_[tail] + 0.5 * points_[head]);
  const FacesOfEdge around = edges[e].faces;
  const bool drawn = !nodes_.empty();
  struct Cut {
    int face, side, right, edge;
    Corners at;
    Drawing drawing;
  };
  std::vector<Cut> cuts;
  for (int f : around) {
    const TriangleShape t = shape(f);
    cuts.push_back({f, side_of(f, e), 0, 0, t.p, lift({{f, t.p}}, -1)});
  }
  // The edge itself and what lies on it.
  const int e2 = edges.size();
  edges[e].length /= 2;
  edges[e].head = m;
  edges.push_back({m, head, edges[e].length, {}});
  std::vector<int> on;
  std::vector<CurveNetwork::Segment> segments;
  if (drawn) {
    nodes_on_edge_.emplace_back();
    on_edge_.emplace_back();
    on.swap(nodes_on_edge_[e]);
    segments.swap(on_edge_[e]);
  }
  auto along = [&](int i) {
    const SurfacePoint& p = nodes_[i];
    if (p.on == SurfacePoint::On::vertex) return p.element == tail ? 0.0 : 1.0;
    return p.b[1];
  };
  std::vector<std::array<double, 2>> ends;
  for (const auto& s : segments) ends.push_back({along(s.a), along(s.b)});
  for (int i : on) {
    const double t = along(i);
    if (t == 0.5) {
      nodes_[i] = SurfacePoint::at_vertex(m);
    } else {
      nodes_[i] = t < 0.5 ? SurfacePoint::on_edge(e, 2 * t) : SurfacePoint::on_edge(e2, 2 * t - 1);
      nodes_on_edge_[t < 0.5 ? e : e2].push_back(i);
    }
  }
  for (std::size_t k = 0; k < segments.size(); ++k) {
    CurveNetwork::Segment s = segments[k];
    const auto [ta, tb] = ends[k];
    if ((ta - 0.5) * (tb - 0.5) < 0) {
      const double t = (0.5 - ta) / (tb - ta);
      CurveNetwork::Segment second = s;
      s.b = second.a = nodes_.size();
      nodes_.push_back(SurfacePoint::at_vertex(m));
      s.to = second.from = s.from + t * (second.to - s.from);
      second.edge = tb < 0.5 ? e : e2;
      add_segment(second);
      s.edge = ta < 0.5 ? e : e2;
    } else {
      s.edge = ta + tb < 1 ? e : e2;
    }
    add_segment(s);
  }
  // Each face falls into the part at its side's start and the part at its end.
  edges[e].faces.clear();
  for (Cut& cut : cuts) {
    const int f = cut.face, i = cut.side;
    const Face F = faces[f];
    const int a = F.v[i], b = F.v[(i + 1) % 3], c = F.v[(i + 2) % 3];
    const int at_a = a == tail ? e : e2, at_b = a == tail ? e2 : e;
    cut.right = faces.size();
    cut.edge = edges.size();
    const Complex A = cut.at[i], B = cut.at[(i + 1) % 3], C = cut.at[(i + 2) % 3],
                  M = 0.5 * (A + B);
    edges.push_back({m, c, std::abs(C - M), {f, cut.right}});
    if (drawn) {
      nodes_on_edge_.emplace_back();
      on_edge_.emplace_back();
      nodes_in_face_.emplace_back();
      in_face_.emplace_back();
    }
    faces[f] = {{a, m, c},
                {at_a, cut.edge, F.e[(i + 2) % 3]},
                {F.side_sign[i], 1, F.side_sign[(i + 2) % 3]}};
    faces.push_back({{m, b, c},
                     {at_b, F.e[(i + 1) % 3], cut.edge},
                     {F.side_sign[i], F.side_sign[(i + 1) % 3], -1}});
    auto& beside = edges[F.e[(i + 1) % 3]].faces;
    std::replace(beside.begin(), beside.end(), f, cut.right);
    edges[at_a].faces.push_back(f);
    edges[at_b].faces.push_back(cut.right);
    place(cut.drawing, cut.edge, f, {A, M, C}, cut.right, {M, B, C});
  }
  return true;
}

}  // namespace littoral
