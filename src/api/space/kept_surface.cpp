#include "api/space/kept_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "api/space/frame.h"
#include "api/space/space_input.h"
#include "api/space/surface_parts.h"
#include "api/surface/mesh_info.h"
#include "base/index.h"
#include "domain/mesh/face_orientation.h"
#include "domain/mesh/surface_mesh.h"
#include "methods/implicit/settled_sides.h"
#include "spatial/boundary_edges.h"
#include "spatial/triangulate.h"

namespace littoral {

namespace {

constexpr double beside = 1e-4;     // of a triangle's height: how far from it sides are asked for
constexpr double sure = 0.4;        // of 1/2 at most: inside and outside of a closed surface
constexpr double flattest = 1e-12;  // height over the longest side

using Corners = std::array<int, 3>;

Corners corners_of(const MatX3i& faces, Eigen::Index f) {
  return {faces(f, 0), faces(f, 1), faces(f, 2)};
}

struct KeptTriangle {
  Vec3 normal = Vec3::Zero();
  double height = 0, area = 0;  // over the longest side
  bool flat = true;
};

KeptTriangle shape_of(const MatX3& points, const Corners& v) {
  const Vec3 a = points.row(v[0]), b = points.row(v[1]), c = points.row(v[2]);
  const Vec3 across = (b - a).cross(c - a);
  const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
  KeptTriangle out;
  out.area = across.norm() / 2;
  out.height = longest > 0 ? 2 * out.area / longest : 0;
  out.flat = !(out.height > flattest * longest);
  if (!out.flat) out.normal = across.normalized();
  return out;
}

/// The input's triangles on merged corners, each once; none if one of them has no area.
MatX3i cleaned(const PolygonSoup& input) {
  MatX3i triangles = triangles_of(triangulate(input));
  const std::vector<int> first = same_positions(input.points);
  const MatX3 points = input.points / Frame(bounding_box(input)).unit;  // exactly: a power of two
  std::set<Corners> seen;
  Eigen::Index n = 0;
  for (Eigen::Index f = 0; f < triangles.rows(); ++f) {
    const Corners v{first[triangles(f, 0)], first[triangles(f, 1)], first[triangles(f, 2)]};
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) continue;
    if (shape_of(points, v).flat) return MatX3i(0, 3);
    Corners sorted = v;
    std::sort(sorted.begin(), sorted.end());
    if (seen.insert(sorted).second) triangles.row(n++) << v[0], v[1], v[2];
  }
  triangles.conservativeResize(n, 3);
  return triangles;
}

bool two_at_each_edge(const SurfaceMesh& mesh) {
  for (int e = 0; e < mesh.n_edges(); ++e)
    if (mesh.edge_faces(e).size() != 2) return false;
  return mesh.n_faces() > 0;
}

bool is_sound(const PolygonSoup& surface) {
  for (const InfoEntry& fact : surface_info(surface)) {
    if (fact.key == "watertight" && !std::get<bool>(fact.value)) return false;
    if (fact.key == "nonmanifold_vertices" && std::get<double>(fact.value) > 0) return false;
  }
  return true;
}

/// Whether a part is turned outward (1), inward (-1) or bounds nothing (0), by its widest triangle.
std::optional<int> turn_of(const MatX3& points, const Corners& widest, const SettledSides& sides) {
  const KeptTriangle shape = shape_of(points, widest);
  const Vec3 centre =
      (points.row(widest[0]) + points.row(widest[1]) + points.row(widest[2])).transpose() / 3;
  const Vec3 step = beside * shape.height * shape.normal;
  const double front = sides.inside(centre + step, infinity);
  const double behind = sides.inside(centre - step, infinity);
  if (std::abs(front) < sure || std::abs(behind) < sure) return std::nullopt;
  return (behind > 0) - (front > 0);
}

}  // namespace

std::optional<KeptSurface> kept_surface(const PolygonSoup& input, Task task, Report& report) {
  if (input.n_faces() == 0 || !input.points.allFinite()) return std::nullopt;
  MatX3i faces = cleaned(input);
  if (faces.rows() == 0) return std::nullopt;
  Box box;
  for (const int v : faces.reshaped()) box.add(input.points.row(v).transpose());
  const MatX3 points = Frame(box).local(input.points);
  const SurfaceMesh mesh(soup_of(points, faces));
  if (!two_at_each_edge(mesh)) return std::nullopt;
  const FaceOrientation& agreed = face_orientation(mesh);
  if (!agreed.orientable) return std::nullopt;

  task.checkpoint(0.2);
  Report said = report;
  const SettledSides sides = settled_sides(points, faces, false, task.stage(0.5, "sides"), said);
  if (said.status != report.status) return std::nullopt;
  const auto turn_over = [&](Eigen::Index f) { std::swap(faces(f, 1), faces(f, 2)); };
  for (Eigen::Index f = 0; f < faces.rows(); ++f)
    if (agreed.sign[f] < 0) turn_over(f);
  const SurfaceParts parts = parts_of(soup_of(points, faces));
  const std::size_t n = parts.boxes.size();
  std::vector<int> widest(n, -1);
  VecX areas(faces.rows());
  for (Eigen::Index f = 0; f < faces.rows(); ++f) {
    areas[f] = shape_of(points, corners_of(faces, f)).area;
    int& best = widest[parts.of_face[f]];
    if (best < 0 || areas[f] > areas[best]) best = static_cast<int>(f);
  }
  std::vector<char> stays(n, 0);
  std::vector<int> turn(n, 0);
  for (std::size_t i = 0; i < n; ++i) {
    task.checkpoint(0.5 + 0.2 * static_cast<double>(i) / static_cast<double>(n));
    const auto found = turn_of(points, corners_of(faces, widest[i]), sides);
    if (!found) return std::nullopt;
    turn[i] = *found;
    stays[i] = turn[i] != 0;
  }
  KeptSurface out;
  for (Eigen::Index f = 0; f < faces.rows(); ++f) {
    const int part = parts.of_face[f];
    if (turn[part] < 0) turn_over(f);
    out.turned += (agreed.sign[f] < 0) != (turn[part] < 0) && stays[part];
    out.dropped += stays[part] ? 0 : areas[f];
  }
  out.turned /= static_cast<double>(faces.rows());
  out.dropped /= areas.sum();
  out.surface = with_parts(soup_of(input.points, faces), parts, stays);
  task.checkpoint(0.7);
  if (out.surface.n_faces() == 0 || !is_sound(out.surface)) return std::nullopt;
  report = std::move(said);
  return out;
}

}  // namespace littoral
