#include "api/surface/mesh_info.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "base/disjoint_sets.h"
#include "base/index.h"
#include "base/option_table.h"
#include "domain/mesh/face_orientation.h"
#include "sources/surface/pieces.h"
#include "spatial/self_intersections.h"
#include "spatial/triangulate.h"

namespace littoral {

namespace {

bool has_finite_corners(const PolygonSoup& soup, int f) {
  for (int v : soup.face(f))
    if (!soup.points.row(v).allFinite()) return false;
  return soup.face(f).size() >= 3;
}

/// The same points with the faces that a mesh can have.
PolygonSoup valid_faces(const PolygonSoup& soup) {
  PolygonSoup out;
  out.points = soup.points;
  for (int f = 0; f < soup.n_faces(); ++f)
    if (has_finite_corners(soup, f)) out.add_face(soup.face(f));
  return out;
}

int count_boundary_loops(const SurfaceMesh& mesh, int& n_edges) {
  DisjointSets sets(mesh.n_vertices());
  std::vector<char> on(std::size_t(mesh.n_vertices()), 0);
  n_edges = 0;
  for (int e = 0; e < mesh.n_edges(); ++e) {
    if (mesh.edge_faces(e).size() != 1) continue;
    ++n_edges;
    for (int k : {0, 1}) on[mesh.edges()(e, k)] = 1;
    sets.join(mesh.edges()(e, 0), mesh.edges()(e, 1));
  }
  int n = 0;
  for (int v = 0; v < mesh.n_vertices(); ++v) n += on[v] && sets.find(v) == v;
  return n;
}

/// Vertices whose faces are not all joined through edges at the vertex.
int count_nonmanifold_vertices(const SurfaceMesh& mesh) {
  int n = 0;
  std::vector<std::pair<int, int>> by_edge;  // edge at the vertex, position of the face
  for (int v = 0; v < mesh.n_vertices(); ++v) {
    const auto faces = mesh.vertex_faces(v);
    if (faces.size() < 2) continue;
    by_edge.clear();
    for (std::size_t i = 0; i < faces.size(); ++i) {
      const auto corners = mesh.face(faces[i]);
      for (std::size_t k = 0; k < corners.size(); ++k)
        if (corners[k] == v || corners[(k + 1) % corners.size()] == v)
          by_edge.emplace_back(mesh.side_edge(faces[i], static_cast<int>(k)), static_cast<int>(i));
    }
    std::sort(by_edge.begin(), by_edge.end());
    DisjointSets sets(static_cast<int>(faces.size()));
    for (std::size_t i = 1; i < by_edge.size(); ++i)
      if (by_edge[i].first == by_edge[i - 1].first)
        sets.join(by_edge[i].second, by_edge[i - 1].second);
    // A face listed twice because it repeats the vertex is still one face.
    for (std::size_t i = 1; i < faces.size(); ++i)
      if (faces[i] == faces[i - 1]) sets.join(static_cast<int>(i), static_cast<int>(i - 1));
    for (std::size_t i = 1; i < faces.size(); ++i)
      if (sets.find(static_cast<int>(i)) != sets.find(0)) {
        ++n;
        break;
      }
  }
  return n;
}

/// Direction of the first sides of faces f and g on edge e.
bool runs_along(const SurfaceMesh& mesh, int f, int e) {
  for (int k = 0; k < static_cast<int>(mesh.face(f).size()); ++k)
    if (mesh.side_edge(f, k) == e) return mesh.side_along(f, k);
  return true;
}

struct EdgeTurns {
  int inconsistent_edges = 0;
  bool orientable = true;
};

EdgeTurns orientation_of(const SurfaceMesh& mesh) {
  EdgeTurns out;
  const int n = mesh.n_faces();
  DisjointSets sets(2 * n);  // face f as given: f; reversed: f + n
  for (int e = 0; e < mesh.n_edges(); ++e) {
    const auto faces = mesh.edge_faces(e);
    if (faces.size() != 2 || faces[0] == faces[1]) continue;
    const bool same = runs_along(mesh, faces[0], e) == runs_along(mesh, faces[1], e);
    out.inconsistent_edges += same;
    sets.join(faces[0], same ? faces[1] + n : faces[1]);
    sets.join(faces[0] + n, same ? faces[1] : faces[1] + n);
  }
  for (int f = 0; f < n && out.orientable; ++f) out.orientable = sets.find(f) != sets.find(f + n);
  return out;
}

int count_duplicate_faces(const SurfaceMesh& mesh) {
  std::vector<std::vector<int>> keys(std::size_t(mesh.n_faces()));
  for (int f = 0; f < mesh.n_faces(); ++f) {
    keys[f].assign(mesh.face(f).begin(), mesh.face(f).end());
    std::sort(keys[f].begin(), keys[f].end());
  }
  std::sort(keys.begin(), keys.end());
  return static_cast<int>(keys.end() - std::unique(keys.begin(), keys.end()));
}

int count_coincident_vertices(const MatX3& points) {
  std::vector<int> order;
  for (int v = 0; v < static_cast<int>(points.rows()); ++v)
    if (points.row(v).allFinite()) order.push_back(v);
  const auto key = [&](int v) { return std::array{points(v, 0), points(v, 1), points(v, 2)}; };
  std::sort(order.begin(), order.end(), [&](int a, int b) { return key(a) < key(b); });
  int n = 0;
  for (std::size_t i = 1; i < order.size(); ++i) n += key(order[i]) == key(order[i - 1]);
  return n;
}

struct FaceShapes {
  int degenerate = 0;
  double smallest_angle = infinity;  // degrees
  double mean_edge = 0;
};

/// Coordinates are divided by the diagonal first, so that nothing overflows.
FaceShapes shapes_of(const SurfaceMesh& mesh, double diagonal) {
  FaceShapes out;
  if (!(diagonal > 0)) {
    out.degenerate = mesh.n_faces();
    return out;
  }
  const auto at = [&](int v) -> Vec3 { return mesh.point(v) / diagonal; };
  for (int f = 0; f < mesh.n_faces(); ++f) {
    const auto corners = mesh.face(f);
    const std::size_t n = corners.size();
    std::vector<int> sorted(corners.begin(), corners.end());
    std::sort(sorted.begin(), sorted.end());
    const bool repeats = std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end();
    Vec3 area = Vec3::Zero();
    for (std::size_t k = 1; k + 1 < n; ++k)
      area += (at(corners[k]) - at(corners[0])).cross(at(corners[k + 1]) - at(corners[0])) / 2;
    if (repeats || area.norm() <= 1e-14) {
      ++out.degenerate;
      continue;
    }
    for (std::size_t k = 0; k < n; ++k) {
      const Vec3 a = at(corners[(k + 1) % n]) - at(corners[k]);
      const Vec3 b = at(corners[(k + n - 1) % n]) - at(corners[k]);
      out.smallest_angle = std::min(
          out.smallest_angle, std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / std::numbers::pi);
    }
  }
  for (int e = 0; e < mesh.n_edges(); ++e)
    out.mean_edge += (at(mesh.edges()(e, 0)) - at(mesh.edges()(e, 1))).norm();
  if (mesh.n_edges() > 0) out.mean_edge *= diagonal / mesh.n_edges();
  return out;
}

std::vector<std::pair<std::string, std::vector<double>>> scalar_ranges(const PolygonSoup& soup) {
  std::vector<std::pair<std::string, std::vector<double>>> out;
  for (const auto& [name, values] : soup.scalars) {
    double low = infinity, high = -infinity;
    for (double value : values) {
      if (std::isnan(value)) continue;
      low = std::min(low, value);
      high = std::max(high, value);
    }
    out.push_back({name, low <= high ? std::vector{low, high} : std::vector<double>{}});
  }
  return out;
}

struct InfoValueText {
  std::string operator()(bool value) const { return value ? "yes" : "no"; }
  std::string operator()(double value) const { return number_text(value); }
  std::string operator()(const std::string& value) const { return value; }
  std::string operator()(const std::vector<double>& values) const {
    if (values.empty()) return "none";
    std::string out;
    for (double value : values) out.append(number_text(value)).append(1, ' ');
    out.pop_back();
    return out;
  }
  std::string operator()(
      const std::vector<std::pair<std::string, std::vector<double>>>& named) const {
    if (named.empty()) return "none";
    std::string out;
    for (const auto& [name, values] : named)
      out.append(name).append(" (").append((*this)(values)).append("), ");
    out.erase(out.size() - 2);
    return out;
  }
};

}  // namespace

std::vector<InfoEntry> surface_info(const PolygonSoup& soup) {
  const SurfaceMesh mesh(valid_faces(soup));
  std::map<std::size_t, double> sizes;
  for (int f = 0; f < soup.n_faces(); ++f) ++sizes[soup.face(f).size()];
  std::vector<std::pair<std::string, std::vector<double>>> by_size;
  for (const auto& [size, n] : sizes) by_size.push_back({std::to_string(size), {n}});

  std::vector<char> used(std::size_t(soup.n_vertices()), 0);
  for (int v : soup.corners) used[v] = 1;
  Vec3 low = Vec3::Constant(infinity), high = -low;
  int n_bad = 0, n_used = 0;
  for (int v = 0; v < soup.n_vertices(); ++v) {
    n_used += mesh.vertex_component()[v] >= 0;
    if (!soup.points.row(v).allFinite()) {
      ++n_bad;
      continue;
    }
    low = low.cwiseMin(soup.points.row(v).transpose());
    high = high.cwiseMax(soup.points.row(v).transpose());
  }
  const bool has_box = n_bad < soup.n_vertices();
  const double diagonal = has_box ? (high - low).stableNorm() : 0;
  int n_nonmanifold = 0, n_boundary = 0;
  for (int e = 0; e < mesh.n_edges(); ++e) n_nonmanifold += mesh.edge_faces(e).size() > 2;
  const int n_loops = count_boundary_loops(mesh, n_boundary);
  const EdgeTurns orientation = orientation_of(mesh);
  const FaceShapes shapes = shapes_of(mesh, diagonal);

  std::vector<InfoEntry> out;
  const auto count = [&](const char* key, double n) { out.push_back({key, n}); };
  count("vertices", soup.n_vertices());
  count("faces", soup.n_faces());
  out.push_back({"faces_by_corners", by_size});
  count("edges", mesh.n_edges());
  count("lines", static_cast<double>(soup.lines.size()));
  count("isolated_vertices", static_cast<double>(std::count(used.begin(), used.end(), 0)));
  count("components", mesh.n_components());
  count("boundary_loops", n_loops);
  count("boundary_edges", n_boundary);
  count("euler_characteristic", double(n_used) - mesh.n_edges() + mesh.n_faces());
  count("nonmanifold_edges", n_nonmanifold);
  count("nonmanifold_vertices", count_nonmanifold_vertices(mesh));
  const PolygonSoup triangles = triangulate(mesh.soup());
  const FaceOrientation turned = face_orientation(SurfaceMesh(triangles));
  count("inconsistently_oriented_edges", orientation.inconsistent_edges);
  count("triangles_turned_against_most", turned.flipped);
  const double n_triangles = triangles.n_faces();
  count("share_of_turned_triangles", n_triangles > 0 ? turned.flipped / n_triangles : 0);
  out.push_back({"orientable", orientation.orientable});
  const std::vector<char> crossing =
      self_intersecting_faces(triangles.points, triangles_of(triangles));
  const auto n_crossing = std::count(crossing.begin(), crossing.end(), 1);
  count("self_intersecting_triangles", static_cast<double>(n_crossing));
  const bool closed = soup.n_faces() > 0 && n_boundary + n_nonmanifold == 0;
  out.push_back({"closed", closed});
  out.push_back({"watertight", closed && orientation.inconsistent_edges + n_crossing == 0});
  count("degenerate_faces", shapes.degenerate);
  count("duplicate_faces", count_duplicate_faces(mesh));
  count("coincident_vertices", count_coincident_vertices(soup.points));
  count("vertices_not_finite", n_bad);
  count("faces_not_finite", soup.n_faces() - mesh.n_faces());
  out.push_back({"has_normals", soup.normals.rows() > 0});
  out.push_back({"scalars", scalar_ranges(soup)});
  std::vector<double> box;
  if (has_box) box = {low[0], low[1], low[2], high[0], high[1], high[2]};
  out.push_back({"bounding_box", box});
  count("mean_edge_length", shapes.mean_edge);
  if (std::isfinite(shapes.smallest_angle)) count("smallest_angle", shapes.smallest_angle);
  return out;
}

std::vector<InfoEntry> sources_info(const SurfaceMesh& mesh, const Sources& sources,
                                    Report& report) {
  Sources placed = sources;
  placed.chains.clear();
  const PlacedSources prepared =
      placed.empty() ? PlacedSources{} : place_sources(mesh, placed, report);
  double n_signed = 0, n_unsigned = 0, n_nodes = 0, length = 0;
  for (const Curve& curve : sources.curves) {
    (curve.is_signed ? n_signed : n_unsigned) += 1;
    n_nodes += static_cast<double>(curve.nodes.size());
  }
  for (const SpaceCurve& curve : sources.space_curves) {
    (curve.is_signed ? n_signed : n_unsigned) += 1;
    n_nodes += static_cast<double>(curve.points.rows());
  }
  for (const CurvePiece& piece : prepared.pieces) length += piece.length;
  return {{"signed_curves", n_signed},
          {"unsigned_curves", n_unsigned},
          {"space_curves", static_cast<double>(sources.space_curves.size())},
          {"nodes", n_nodes},
          {"points", static_cast<double>(sources.points.size())},
          {"face_chains", static_cast<double>(sources.chains.size())},
          {"pieces", static_cast<double>(prepared.pieces.size())},
          {"length", length}};
}

std::string info_text(const std::vector<InfoEntry>& entries) {
  std::string out;
  for (const InfoEntry& entry : entries) {
    std::string key = entry.key;
    std::replace(key.begin(), key.end(), '_', ' ');
    out.append(key).append(": ").append(std::visit(InfoValueText{}, entry.value)).append(1, '\n');
  }
  return out;
}

}  // namespace littoral
