#include "spatial/self_intersections.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "base/index.h"
#include "base/parallel.h"
#include "spatial/cluster_tree.h"
#include "spatial/exact_signs.h"

namespace littoral {

namespace {

using Triangle = std::array<Vec3, 3>;

Vec2 without(int axis, const Vec3& x) { return {x[(axis + 1) % 3], x[(axis + 2) % 3]}; }

/// An axis along which the triangle is seen with an area; -1 if it has none.
int seen_along(const Triangle& t) {
  for (int axis = 0; axis < 3; ++axis)
    if (orientation_sign(without(axis, t[0]), without(axis, t[1]), without(axis, t[2])))
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
  for (int k = 0; k < 3; ++k) c[k] = without(axis, t[k]);
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
  const Vec3 &a = t[0], &b = t[1], &c = t[2];
  const int at_u = orientation_sign(a, b, c, u), at_v = orientation_sign(a, b, c, v);
  if (at_u * at_v > 0) return false;
  if (at_u == 0 && at_v == 0) return meets_within_plane(u, v, t);
  const int ab = orientation_sign(u, v, a, b), bc = orientation_sign(u, v, b, c),
            ca = orientation_sign(u, v, c, a);
  return (ab >= 0 && bc >= 0 && ca >= 0) || (ab <= 0 && bc <= 0 && ca <= 0);
}

/// The triangle with the corners that the other one has too in front, and how many these are.
int shared_first(Triangle& t, const Triangle& other) {
  int shared = 0;
  for (int k = 0; k < 3; ++k)
    if (t[k] == other[0] || t[k] == other[1] || t[k] == other[2])
      std::rotate(t.begin() + shared++, t.begin() + k, t.begin() + k + 1);
  return shared;
}

/// Seen along an axis, does a line through two corners of s part the triangles, but for corners on
/// the line that both have? So it is where a surface is nearly flat, where signs in space are zero
/// or cost most.
bool parted_by(const Triangle& s, const Triangle& t, int axis) {
  for (int k = 0; k < 3; ++k) {
    const Vec3 &from = s[k], &to = s[(k + 1) % 3];
    const Vec2 a = without(axis, from), b = without(axis, to);
    const int own = orientation_sign(a, b, without(axis, s[(k + 2) % 3]));
    if (own != 0 && std::all_of(t.begin(), t.end(), [&](const Vec3& x) {
          return x == from || x == to || orientation_sign(a, b, without(axis, x)) == -own;
        }))
      return true;
  }
  return false;
}

struct Bounds {
  Vec3 low = Vec3::Constant(infinity), high = -low;
  void include(const Bounds& b) {
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], b.low[axis]);
      high[axis] = std::max(high[axis], b.high[axis]);
    }
  }
  bool overlaps(const Bounds& b) const {
    return (low.array() <= b.high.array()).all() && (b.low.array() <= high.array()).all();
  }
};

Bounds bounds_of(const Triangle& t) {
  Bounds out;
  for (const Vec3& corner : t) out.include({corner, corner});
  return out;
}

/// Do the boxes of triangles whose boxes overlap say that they have nothing but a corner in common?
/// Faces around a vertex, or on both sides of the rim of a fan, are mostly told apart so.
bool parted_by_boxes(const Triangle& s, const Triangle& t) {
  const Bounds in_s = bounds_of(s), in_t = bounds_of(t);
  for (int axis = 0; axis < 3; ++axis) {  // where they touch in a plane: only corners there count
    if (in_s.high[axis] != in_t.low[axis] && in_t.high[axis] != in_s.low[axis]) continue;
    const double plane = std::max(in_s.low[axis], in_t.low[axis]);
    Bounds s_there, t_there;
    for (const Vec3& x : s)
      if (x[axis] == plane) s_there.include({x, x});
    for (const Vec3& x : t)
      if (x[axis] == plane) t_there.include({x, x});
    if (!s_there.overlaps(t_there)) return true;
  }
  // Beside one common corner they have something only if a side opposite to it reaches the other.
  int shared = 0;
  Bounds beyond_in_s, beyond_in_t;
  for (const Vec3& x : s) {
    if (x == t[0] || x == t[1] || x == t[2])
      ++shared;
    else
      beyond_in_s.include({x, x});
  }
  if (shared != 1) return false;
  for (const Vec3& x : t)
    if (!(x == s[0] || x == s[1] || x == s[2])) beyond_in_t.include({x, x});
  return !beyond_in_s.overlaps(in_t) && !beyond_in_t.overlaps(in_s);
}

/// Two triangles of some area: do they meet beyond what they share?
bool meet(Triangle s, Triangle t) {
  if (parted_by_boxes(s, t)) return false;
  int broadest = 0;
  (s[1] - s[0]).cross(s[2] - s[0]).cwiseAbs().maxCoeff(&broadest);
  if (parted_by(s, t, broadest) || parted_by(t, s, broadest)) return false;
  const Triangle as_given = s;
  const int shared = shared_first(s, t);
  shared_first(t, as_given);
  if (shared == 3) return true;
  if (shared == 2) {  // hinged: folded flat onto each other, or not at all
    if (orientation_sign(s[0], s[1], s[2], t[2]) != 0) return false;
    const int axis = seen_along(s);
    const Vec2 a = without(axis, s[0]), b = without(axis, s[1]);
    return orientation_sign(a, b, without(axis, s[2])) ==
           orientation_sign(a, b, without(axis, t[2]));
  }
  // What both have of a common line starts at the shared corner, if there is one, and ends where a
  // side opposite to it meets the other triangle.
  for (int k = shared; k < (shared == 1 ? 2 : 3); ++k) {
    const int next = (k + 1) % 3;
    if (meets(s[k], s[next], t) || meets(t[k], t[next], s)) return true;
  }
  return false;
}

/// Boxes in a tree.
class BoxTree {
 public:
  struct AnyCluster {
    bool operator()(int) const { return true; }
  };
  explicit BoxTree(std::vector<Bounds> boxes) : boxes_(std::move(boxes)) {
    MatX3 centres(index(boxes_.size()), 3);
    for (std::size_t i = 0; i < boxes_.size(); ++i)
      centres.row(index(i)) = boxes_[i].low / 2 + boxes_[i].high / 2;
    tree_ = cluster(centres, 4);
    around_.resize(tree_.clusters.size());
    for (std::size_t c = around_.size(); c-- > 0;) {  // children stand after their parents
      const Cluster& each = tree_.clusters[c];
      if (each.child < 0)
        for (int i = each.begin; i < each.end; ++i) around_[c].include(boxes_[tree_.order[i]]);
      else
        for (int k : {0, 1}) around_[c].include(around_[each.child + k]);
    }
  }
  const Bounds& box(int i) const { return boxes_[i]; }
  /// Neighbours in space stand near each other.
  const std::vector<int>& order() const { return tree_.order; }

  const ClusterTree& tree() const { return tree_; }
  const Bounds& around(int cluster) const { return around_[cluster]; }

  /// True if `is_wanted` is for any of the boxes that a box overlaps. Clusters that `may_hold` says
  /// no to are passed over.
  template <class Wanted, class May = AnyCluster>
  bool any_overlaps(const Bounds& box, const Wanted& is_wanted, const May& may_hold = {}) const {
    std::vector<int> open{0};
    while (!open.empty()) {
      const int at = open.back();
      const Cluster& each = tree_.clusters[at];
      open.pop_back();
      if (!around_[at].overlaps(box) || !may_hold(at)) continue;
      if (each.child >= 0) {
        open.push_back(each.child);
        open.push_back(each.child + 1);
        continue;
      }
      for (int k = each.begin; k < each.end; ++k)
        if (boxes_[tree_.order[k]].overlaps(box) && is_wanted(tree_.order[k])) return true;
    }
    return false;
  }

 private:
  std::vector<Bounds> boxes_;
  ClusterTree tree_;
  std::vector<Bounds> around_;
};

Triangle triangle(const MatX3& points, const MatX3i& faces, Eigen::Index f) {
  return {points.row(faces(f, 0)), points.row(faces(f, 1)), points.row(faces(f, 2))};
}

/// Clusters of triangles that all have one corner. The boxes of such triangles overlap there, so
/// that boxes alone would leave all pairs of a fan to be looked at.
class Fans {
 public:
  Fans(const std::vector<Triangle>& triangles, const BoxTree& boxes)
      : boxes_(boxes), fan_of_(boxes.tree().clusters.size(), -1) {
    const ClusterTree& tree = boxes.tree();
    for (std::size_t c = fan_of_.size(); c-- > 0;) {
      const Cluster& each = tree.clusters[c];
      if (each.end - each.begin < least) continue;
      if (each.child >= 0 && tree.clusters[each.child].end - each.begin >= least &&
          fan_of_[each.child] < 0)
        continue;  // part of it has no such corner
      for (const Vec3& corner : triangles[tree.order[each.begin]]) {
        Fan fan{corner, {}};
        int k = each.begin;
        while (k < each.end && add(triangles[tree.order[k]], fan)) ++k;
        if (k < each.end) continue;
        fan_of_[c] = static_cast<int>(fans_.size());
        fans_.push_back(fan);
        break;
      }
    }
  }

  /// May a triangle meet one of a cluster elsewhere than at what both have? Not if both have a
  /// corner, and neither the side opposite to it reaches the other: what they have of a common line
  /// starts at the corner and ends on one of these sides. Nor if the cluster lies on one side of
  /// the triangle's plane, as does most of a fan that shares its rim with the triangle's.
  bool may_meet(const Triangle& t, const Bounds& box, int cluster) const {
    if (fan_of_[cluster] < 0) return true;
    const Fan& fan = fans_[fan_of_[cluster]];
    Fan own{fan.corner, {}};
    if (!add(t, own)) return may_reach(t, box, cluster);
    return fan.rim.overlaps(box) || own.rim.overlaps(boxes_.around(cluster));
  }

 private:
  // Triangles: smaller fans are not worth the place, or the time to look for planes.
  static constexpr int least = 9, worth_planes = 100;
  struct Fan {
    Vec3 corner;
    Bounds rim;  // of the sides opposite to it
  };
  static bool add(const Triangle& t, Fan& fan) {
    bool has = false;
    for (const Vec3& x : t)
      if (x == fan.corner)
        has = true;
      else
        fan.rim.include({x, x});
    return has;
  }

  /// May a fan reach t? It lies in the hull of its corner and its rim's box. If that is on one side
  /// of t's plane and its corner is off it, only the box can touch the plane.
  bool may_reach(const Triangle& t, const Bounds& box, int cluster) const {
    const Fan& fan = fans_[fan_of_[cluster]];
    std::array<Vec3, 8> rim;
    for (int c = 0; c < 8; ++c)
      for (int a = 0; a < 3; ++a) rim[c][a] = (c >> a & 1) == 0 ? fan.rim.low[a] : fan.rim.high[a];
    const int of_corner = orientation_sign(t[0], t[1], t[2], fan.corner);
    const Sides of_rim = sides(t, rim);
    if (of_corner != 0 && !(of_corner > 0 ? of_rim.below : of_rim.above))
      return of_rim.on && fan.rim.overlaps(box);
    if (const Cluster& each = boxes_.tree().clusters[cluster]; each.end - each.begin < worth_planes)
      return true;
    // Planes through the corner and an edge of the box, with the box on one side.
    for (int c = 0; c < 8; ++c)
      for (int a = 0; a < 3; ++a) {
        if ((c >> a & 1) != 0) continue;
        const Triangle plane{fan.corner, rim[c], rim[c | 1 << a]};
        const Sides of_t = sides(plane, t);
        if (of_t.on || of_t.above == of_t.below) continue;
        const Sides of_box = sides(plane, rim);
        if (of_box.above != of_box.below && of_box.above != of_t.above) return false;
      }
    return true;
  }

  /// Where points lie: on the plane of a triangle, on the side from which it is counter-clockwise,
  /// on the other.
  struct Sides {
    bool on = false, above = false, below = false;
  };
  template <std::size_t n>
  static Sides sides(const Triangle& plane, const std::array<Vec3, n>& points) {
    Sides out;
    for (const Vec3& x : points) {
      const int side = orientation_sign(plane[0], plane[1], plane[2], x);
      (side == 0 ? out.on : side > 0 ? out.above : out.below) = true;
    }
    return out;
  }

  const BoxTree& boxes_;
  std::vector<int> fan_of_;  // cluster -> its fan, -1: none
  std::vector<Fan> fans_;
};

/// Marks faces whose boxes overlap those of faces that are asked for.
std::vector<char> near_asked(const MatX3& points, const MatX3i& faces,
                             const std::vector<char>& asked) {
  std::vector<Bounds> boxes;
  for (Eigen::Index f = 0; f < faces.rows(); ++f)
    if (const Triangle t = triangle(points, faces, f);
        asked[f] && t[0].allFinite() && t[1].allFinite() && t[2].allFinite())
      boxes.push_back(bounds_of(t));
  std::vector<char> out(asked.size(), 0);
  if (boxes.empty()) return out;
  const BoxTree tree(std::move(boxes));
  parallel_for(asked.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f)
      out[f] =
          tree.any_overlaps(bounds_of(triangle(points, faces, index(f))), [](int) { return true; });
  });
  return out;
}

}  // namespace

std::vector<char> self_intersecting_faces(const MatX3& points, const MatX3i& faces,
                                          const Task& task, const std::vector<char>& asked) {
  std::vector<char> out(std::size_t(faces.rows()), 0);
  const std::vector<char> near =
      asked.empty() ? std::vector<char>(out.size(), 1) : near_asked(points, faces, asked);
  std::vector<int> number;  // of a triangle that counts -> its face
  std::vector<Triangle> triangles;
  std::vector<Bounds> boxes;
  for (Eigen::Index f = 0; f < faces.rows(); ++f) {
    if (!near[f]) continue;
    const Triangle t = triangle(points, faces, f);
    if (!(t[0].allFinite() && t[1].allFinite() && t[2].allFinite()) || seen_along(t) < 0) continue;
    triangles.push_back(t);
    boxes.push_back(bounds_of(t));
    number.push_back(static_cast<int>(f));
  }
  if (triangles.empty()) return out;

  const std::size_t n = triangles.size();
  const BoxTree tree(std::move(boxes));
  const Fans fans(triangles, tree);
  parallel_for(n, 256, [&](std::size_t begin, std::size_t end) {
    task.checkpoint(static_cast<double>(begin) / static_cast<double>(n));
    for (std::size_t k = begin; k < end; ++k) {
      const int i = tree.order()[k];
      if (!asked.empty() && !asked[number[i]]) continue;
      out[number[i]] = tree.any_overlaps(
          tree.box(i), [&](int j) { return j != i && meet(triangles[i], triangles[j]); },
          [&](int c) { return fans.may_meet(triangles[i], tree.box(i), c); });
    }
  });
  return out;
}

}  // namespace littoral
