#include "sources/surface/surface_points.h"

#include <algorithm>
#include <cmath>

#include "base/counted.h"
#include "littoral/error.h"

namespace littoral {

namespace {

constexpr double snap = 1e-12;

}  // namespace

std::string element_name(const SurfacePoint& p) {
  const char* kind = p.on == SurfacePoint::On::vertex ? "vertex "
                     : p.on == SurfacePoint::On::edge ? "edge "
                                                      : "face ";
  return kind + std::to_string(p.element);
}

void check_element(const SurfaceMesh& mesh, const SurfacePoint& p) {
  const bool vertex = p.on == SurfacePoint::On::vertex, edge = p.on == SurfacePoint::On::edge;
  const int n = vertex ? mesh.n_vertices() : edge ? mesh.n_edges() : mesh.n_faces();
  if (p.element < 0 || p.element >= n)
    throw InputError("a source lies on " + element_name(p) + ", but the mesh has " +
                         (vertex ? counted(n, "vertex", "vertices")
                          : edge ? counted(n, "edge", "edges")
                                 : counted(n, "face", "faces")) +
                         ", counted from 0",
                     "no-such-element");
  if (vertex && mesh.vertex_component()[p.element] < 0)
    throw InputError("a source lies on " + element_name(p) + ", which belongs to no face");
}

std::string barycentric_fault(const SurfacePoint& p) {
  if (p.on == SurfacePoint::On::vertex) return {};
  const int n = p.on == SurfacePoint::On::edge ? 2 : 3;
  double sum = 0;
  for (int k = 0; k < n; ++k) {
    if (!(p.b[k] >= -barycentric_slack && p.b[k] <= 1 + barycentric_slack))
      return "a point on " + element_name(p) + " has the barycentric coordinate " +
             std::to_string(p.b[k]) + ", outside [0, 1]";
    sum += p.b[k];
  }
  if (std::abs(sum - 1) <= barycentric_slack) return {};
  return "the barycentric coordinates of a point on " + element_name(p) + " sum to " +
         std::to_string(sum) + ", not 1";
}

void check_barycentrics(const SurfacePoint& p) {
  if (const std::string fault = barycentric_fault(p); !fault.empty()) throw InputError(fault);
}

SurfacePoint simplest(const SurfaceMesh& mesh, const SurfacePoint& p) {
  check_element(mesh, p);
  check_barycentrics(p);
  if (p.on == SurfacePoint::On::vertex) return SurfacePoint::at_vertex(p.element);
  const int n = p.on == SurfacePoint::On::edge ? 2 : 3;

  // Weight per distinct vertex: corners of a face may repeat.
  std::array<int, 3> vertex{};
  for (int k = 0; k < n; ++k)
    vertex[k] = n == 2 ? mesh.edges()(p.element, k) : mesh.face(p.element)[k];
  std::array<double, 3> weight{};
  for (int k = 0; k < n; ++k) {
    const int first = std::find(vertex.begin(), vertex.begin() + k, vertex[k]) - vertex.begin();
    weight[first] += std::max(0.0, p.b[k]);
  }
  const double total = weight[0] + weight[1] + weight[2];
  std::array<int, 3> used{};
  int n_used = 0;
  for (int k = 0; k < n; ++k)
    if (weight[k] > snap * total) used[n_used++] = k;
  if (n_used == 1) return SurfacePoint::at_vertex(vertex[used[0]]);
  if (n_used == 3)
    return SurfacePoint::in_face(p.element, weight[0] / total, weight[1] / total,
                                 weight[2] / total);
  int edge = p.element;
  if (n == 3) {
    for (int k = 0; k < 3; ++k) {
      const int a = vertex[k], b = vertex[(k + 1) % 3];
      const int u = vertex[used[0]], v = vertex[used[1]];
      if ((a == u && b == v) || (a == v && b == u)) edge = mesh.side_edge(p.element, k);
    }
  }
  const bool along = mesh.edges()(edge, 0) == vertex[used[0]];
  const double tail = weight[used[along ? 0 : 1]], head = weight[used[along ? 1 : 0]];
  return SurfacePoint::on_edge(edge, head / (tail + head));
}

std::vector<int> faces_at(const SurfaceMesh& mesh, const SurfacePoint& p) {
  if (p.on == SurfacePoint::On::face) return {p.element};
  const auto all =
      p.on == SurfacePoint::On::vertex ? mesh.vertex_faces(p.element) : mesh.edge_faces(p.element);
  std::vector<int> faces(all.begin(), all.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  return faces;
}

std::optional<std::array<double, 3>> barycentrics_in(const SurfaceMesh& mesh, const SurfacePoint& p,
                                                     int face) {
  const auto corners = mesh.face(face);
  if (corners.size() != 3) return std::nullopt;
  std::array<double, 3> b{};
  if (p.on == SurfacePoint::On::face) {
    if (p.element != face) return std::nullopt;
    return p.b;
  }
  for (int k = 0; k < 3; ++k) {
    if (p.on == SurfacePoint::On::vertex && corners[k] == p.element) {
      b[k] = 1;
      return b;
    }
    if (p.on == SurfacePoint::On::edge && mesh.side_edge(face, k) == p.element) {
      const bool along = mesh.side_along(face, k);
      b[k] = p.b[along ? 0 : 1];
      b[(k + 1) % 3] = p.b[along ? 1 : 0];
      return b;
    }
  }
  return std::nullopt;
}

bool share_face(const SurfaceMesh& mesh, const SurfacePoint& p, const SurfacePoint& q) {
  return common_face(mesh, p, q) >= 0;
}

int common_face(const SurfaceMesh& mesh, const SurfacePoint& p, const SurfacePoint& q) {
  const std::vector<int> of_p = faces_at(mesh, p), of_q = faces_at(mesh, q);
  int fallback = -1;
  for (std::size_t i = 0, j = 0; i < of_p.size() && j < of_q.size();) {
    if (of_p[i] < of_q[j]) {
      ++i;
    } else if (of_q[j] < of_p[i]) {
      ++j;
    } else {
      if (mesh.has_distinct_corners(of_p[i])) return of_p[i];
      if (fallback < 0) fallback = of_p[i];
      ++i, ++j;
    }
  }
  return fallback;
}

int common_edge(const SurfaceMesh& mesh, const SurfacePoint& p, const SurfacePoint& q) {
  const bool p_edge = p.on == SurfacePoint::On::edge, q_edge = q.on == SurfacePoint::On::edge;
  if (p.on == SurfacePoint::On::face || q.on == SurfacePoint::On::face) return -1;
  if (p_edge) return on_closed_edge(mesh, q, p.element) ? p.element : -1;
  if (q_edge) return on_closed_edge(mesh, p, q.element) ? q.element : -1;
  return p.element == q.element ? -1 : mesh.find_edge(p.element, q.element);
}

bool on_closed_edge(const SurfaceMesh& mesh, const SurfacePoint& p, int edge) {
  if (p.on == SurfacePoint::On::edge) return p.element == edge;
  return p.on == SurfacePoint::On::vertex &&
         (mesh.edges()(edge, 0) == p.element || mesh.edges()(edge, 1) == p.element);
}

}  // namespace littoral
