#include "contour/fit_to_surface.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "base/index.h"
#include "base/parallel.h"
#include "spatial/morton_order.h"
#include "spatial/self_intersections.h"
#include "spatial/triangle_bvh.h"

namespace littoral {

namespace {

constexpr double crease = 0.866;    // cosine of the angle between planes from which they are two
constexpr double on_crease = 0.15;  // of the reach: nearer vertices become part of the crease
constexpr double folded = -0.3;     // cosine of the angle by which a face has turned over
constexpr int slides = 5;           // rounds of moving vertices between their neighbours,
constexpr int alone = 10;           // up to where they go back alone, a step; then to the start

/// Where a vertex of the contour meets the target.
struct Foot {
  bool found = false;
  Vec3 point = Vec3::Zero();
  Vec3 normal = Vec3::Zero();  // of the target's triangle, to the side of larger values; zero on a
                               // crease, where there is none
};

std::vector<Vec3> vertex_normals(const MatX3& points, const MatX3i& faces) {
  std::vector<Vec3> normals(std::size_t(points.rows()), Vec3::Zero());
  for (Eigen::Index f = 0; f < faces.rows(); ++f) {
    const Vec3 a = points.row(faces(f, 0)), b = points.row(faces(f, 1)),
               c = points.row(faces(f, 2));
    const Vec3 n = (b - a).cross(c - a);
    for (int k = 0; k < 3; ++k) normals[faces(f, k)] += n;
  }
  return normals;
}

std::vector<Foot> feet_of(const MatX3& points, const std::vector<Vec3>& normals,
                          const TriangleBvh& bvh, const MatX3& target_points,
                          const MatX3i& target_faces, double reach, const Task& task) {
  std::vector<Foot> feet(normals.size());
  const std::vector<int> order = morton_order(points);
  parallel_for(feet.size(), 1024, [&](std::size_t begin, std::size_t end) {
    task.checkpoint(static_cast<double>(begin) / static_cast<double>(feet.size()));
    int near = -1;
    for (std::size_t k = begin; k < end; ++k) {
      const int v = order[k];
      const NearestPoint nearest = bvh.closest_point(points.row(v), near);
      near = nearest.face;
      if (!(nearest.distance <= reach)) continue;
      const Vec3 a = target_points.row(target_faces(near, 0));
      const Vec3 b = target_points.row(target_faces(near, 1));
      const Vec3 c = target_points.row(target_faces(near, 2));
      Vec3 normal = (b - a).cross(c - a).stableNormalized();
      if (normal.dot(normals[v]) < 0) normal = -normal;
      feet[v] = {true, nearest.point, normal};
    }
  });
  return feet;
}

/// Where the planes at some feet meet, nearest to `near`; near directions that they leave free.
Vec3 meeting_point(const std::vector<const Foot*>& planes, const Vec3& near) {
  Eigen::Matrix3d normal_equations = Eigen::Matrix3d::Zero();
  Vec3 rhs = Vec3::Zero();
  for (const Foot* plane : planes) {
    normal_equations += plane->normal * plane->normal.transpose();
    rhs += plane->normal * plane->normal.dot(plane->point - near);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(normal_equations);
  Vec3 step = Vec3::Zero();
  for (int k = 0; k < 3; ++k)
    if (eigen.eigenvalues()[k] > 0.05) {
      const Vec3 axis = eigen.eigenvectors().col(k);
      step += axis * (axis.dot(rhs) / eigen.eigenvalues()[k]);
    }
  return near + step;
}

bool differ(const Foot& a, const Foot& b) {
  return a.found && b.found && !a.normal.isZero() && !b.normal.isZero() &&
         a.normal.dot(b.normal) < crease;
}

/// The contour cut along creases. Each vertex has three places: on the contour, on the target next
/// to it, and there on a crease; the last ones are the same where it has none.
struct Cut {
  std::vector<std::array<Vec3, 3>> places;
  std::vector<int> best;     // the last place that is one of its own: 0 where it cannot move
  std::vector<char> corner;  // where creases meet
  std::vector<std::array<int, 3>> faces;
};

class Cutter {
 public:
  Cutter(const MatX3& points, const MatX3i& faces, std::vector<Foot> feet, const TriangleBvh& bvh,
         double reach)
      : faces_(faces), feet_(std::move(feet)), bvh_(bvh), reach_(reach) {
    for (Eigen::Index v = 0; v < points.rows(); ++v) {
      const Vec3 from = points.row(v), to = feet_[v].found ? feet_[v].point : from;
      add({from, to, to}, feet_[v].found ? 1 : 0);
    }
    place_on_creases();
    for (Eigen::Index f = 0; f < faces.rows(); ++f) split(f);
    place_on_corners();
  }
  Cut cut;

 private:
  int add(const std::array<Vec3, 3>& places, int best) {
    cut.places.push_back(places);
    cut.best.push_back(best);
    cut.corner.push_back(0);
    return static_cast<int>(cut.places.size()) - 1;
  }
  const Vec3& from(int v) const { return cut.places[v][0]; }
  const Vec3& to(int v) const { return cut.places[v][2]; }

  /// On the target, or nothing where that is too far from the contour.
  bool on_target(Vec3& x, const Vec3& from) const {
    if (!x.allFinite() || !((x - from).norm() <= 1.5 * reach_)) return false;
    x = bvh_.closest_point(x).point;
    return (x - from).norm() <= 1.5 * reach_;
  }

  /// Vertices so near to a crease that a point on a side would be next to them go there themselves,
  /// but never all corners of a triangle, nor two of them to one place: it would be flat.
  void place_on_creases() {
    const std::vector<Foot> before = feet_;
    std::vector<std::vector<int>> faces_at(before.size());
    for (Eigen::Index f = 0; f < faces_.rows(); ++f)
      for (int k = 0; k < 3; ++k) faces_at[faces_(f, k)].push_back(static_cast<int>(f));
    const auto is_placed = [&](int v) { return cut.best[v] == 2; };
    const auto flattens = [&](int v, const Vec3& x) {
      return std::any_of(faces_at[v].begin(), faces_at[v].end(), [&](int f) {
        int placed = 0;
        for (const int w : faces_.row(f))
          if (is_placed(w)) placed += (to(w) - x).norm() < on_crease * reach_ ? 2 : 1;
        return placed >= 2;
      });
    };
    for (int v = 0; v < static_cast<int>(before.size()); ++v)
      for (const int f : faces_at[v])
        for (int k = 0; k < 3 && !is_placed(v); ++k) {
          const int w = faces_(f, k);
          if (!differ(before[v], before[w])) continue;
          Vec3 x = meeting_point({&before[v], &before[w]}, before[v].point);
          if ((x - before[v].point).norm() > on_crease * reach_ || !on_target(x, from(v)) ||
              flattens(v, x))
            continue;
          cut.places[v][2] = x;
          cut.best[v] = 2;
          feet_[v].normal.setZero();
        }
  }

  /// The point on a side between two planes; -1 where there are not two.
  int middle(int a, int b) {
    if (!differ(feet_[a], feet_[b])) return -1;
    const auto key = std::minmax(a, b);
    const auto [entry, is_new] = middles_.try_emplace(key, -1);
    if (!is_new) return entry->second;
    const Vec3 start = (from(a) + from(b)) / 2, between = (to(a) + to(b)) / 2;
    Vec3 x = meeting_point({&feet_[a], &feet_[b]}, between);
    if (on_target(x, start)) entry->second = add({start, bvh_.closest_point(between).point, x}, 2);
    return entry->second;
  }

  void face(int a, int b, int c) { cut.faces.push_back({a, b, c}); }

  void split(Eigen::Index f) {
    std::array<int, 3> v, m;
    for (int k = 0; k < 3; ++k) v[k] = faces_(f, k);
    for (int k = 0; k < 3; ++k) m[k] = middle(v[k], v[(k + 1) % 3]);
    const auto n = std::count_if(m.begin(), m.end(), [](int i) { return i >= 0; });
    if (n == 0) return face(v[0], v[1], v[2]);
    int k = 0;  // turned so that sides 0 (and 2, or none) are split
    while (!(n == 3 || (n == 1 && m[k] >= 0) || (n == 2 && m[(k + 1) % 3] < 0))) ++k;
    std::rotate(v.begin(), v.begin() + k, v.end());
    std::rotate(m.begin(), m.begin() + k, m.end());
    if (n == 1) {
      face(v[0], m[0], v[2]);
      face(m[0], v[1], v[2]);
    } else if (n == 2) {  // one corner is cut off; the rest by its shorter diagonal
      face(v[0], m[0], m[2]);
      const bool first = (to(m[0]) - to(v[2])).norm() < (to(m[2]) - to(v[1])).norm();
      if (first) {
        face(m[0], v[1], v[2]);
        face(m[0], v[2], m[2]);
      } else {
        face(m[0], v[1], m[2]);
        face(m[2], v[1], v[2]);
      }
    } else {  // three planes meet
      const Vec3 start = (from(v[0]) + from(v[1]) + from(v[2])) / 3;
      const Vec3 between = (to(m[0]) + to(m[1]) + to(m[2])) / 3;
      Vec3 x = meeting_point({&feet_[v[0]], &feet_[v[1]], &feet_[v[2]]}, between);
      if (!on_target(x, start)) x = between;
      const int c = add({start, bvh_.closest_point(between).point, x}, 2);
      for (int i = 0; i < 3; ++i) {
        face(v[i], m[i], c);
        face(m[i], v[(i + 1) % 3], c);
      }
    }
  }

  /// Where vertices on creases have three planes about them, the one nearest to where these meet
  /// goes there.
  void place_on_corners() {
    using Planes = std::vector<const Foot*>;
    const auto add_plane = [](Planes& planes, const Foot* foot) {
      const auto same = [&](const Foot* other) { return !differ(*other, *foot); };
      if (std::none_of(planes.begin(), planes.end(), same)) planes.push_back(foot);
    };
    std::vector<Planes> next_to(cut.places.size());
    for (const auto& face : cut.faces)
      for (const int v : face)
        for (const int w : face)
          if (cut.best[v] == 2 && w < static_cast<int>(feet_.size()) && feet_[w].found &&
              !feet_[w].normal.isZero())
            add_plane(next_to[v], &feet_[w]);
    std::vector<Planes> planes = next_to;
    for (const auto& face : cut.faces)
      for (const int v : face)
        for (const int w : face)
          if (cut.best[v] == 2 && cut.best[w] == 2)
            for (const Foot* foot : next_to[w]) add_plane(planes[v], foot);
    struct Candidate {
      double distance;
      int v;
      Vec3 x;
    };
    std::vector<Candidate> candidates;
    for (int v = 0; v < static_cast<int>(planes.size()); ++v) {
      if (planes[v].size() < 3) continue;
      Vec3 x = meeting_point(planes[v], to(v));
      if (on_target(x, from(v))) candidates.push_back({(x - to(v)).norm(), v, x});
    }
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const auto& a, const auto& b) { return a.distance < b.distance; });
    std::vector<Vec3> taken;
    for (const Candidate& each : candidates) {
      if (std::any_of(taken.begin(), taken.end(),
                      [&](const Vec3& x) { return (x - each.x).norm() < reach_ / 2; }))
        continue;
      taken.push_back(each.x);
      cut.places[each.v][2] = each.x;
      cut.corner[each.v] = 1;
    }
  }

  const MatX3i& faces_;
  std::vector<Foot> feet_;
  const TriangleBvh& bvh_;
  double reach_;
  std::map<std::pair<int, int>, int> middles_;
};

Vec3 normal_of(const MatX3& points, const Eigen::RowVector3i& face) {
  const Vec3 a = points.row(face[0]), b = points.row(face[1]), c = points.row(face[2]);
  return (b - a).cross(c - a);
}

/// Of each vertex of a closed mesh, those that it shares a side with.
std::vector<std::vector<int>> neighbours_of(const MatX3i& faces, Eigen::Index n) {
  std::vector<std::vector<int>> out(n);
  for (Eigen::Index f = 0; f < faces.rows(); ++f)
    for (int k = 0; k < 3; ++k) out[faces(f, k)].push_back(faces(f, (k + 1) % 3));
  return out;
}

/// Vertices of faces that are marked.
std::vector<char> vertices_of(const std::vector<char>& marked, const MatX3i& faces,
                              Eigen::Index n) {
  std::vector<char> out(std::size_t(n), 0);
  for (Eigen::Index f = 0; f < faces.rows(); ++f)
    if (marked[f])
      for (int k = 0; k < 3; ++k) out[faces(f, k)] = 1;
  return out;
}

/// Faces with a vertex that is marked.
std::vector<char> faces_of(const std::vector<char>& marked, const MatX3i& faces) {
  std::vector<char> out(std::size_t(faces.rows()), 0);
  for (Eigen::Index f = 0; f < faces.rows(); ++f)
    for (int k = 0; k < 3; ++k) out[f] |= marked[faces(f, k)];
  return out;
}

/// Bad vertices move to the middle of their neighbours, on the target: on a crease, of those there.
void slide(Cut& cut, const std::vector<int>& place, const std::vector<char>& bad,
           const std::vector<std::vector<int>>& neighbours, const MatX3& points,
           const TriangleBvh& bvh, double reach) {
  for (std::size_t v = 0; v < bad.size(); ++v) {
    if (!bad[v] || place[v] == 0 || cut.corner[v]) continue;
    Vec3 sum = Vec3::Zero();
    int count = 0;
    for (const int w : neighbours[v])
      if (place[w] >= place[v]) {
        sum += points.row(w);
        ++count;
      }
    if (count < 2) continue;
    const Vec3 x = bvh.closest_point(sum / count).point;
    if ((x - cut.places[v][0]).norm() <= reach) cut.places[v][place[v]] = x;
  }
}

}  // namespace

void untangle(MatX3& points, const MatX3i& faces, const Task& task) {
  const Eigen::Index n = points.rows();
  std::vector<std::vector<int>> neighbours;
  std::vector<char> asked;
  for (int round = 0; round < 20; ++round) {
    const std::vector<char> crossing = self_intersecting_faces(points, faces, task, asked);
    if (std::count(crossing.begin(), crossing.end(), 1) == 0) return;
    if (neighbours.empty()) neighbours = neighbours_of(faces, n);
    const std::vector<char> bad = vertices_of(crossing, faces, n);
    const MatX3 before = points;
    for (Eigen::Index v = 0; v < n; ++v) {
      if (!bad[v] || neighbours[v].empty()) continue;
      Vec3 sum = Vec3::Zero();
      for (const int w : neighbours[v]) sum += before.row(w);
      points.row(v) = (before.row(v).transpose() + sum / double(neighbours[v].size())) / 2;
    }
    asked = faces_of(bad, faces);  // those that cross are among them
  }
}

FittedSurface fit_to_surface(const MatX3& points, const MatX3i& faces, const MatX3& target_points,
                             const MatX3i& target_faces, double reach, Task task) {
  const TriangleBvh bvh(target_points, target_faces);
  const Task placing = task.stage(0.4, "fitting");
  Cut cut = Cutter(points, faces,
                   feet_of(points, vertex_normals(points, faces), bvh, target_points, target_faces,
                           reach, placing),
                   bvh, reach)
                .cut;
  const auto n = index(cut.places.size()), m = index(cut.faces.size());
  FittedSurface out;
  out.points.resize(n, 3);
  out.faces.resize(m, 3);
  MatX3 before(n, 3);
  for (Eigen::Index f = 0; f < m; ++f)
    out.faces.row(f) << cut.faces[f][0], cut.faces[f][1], cut.faces[f][2];
  for (Eigen::Index v = 0; v < n; ++v) before.row(v) = cut.places[v][0];

  const auto neighbours = neighbours_of(out.faces, n);

  // Vertices of faces that cross others or fold over slide between their neighbours, those on
  // creases along these. Where that does not help they go back a step: first those alone, then with
  // their neighbours, until none is left that moves or all is well.
  std::vector<int> place = cut.best;
  std::vector<char> asked;  // faces that may have changed since the last check; empty: all
  for (int round = 0;; ++round) {
    for (Eigen::Index v = 0; v < n; ++v) out.points.row(v) = cut.places[v][place[v]];
    std::vector<char> bad = self_intersecting_faces(
        out.points, out.faces, task.stage(round < 10 ? 0.05 : 0.001, "checking"), asked);
    for (Eigen::Index f = 0; f < m; ++f) {
      const Eigen::RowVector3i face = out.faces.row(f);
      const Vec3 now = normal_of(out.points, face), then = normal_of(before, face);
      const bool fits = place[face[0]] + place[face[1]] + place[face[2]] > 0;
      bad[f] = fits && (bad[f] || now.dot(then) < folded * now.norm() * then.norm());
    }
    std::vector<char> back = vertices_of(bad, out.faces, n);
    if (std::count(back.begin(), back.end(), 1) == 0) {
      if (asked.empty()) break;
      asked.clear();  // one that went back may cross one that was not asked again
      continue;
    }
    asked = faces_of(back, out.faces);
    if (round < slides) {
      slide(cut, place, back, neighbours, out.points, bvh, 1.5 * reach);
      continue;
    }
    if (round >= alone) {
      back = vertices_of(asked, out.faces, n);
      asked = faces_of(back, out.faces);
    }
    for (Eigen::Index v = 0; v < n; ++v)
      if (back[v]) place[v] = round < alone ? std::max(0, place[v] - 1) : 0;
  }
  for (Eigen::Index v = 0; v < n; ++v) {
    out.n_moved += place[v] > 0;
    out.n_kept += place[v] < cut.best[v];
  }
  return out;
}

}  // namespace littoral
