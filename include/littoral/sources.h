#pragma once
// What distance on a surface is measured from.

#include <string>
#include <utility>
#include <vector>

#include "littoral/surface_point.h"
#include "littoral/types.h"

namespace littoral {

/// One curve on a surface: nodes in the direction of travel. Consecutive nodes need not share a
/// face (the gap is traced across the surface). A closed curve repeats its first node at the end.
struct Curve {
  std::vector<SurfacePoint> nodes;
  bool is_signed = true;  // signed: phi > 0 to the left of travel; unsigned: distance to both sides
  std::string origin{};   // "file:line" of its first node, for messages
  double value = 0;       // what distance is counted from along it [length]

  static Curve along_vertices(const std::vector<int>& vertices) {
    Curve curve;
    for (const int v : vertices) curve.nodes.push_back(SurfacePoint::at_vertex(v));
    return curve;
  }
  static Curve through(std::vector<SurfacePoint> nodes) { return {std::move(nodes)}; }
  /// The same without sides.
  Curve unsigned_curve() const {
    Curve curve = *this;
    curve.is_signed = false;
    return curve;
  }
  /// The same with distance counted from c.
  Curve with_value(double c) const {
    Curve curve = *this;
    curve.value = c;
    return curve;
  }
};

/// A curve in space, which is projected onto the surface by closest points.
struct SpaceCurve {
  MatX3 points{0, 3};  // nodes x 3 [length]
  bool is_signed = true;
  std::string origin{};
  double value = 0;
};

/// A dual chain: faces, neighbours in this order; a winding number is larger by one on every face
/// than on the one before it.
struct FaceChain {
  std::vector<int> faces;
  std::string origin{};
};

/// All sources of one problem, in any mixture.
///
/// Values c_i make the answer the least of c_i + d_i, d_i being the distance to source i, and on
/// the negative sides of signed curves the largest of c_i - d_i. It is c_i at source i if no two
/// differ by more than their sources are apart; otherwise some are shadowed, and a warning says so.
struct Sources {
  std::vector<Curve> curves;
  std::vector<SurfacePoint> points;  // unsigned isolated points
  std::vector<double> point_values;  // of the first points; those beyond have 0
  std::vector<SpaceCurve> space_curves;
  std::vector<FaceChain> chains;  // for winding numbers only

  Sources() = default;
  /// One point.
  explicit Sources(const SurfacePoint& point) : points{point} {}

  bool empty() const {
    return curves.empty() && points.empty() && space_curves.empty() && chains.empty();
  }
  Sources& add(Curve curve) {
    curves.push_back(std::move(curve));
    return *this;
  }
  Sources& add(const SurfacePoint& point, double value = 0) {
    if (value != 0) {
      point_values.resize(points.size(), 0);
      point_values.push_back(value);
    }
    points.push_back(point);
    return *this;
  }
  double point_value(std::size_t i) const { return i < point_values.size() ? point_values[i] : 0; }
  Sources& add(SpaceCurve curve) {
    space_curves.push_back(std::move(curve));
    return *this;
  }
  Sources& add(FaceChain chain) {
    chains.push_back(std::move(chain));
    return *this;
  }
  /// Those of another set, after these.
  Sources& add(const Sources& other);
  /// The same with every signed curve and every chain run backwards: the other side is positive.
  Sources reversed() const;
};

}  // namespace littoral
