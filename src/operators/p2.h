#pragma once
// Piecewise quadratic functions on triangles and tetrahedra: nodes at vertices and edge midpoints.

#include <array>
#include <span>
#include <vector>

#include "domain/intrinsic/intrinsic_triangulation.h"
#include "littoral/types.h"
#include "operators/calculus.h"

namespace littoral {

/// Local numbering on a simplex of dimension D: corners, then edges.
template <int D>
struct P2Shape {
  static constexpr int corners = D + 1;
  static constexpr int edges = D * (D + 1) / 2;
  static constexpr int nodes = corners + edges;
  using Point = Eigen::Matrix<double, corners, 1>;      // barycentrics
  using Values = Eigen::Matrix<double, nodes, 1>;       // one number per local node
  using Slopes = std::array<Values, D>;                 // one vector per local node
  using Gradients = Eigen::Matrix<double, D, corners>;  // of the barycentrics
  using Sides = Eigen::Matrix<double, edges, 1>;        // one number per local edge

  /// End corners of local edge k: a triangle's edge k is its side k (corner k to k + 1), a
  /// tetrahedron's are 01, 02, 03, 12, 13, 23.
  static std::array<int, 2> edge(int k);

  static Point corner(int i) { return Point::Unit(i); }
  static Point middle(int k) { return 0.5 * (corner(edge(k)[0]) + corner(edge(k)[1])); }
  static Point centre() { return Point::Constant(1.0 / corners); }

  /// The basis functions at a point: lambda_i (2 lambda_i - 1) at corners, 4 lambda_i lambda_j at
  /// edges (quadratic-order geodesics, appendix B).
  static Values values(const Point& b);
  /// Their gradients, given those of the barycentrics.
  static Slopes slopes(const Point& b, const Gradients& grad);
};

/// The elements of one domain, without coordinates: any topology, several components.
template <int D>
struct P2Elements {
  using Shape = P2Shape<D>;
  static constexpr int dimension = D;

  double unit = 1;  // [length] of one unit in the input's coordinates
  int n_vertices = 0;
  int n_edges = 0;                                  // node of edge e: n_vertices + e
  std::vector<std::array<int, Shape::nodes>> node;  // elements
  std::vector<typename Shape::Gradients> grad;      // elements; in the element's own frame
  VecX measure;                                     // elements [length^D]
  std::vector<typename Shape::Sides> side;          // elements; lengths of their edges
  double h = 0;                                     // mean edge length
  VecX component_h;                                 // components; the same of each
  std::vector<int> component;                       // vertices; -1 without an element
  int n_components = 0;
  int mollified = 0;  // elements whose edges were lengthened

  int n_nodes() const { return n_vertices + n_edges; }
  int n_elements() const { return node.size(); }

  typename Shape::Values gather(const VecX& u, int element) const;
  /// u at a point of an element.
  double value(const VecX& u, int element, const typename Shape::Point& b) const;
  /// Gradient of u there, in the element's frame.
  Eigen::Matrix<double, D, 1> gradient(const VecX& u, int element,
                                       const typename Shape::Point& b) const;

  VecX integral() const;  // nodes; integrals of the basis functions
  SpMat mass() const;     // nodes x nodes; integrals of products of two basis functions
};

/// Mean length of the edges of each component (components).
VecX mean_edge_lengths(const IntrinsicTriangulation& T);

/// The elements of a triangle mesh; element f is triangle f. Triangles with a + b - c < 1e-6 times
/// their longest side, or 1e-8 times the component's mean if that is more, get their own sides
/// lengthened until it is that (Sharp & Crane 2020, section 4.5, for each by itself), so that
/// slivers have a bounded effect and no other triangle is moved.
P2Elements<2> p2_elements(const IntrinsicTriangulation& T);

/// A point of an element.
template <int D>
struct P2Point {
  int element = 0;
  typename P2Shape<D>::Point b;
};

/// Rows of values at points (points x nodes).
template <int D>
SpMat p2_interpolation(const P2Elements<D>& E, std::span<const P2Point<D>> points);

/// Values of u at points.
template <int D>
VecX p2_values(const P2Elements<D>& E, const VecX& u, std::span<const P2Point<D>> points);

/// The same functions as a calculus of nodes and cells, for methods that know no elements. Cells
/// are the three edge midpoints of each triangle with a third of its area each: a quadrature exact
/// for quadratics, so G^T A G = L exactly. M is the lumped mass of the triangles quartered through
/// their edge midpoints (all entries positive); h is half the mean edge length. E is copied.
Calculus p2_calculus(const P2Elements<2>& E);

extern template struct P2Shape<2>;
extern template struct P2Shape<3>;
extern template struct P2Elements<2>;
extern template struct P2Elements<3>;

}  // namespace littoral
