#include "domain/mesh/cut_face.h"

#include <algorithm>
#include <cmath>

#include "base/index.h"

namespace littoral {

FaceTriangulation::FaceTriangulation(const Vec2& a, const Vec2& b, const Vec2& c)
    : points_{a, b, c}, triangles_{{0, 1, 2}} {}

double FaceTriangulation::turn(int a, int b, int c) const {
  const Vec2 u = points_[b] - points_[a], v = points_[c] - points_[a];
  return u.x() * v.y() - u.y() * v.x();
}

int FaceTriangulation::triangle_with(int p, int q) const {
  for (std::size_t t = 0; t < triangles_.size(); ++t)
    for (int k = 0; k < 3; ++k)
      if (triangles_[t][k] == p && triangles_[t][(k + 1) % 3] == q) return t;
  return -1;
}

bool FaceTriangulation::has_edge(int p, int q) const {
  return triangle_with(p, q) >= 0 || triangle_with(q, p) >= 0;
}

bool FaceTriangulation::is_fixed(int p, int q) const {
  return std::any_of(fixed_.begin(), fixed_.end(), [&](const FixedEdge& h) {
    return (h.p == p && h.q == q) || (h.p == q && h.q == p);
  });
}

void FaceTriangulation::fix(int p, int q, int segment) {
  if (!is_fixed(p, q)) fixed_.push_back({p, q});
  paths_[segment].push_back(q);
}

int FaceTriangulation::split_edge(int p, int q, const Vec2& x) {
  const int added = points_.size();
  points_.push_back(x);
  for (const auto& [a, b] : {std::pair(p, q), std::pair(q, p)}) {
    const int t = triangle_with(a, b);
    if (t < 0) continue;
    auto other = triangles_[t];
    for (int k = 0; k < 3; ++k) {
      if (triangles_[t][k] == b) triangles_[t][k] = added;
      if (other[k] == a) other[k] = added;
    }
    triangles_.push_back(other);
  }
  if (is_fixed(p, q)) {
    std::erase_if(fixed_, [&](const FixedEdge& h) {
      return (h.p == p && h.q == q) || (h.p == q && h.q == p);
    });
    fixed_.push_back({p, added});
    fixed_.push_back({added, q});
    for (auto& path : paths_)
      for (std::size_t i = 0; i + 1 < path.size(); ++i)
        if ((path[i] == p && path[i + 1] == q) || (path[i] == q && path[i + 1] == p)) {
          path.insert(path.begin() + i + 1, added);
          break;
        }
  }
  return added;
}

int FaceTriangulation::split_side(int p, int q, const Vec2& x) { return split_edge(p, q, x); }

int FaceTriangulation::insert(const Vec2& x, double tolerance) {
  int nearest = 0;
  for (std::size_t i = 1; i < points_.size(); ++i)
    if ((points_[i] - x).norm() < (points_[nearest] - x).norm()) nearest = i;
  if ((points_[nearest] - x).norm() <= tolerance) return nearest;
  // The triangle in which the least barycentric coordinate is largest holds the point.
  int best = 0, side = 0;
  double most = -infinity;
  points_.push_back(x);
  const int added = int_size(points_) - 1;
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    double least = infinity;
    int at = 0;
    for (int k = 0; k < 3; ++k) {
      const int p = triangles_[t][k], q = triangles_[t][(k + 1) % 3];
      const double height = turn(p, q, added) / (points_[q] - points_[p]).norm();
      if (height < least) {
        least = height;
        at = k;
      }
    }
    if (least > most) {
      most = least;
      best = t;
      side = at;
    }
  }
  const auto [a, b, c] = triangles_[best];
  if (most <= tolerance) {  // on an edge
    points_.pop_back();
    return split_edge(triangles_[best][side], triangles_[best][(side + 1) % 3], x);
  }
  triangles_[best] = {a, b, added};
  triangles_.push_back({b, c, added});
  triangles_.push_back({c, a, added});
  return added;
}

bool FaceTriangulation::flip(int p, int q) {
  const int s = triangle_with(p, q), t = triangle_with(q, p);
  if (s < 0 || t < 0) return false;
  const auto apex = [&](int triangle) {
    for (int v : triangles_[triangle])
      if (v != p && v != q) return v;
    return -1;
  };
  const int a = apex(s), d = apex(t);
  if (!(turn(a, p, d) > 0) || !(turn(d, q, a) > 0)) return false;
  // Not into a needle: the new triangles keep a share of the old ones' area.
  const double whole = turn(p, q, a) + turn(q, p, d);
  if (turn(a, p, d) < 1e-9 * whole || turn(d, q, a) < 1e-9 * whole) return false;
  triangles_[s] = {a, p, d};
  triangles_[t] = {d, q, a};
  return true;
}

void FaceTriangulation::connect(int a, int b, int segment) {
  if (int_size(paths_) <= segment) paths_.resize(segment + 1);
  paths_[segment].assign(1, a);
  const double length = (points_[b] - points_[a]).norm();
  // Every turn holds an edge or removes a crossing; the bound stops what round-off could not.
  for (int guard = 0; a != b && guard < 10000; ++guard) {
    if (has_edge(a, b)) {
      fix(a, b, segment);
      return;
    }
    const Vec2 direction = (points_[b] - points_[a]) / (points_[b] - points_[a]).norm();
    int p = -1, q = -1, through = -1;
    for (const auto& triangle : triangles_) {
      for (int k = 0; k < 3; ++k) {
        if (triangle[k] != a) continue;
        const int r = triangle[(k + 1) % 3], l = triangle[(k + 2) % 3];
        for (const int v : {r, l}) {
          const Vec2 d = points_[v] - points_[a];
          const double off = direction.x() * d.y() - direction.y() * d.x();
          if (std::abs(off) <= 1e-12 * length && d.dot(direction) > 0) through = v;
        }
        if (turn(a, b, r) < 0 && turn(a, b, l) > 0) {
          p = r;
          q = l;
        }
      }
    }
    if (through >= 0) {
      fix(a, through, segment);
      a = through;
      continue;
    }
    if (p < 0) return;  // cannot be: the segment lies in the face
    if (!is_fixed(p, q) && flip(p, q)) continue;
    const double left = turn(a, b, q), right = -turn(a, b, p);
    const double share = right / (left + right);
    const int x = split_edge(p, q, points_[p] + share * (points_[q] - points_[p]));
    fix(a, x, segment);
    a = x;
  }
}

}  // namespace littoral
