#include "domain/tet/tet_sight.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <unordered_map>

#include "domain/tet/tet_locator.h"

namespace littoral {

namespace {

constexpr double slack = 1e-6;     // barycentric: how far outside a line may pass
constexpr double touching = 1e-9;  // of a line: how far apart parts in neighbours may be
constexpr double flat = 1e-9;      // of a tet's height: such tets are folded over nothing
constexpr double straight = 1e-6;  // of half a turn: edges that turn less are flat

/// Lists by number in one array: begin[i] to begin[i + 1].
void list_by(const std::vector<std::pair<int, int>>& pairs, int n, std::vector<int>& begin,
             std::vector<int>& items) {
  begin.assign(n + 1, 0);
  for (const auto& [key, item] : pairs) ++begin[key + 1];
  for (std::size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
  std::vector<int> next = begin;
  items.resize(pairs.size());
  for (const auto& [key, item] : pairs) items[next[key]++] = item;
}

std::span<const int> listed(const std::vector<int>& begin, const std::vector<int>& items, int i) {
  return {items.data() + begin[i], items.data() + begin[i + 1]};
}

long long edge_number(int a, int b) {
  return (static_cast<long long>(std::min(a, b)) << 32) | std::max(a, b);
}

/// The angle between the faces of a tet at the edge from corner i to corner j.
double dihedral_angle(const TetMesh& mesh, int t, int i, int j) {
  std::array<int, 2> others{};
  for (int k = 0, n = 0; k < 4; ++k)
    if (k != i && k != j) others[n++] = k;
  const auto corner = [&](int k) { return Vec3(mesh.points.row(mesh.tets(t, k))); };
  const Vec3 along = corner(j) - corner(i);
  const Vec3 m = along.cross(corner(others[0]) - corner(i));
  const Vec3 n = along.cross(corner(others[1]) - corner(i));
  return std::atan2(m.cross(n).norm(), m.dot(n));
}

}  // namespace

TetSight::TetSight(const TetMesh& mesh, const Rows<int, 4>& tet_faces, int n_faces,
                   const Gradients& gradients)
    : mesh_(mesh), tet_faces_(tet_faces), gradients_(gradients) {
  std::vector<std::pair<int, int>> of_vertices, of_faces;
  for (int t = 0; t < mesh.n_tets(); ++t)
    for (int k = 0; k < 4; ++k) {
      if (!gradients[t].isZero(0)) of_vertices.emplace_back(mesh.tets(t, k), t);
      of_faces.emplace_back(tet_faces(t, k), t);
    }
  list_by(of_vertices, mesh.n_vertices(), at_vertex_begin_, at_vertex_);
  list_by(of_faces, n_faces, of_face_begin_, of_face_);
}

std::span<const int> TetSight::tets_at(int vertex) const {
  return listed(at_vertex_begin_, at_vertex_, vertex);
}

std::span<const int> TetSight::tets_of_face(int tet, int k) const {
  return listed(of_face_begin_, of_face_, tet_faces_(tet, k));
}

/// What of a line lies in a tet; all that is given, in a flat one.
bool TetSight::clip(int tet, const Vec3& from, const Vec3& to, Part& part) const {
  const auto& g = gradients_[tet];
  part.tet = tet;
  if (g.isZero(0)) return true;
  part.low = 0;
  part.high = 1;
  for (int k = 0; k < 4; ++k) {
    const Vec3 at = mesh_.points.row(mesh_.tets(tet, (k + 1) % 4));  // the coordinate is 0 there
    const double a = g.row(k).dot(from - at) + slack, b = g.row(k).dot(to - at) + slack;
    if (a < 0 && b < 0) return false;
    if (a < 0) part.low = std::max(part.low, a / (a - b));
    if (b < 0) part.high = std::min(part.high, a / (a - b));
  }
  return part.low <= part.high;
}

void TetSight::start(Walk& walk) const {
  if (walk.seen.empty() || ++walk.stamp == 0) {
    walk.seen.assign(mesh_.n_tets(), 0);
    walk.stamp = 1;
  }
  walk.open.clear();
  walk.last = -1;
}

bool TetSight::holds(int tet, Aim aim) const {
  const auto corners = mesh_.tets.row(tet).array();
  return (aim.a < 0 || (corners == aim.a).any()) && (aim.b < 0 || (corners == aim.b).any());
}

/// From the tets in `open` to others whose parts of the line touch, the furthest first.
bool TetSight::walk_on(const Vec3& from, const Vec3& to, Walk& walk, Aim aim) const {
  double furthest = -1;
  while (!walk.open.empty()) {
    const auto best =
        std::max_element(walk.open.begin(), walk.open.end(),
                         [](const Part& a, const Part& b) { return a.high < b.high; });
    const Part here = *best;
    *best = walk.open.back();
    walk.open.pop_back();
    const bool is_flat = gradients_[here.tet].isZero(0);
    if (here.high >= 1 && !is_flat && holds(here.tet, aim)) return true;
    if (here.high > furthest) {
      furthest = here.high;
      walk.last = here.tet;
    }
    for (int k = 0; k < 4; ++k)
      for (const int next : tets_of_face(here.tet, k)) {
        unsigned& seen = walk.seen[next];
        if (seen == walk.stamp) continue;
        Part part = here;
        if (!clip(next, from, to, part) || part.low > here.high + touching ||
            part.high < here.low - touching)
          continue;
        seen = walk.stamp;
        walk.open.push_back(part);
      }
  }
  return false;
}

bool TetSight::sees(int vertex, const Vec3& to, Walk& walk, Aim aim) const {
  start(walk);
  const Vec3 from = mesh_.points.row(vertex);
  for (const int t : tets_at(vertex)) {
    Part part{};
    walk.seen[t] = walk.stamp;
    if (clip(t, from, to, part)) walk.open.push_back(part);
  }
  return walk_on(from, to, walk, aim);
}

bool TetSight::sees(int a, int b, const Vec3& from, const Vec3& to, Walk& walk, Aim aim) const {
  start(walk);
  for (const int t : tets_at(a)) {
    if (!(mesh_.tets.row(t).array() == b).any()) continue;
    Part part{};
    walk.seen[t] = walk.stamp;
    if (clip(t, from, to, part)) walk.open.push_back(part);
  }
  return walk_on(from, to, walk, aim);
}

int folded_tets(const TetMesh& mesh, const TetSight& sight) {
  int folded = 0;
  for (int t = 0; t < mesh.n_tets(); ++t)
    for (int k = 0; k < 4; ++k) {
      const std::span<const int> sharing = sight.tets_of_face(t, k);
      if (sharing.size() != 2 || sharing[0] != t) continue;
      const auto corner = [&](int i) { return Vec3(mesh.points.row(mesh.tets(t, i))); };
      const Vec3 a = corner((k + 1) % 4), b = corner((k + 2) % 4), c = corner((k + 3) % 4);
      const Vec3 normal = (b - a).cross(c - a);
      const int other = sharing[1];
      const auto on_face = [&](int v) { return (mesh.tets.row(t).array() == v).any(); };
      for (int i = 0; i < 4; ++i) {
        const int v = mesh.tets(other, i);
        if (on_face(v) && v != mesh.tets(t, k)) continue;
        const Vec3 p = corner(k) - a, q = mesh.points.row(v).transpose() - a;
        const double least = flat * normal.norm();
        const double above = normal.dot(p), across = normal.dot(q);
        if (above * across > 0 && std::abs(above) > least * p.norm() &&
            std::abs(across) > least * q.norm())
          ++folded;
        break;
      }
    }
  return folded;
}

std::vector<std::vector<int>> reentrant_edges(const TetMesh& mesh, const TetSight& sight) {
  std::unordered_map<long long, double> turn;
  const MatX3i boundary = boundary_faces(mesh);
  for (const auto& f : boundary.rowwise())
    for (int k = 0; k < 3; ++k) turn.try_emplace(edge_number(f[k], f[(k + 1) % 3]), 0);
  std::vector<std::vector<int>> ends(mesh.n_vertices());
  for (int v = 0; v < mesh.n_vertices(); ++v)
    for (const int t : sight.tets_at(v))
      for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4 && mesh.tets(t, i) == v; ++j)
          if (mesh.tets(t, j) > v)
            if (const auto edge = turn.find(edge_number(v, mesh.tets(t, j))); edge != turn.end())
              edge->second += dihedral_angle(mesh, t, i, j);
  for (const auto& [edge, angle] : turn) {
    if (angle <= std::numbers::pi * (1 + straight)) continue;
    const int a = static_cast<int>(edge >> 32), b = static_cast<int>(edge & 0xffffffff);
    ends[a].push_back(b);
    ends[b].push_back(a);
  }
  for (std::vector<int>& at : ends) std::sort(at.begin(), at.end());
  return ends;
}

}  // namespace littoral
