#pragma once
// The triangulation of one face, into which points and segments are inserted.

#include <array>
#include <vector>

#include "littoral/types.h"

namespace littoral {

/// Triangles over a handful of points in the plane; small enough for plain searches.
class FaceTriangulation {
 public:
  /// The face itself: its corners, counter-clockwise, are points 0, 1 and 2.
  FaceTriangulation(const Vec2& a, const Vec2& b, const Vec2& c);

  /// Adds a point on the side from point p to point q, between which no other lies yet.
  int split_side(int p, int q, const Vec2& x);
  /// Adds a point inside, or returns the one that is there (to `tolerance`).
  int insert(const Vec2& x, double tolerance);
  /// Makes a and b ends of a chain of edges, which stay; returns its points from a to b.
  void connect(int a, int b, int segment);

  const std::vector<Vec2>& points() const { return points_; }
  const std::vector<std::array<int, 3>>& triangles() const { return triangles_; }
  /// Points of a segment that was connected, in order, with those that later ones added.
  const std::vector<int>& path(int segment) const { return paths_[segment]; }

 private:
  struct FixedEdge {
    int p, q;
  };
  double turn(int a, int b, int c) const;
  int triangle_with(int p, int q) const;  // that has the directed side p -> q, or -1
  bool has_edge(int p, int q) const;
  bool is_fixed(int p, int q) const;
  void fix(int p, int q, int segment);
  int split_edge(int p, int q, const Vec2& x);
  bool flip(int p, int q);

  std::vector<Vec2> points_;
  std::vector<std::array<int, 3>> triangles_;
  std::vector<FixedEdge> fixed_;
  std::vector<std::vector<int>> paths_;
};

}  // namespace littoral
