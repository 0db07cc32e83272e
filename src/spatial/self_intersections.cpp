#include "spatial/self_intersections.h"

#include <algorithm>
#include <array>
#include <limits>

#include "base/parallel.h"
#include "spatial/boundary_edges.h"
#include "spatial/cluster_tree.h"
#include "spatial/exact_signs.h"

namespace littoral {

namespace {

struct Corner {
  int id;  // equal for equal positions
  Vec3 at;
};
using Triangle = std::array<Corner, 3>;

Vec2 without(int axis, const Vec3& x) { return {x[(axis + 1) % 3], x[(axis + 2) % 3]}; }

/// An axis along which the triangle is seen with an area; -1 if it has none.
int seen_along(const Triangle& t) {
  for (int axis = 0; axis < 3; ++axis)
    if (orientation_sign(without(axis, t[0].at), without(axis, t[1].at), without(axis, t[2].at)))
      return axis;
  return -1;
}

/// On one line: is c between a and b, ends included?
bool between(const Vec2& a, const Vec2& b, const Vec2& c) {
  return (c.array() >= a.cwiseMin(b).array()).all() && (c.array() <= a.cwiseMax(b).array()).all();
}

bool segments_meet(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const int abc = orientation_sign(a, b, c), abd = orientation_sign(a, b, d);
  const int cda = orientation_sign(c, d, a), cdb = orientation_sign(c, d, b);
  if (abc * abd < 0 && cda * cdb < 0) return true;
  return (abc == 0 && between(a, b, c)) || (abd == 0 && between(a, b, d)) ||
         (cda == 0 && between(c, d, a)) || (cdb == 0 && between(c, d, b));
}

/// In the plane of the triangle.
bool meets_within_plane(const Vec3& u, const Vec3& v, const Triangle& t) {
  const int axis = seen_along(t);
  const Vec2 a = without(axis, u), b = without(axis, v);
  std::array<Vec2, 3> c;
  for (int k = 0; k < 3; ++k) c[k] = without(axis, t[k].at);
  const int turn = orientation_sign(c[0], c[1], c[2]);
  bool inside = true;  // the first end; otherwise the segment crosses a side
  for (int k = 0; k < 3; ++k) {
    if (segments_meet(a, b, c[k], c[(k + 1) % 3])) return true;
    inside = inside && orientation_sign(c[k], c[(k + 1) % 3], a) * turn > 0;
  }
  return inside;
}

/// A segment and a triangle of some area, both with their ends.
bool meets(const Vec3& u, const Vec3& v, const Triangle& t) {
  const Vec3 &a = t[0].at, &b = t[1].at, &c = t[2].at;
  const int at_u = orientation_sign(a, b, c, u), at_v = orientation_sign(a, b, c, v);
  if (at_u * at_v > 0) return false;
  if (at_u == 0 && at_v == 0) return meets_within_plane(u, v, t);
  const int ab = orientation_sign(u, v, a, b), bc = orientation_sign(u, v, b, c),
            ca = orientation_sign(u, v, c, a);
  return (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
}

/// The triangle with the corners that the other one has too in front, and how many these are.
int shared_first(Triangle& t, const Triangle& other) {
  const auto is_shared = [&](const Corner& c) {
    return std::any_of(other.begin(), other.end(), [&](const Corner& o) { return o.id == c.id; });
  };
  return static_cast<int>(std::stable_partition(t.begin(), t.end(), is_shared) - t.begin());
}

/// Two triangles of some area: do they meet beyond what they share?
bool meet(Triangle s, Triangle t) {
  const Triangle as_given = s;
  const int shared = shared_first(s, t);
  shared_first(t, as_given);
  if (shared == 3) return true;
  if (shared == 2) {  // hinged: folded flat onto each other, or not at all
    if (orientation_sign(s[0].at, s[1].at, s[2].at, t[2].at) != 0) return false;
    const int axis = seen_along(s);
    const Vec2 a = without(axis, s[0].at), b = without(axis, s[1].at);
    return orientation_sign(a, b, without(axis, s[2].at)) ==
           orientation_sign(a, b, without(axis, t[2].at));
  }
  // What both have of a common line starts at the shared corner, if there is one, and ends where a
  // side opposite to it meets the other triangle.
  for (int k = shared; k < (shared == 1 ? 2 : 3); ++k) {
    const int next = (k + 1) % 3;
    if (meets(s[k].at, s[next].at, t) || meets(t[k].at, t[next].at, s)) return true;
  }
  return false;
}

struct Bounds {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  void include(const Bounds& b) {
    low = low.cwiseMin(b.low);
    high = high.cwiseMax(b.high);
  }
  bool overlaps(const Bounds& b) const {
    return (low.array() <= b.high.array()).all() && (b.low.array() <= high.array()).all();
  }
};

}  // namespace

std::vector<char> self_intersecting_faces(const MatX3& points, const MatX3i& faces,
                                          const Task& task, const std::vector<char>& asked) {
  std::vector<char> out(static_cast<std::size_t>(faces.rows()), 0);
  const std::vector<int> same = same_positions(points);
  std::vector<int> number;  // of a triangle that counts -> its face
  std::vector<Triangle> triangles;
  for (Eigen::Index f = 0; f < faces.rows(); ++f) {
    Triangle t;
    bool finite = true;
    for (int k = 0; k < 3; ++k) {
      const int v = faces(f, k);
      t[k] = {same[v], points.row(v)};
      finite = finite && t[k].at.allFinite();
    }
    if (!finite || seen_along(t) < 0) continue;
    triangles.push_back(t);
    number.push_back(static_cast<int>(f));
  }
  if (triangles.empty()) return out;

  const std::size_t n = triangles.size();
  std::vector<Bounds> boxes(n);
  MatX3 centres(static_cast<Eigen::Index>(n), 3);
  for (std::size_t i = 0; i < n; ++i) {
    for (const Corner& c : triangles[i]) boxes[i].include({c.at, c.at});
    centres.row(static_cast<Eigen::Index>(i)) = boxes[i].low / 2 + boxes[i].high / 2;
  }
  const ClusterTree tree = cluster(centres, 4);
  std::vector<Bounds> around(tree.clusters.size());
  for (std::size_t c = tree.clusters.size(); c-- > 0;) {  // children stand after their parents
    const Cluster& each = tree.clusters[c];
    if (each.child < 0)
      for (int i = each.begin; i < each.end; ++i) around[c].include(boxes[tree.order[i]]);
    else
      for (int k : {0, 1}) around[c].include(around[each.child + k]);
  }

  const auto hits = [&](int i) {  // does triangle i meet any other one?
    std::vector<int> open{0};
    while (!open.empty()) {
      const Cluster& each = tree.clusters[open.back()];
      const bool near = around[open.back()].overlaps(boxes[i]);
      open.pop_back();
      if (!near) continue;
      if (each.child >= 0) {
        open.push_back(each.child);
        open.push_back(each.child + 1);
        continue;
      }
      for (int k = each.begin; k < each.end; ++k) {
        const int j = tree.order[k];
        if (j != i && boxes[j].overlaps(boxes[i]) && meet(triangles[i], triangles[j])) return true;
      }
    }
    return false;
  };
  parallel_for(n, 256, [&](std::size_t begin, std::size_t end) {
    task.checkpoint(static_cast<double>(begin) / static_cast<double>(n));
    for (std::size_t k = begin; k < end; ++k) {
      const int i = tree.order[k];
      if ((asked.empty() || asked[number[i]]) && hits(i)) out[number[i]] = 1;
    }
  });
  return out;
}

}  // namespace littoral
