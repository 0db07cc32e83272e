#pragma once
// The conic program of one component (quadratic-order geodesics, eq. 4), in units in which the
// component measures 1.

#include <map>
#include <vector>

#include "operators/p2.h"
#include "solve/optimization/paraboloid_program.h"
#include "sources/surface/p2_sources.h"

namespace littoral {

/// One component's elements and nodes, numbered by themselves.
template <int D>
struct QuadraticPart {
  std::vector<int> elements;                                   // of all elements
  std::vector<int> nodes;                                      // of all nodes
  std::vector<std::array<int, P2Shape<D>::nodes>> local_node;  // elements x nodes
  double scale = 1;                                            // measure^(1/D)
  double h = 0;                                                // mean edge length
};

/// The elements of each component (components).
template <int D>
std::vector<QuadraticPart<D>> quadratic_parts(const P2Elements<D>& E);

/// The program of a component, where to start, and where to add samples. Lengths are divided by
/// part.scale.
///
/// No quadratic is near the distance to two points in one triangle: one that vanishes at both
/// vanishes between them and beyond. So in triangles that hold several points, or a point beside a
/// curve, u is held at the nodes alone, below the squares of the distances in the triangle.
/// Vertices of tets that share a tet are taken for the edges and faces between them.
template <int D>
class QuadraticProgram {
 public:
  static constexpr int K = P2Shape<D>::nodes;
  using Program = ParaboloidProgram<K, D>;

  /// `radius` is the distance allowed at a source, in units of E. Sources outside the part are
  /// ignored.
  QuadraticProgram(const P2Elements<D>& E, const QuadraticPart<D>& part,
                   const std::vector<P2Source<D>>& sources, double radius);

  bool has_source() const { return !program_.caps.empty(); }
  const Program& program() const { return program_; }

  /// 0.6 times the square of the distance along edges (nodes of the part).
  VecX start() const;

  /// Samples where u - |grad u|^2 / 4, which is quadratic on each element, dips below zero between
  /// the given ones by more than `allowed` times u: the lowest point and a lattice. Elements that
  /// hold a source on a curve or several points are left out: there u may cross zero.
  std::vector<typename Program::Inserted> violated(const VecX& u, double allowed) const;

 private:
  /// The size of u expected at a point of a local element.
  double size(int local, const typename P2Shape<D>::Point& b) const;
  using PointsInside = std::map<int, std::vector<typename P2Shape<D>::Point>>;  // local elements
  void find_crowded(const PointsInside& inside, double radius);
  void add_samples(const std::vector<P2Source<D>>& sources, const PointsInside& inside);
  int local(int element) const;  // -1: of another part
  double cap(double distance, double radius) const;

  const P2Elements<D>& E_;
  const QuadraticPart<D>& part_;
  Program program_;
  VecX d_;                          // vertices of the part first seen; nodes: distance along edges
  bool alone_ = false;              // one source
  std::vector<char> curve_inside_;  // local elements
  std::vector<char> crowded_;       // local elements: several points inside
};

/// The smallest value of the quadratic with the given nodal values on a simplex, and where.
template <int D>
std::pair<double, typename P2Shape<D>::Point> p2_minimum(const typename P2Shape<D>::Values& s);

extern template class QuadraticProgram<2>;
extern template class QuadraticProgram<3>;

}  // namespace littoral
