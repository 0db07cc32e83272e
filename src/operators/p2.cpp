#include "operators/p2.h"

#include <algorithm>
#include <cmath>

namespace littoral {

template <int D>
std::array<int, 2> P2Shape<D>::edge(int k) {
  if constexpr (D == 2) return {k, (k + 1) % 3};
  constexpr std::array<std::array<int, 2>, 6> ends{
      {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};
  return ends[k];
}

template <int D>
typename P2Shape<D>::Values P2Shape<D>::values(const Point& b) {
  Values q;
  for (int i = 0; i < corners; ++i) q[i] = b[i] * (2 * b[i] - 1);
  for (int k = 0; k < edges; ++k) q[corners + k] = 4 * b[edge(k)[0]] * b[edge(k)[1]];
  return q;
}

template <int D>
typename P2Shape<D>::Slopes P2Shape<D>::slopes(const Point& b, const Gradients& grad) {
  Slopes g;
  for (int d = 0; d < D; ++d) {
    for (int i = 0; i < corners; ++i) g[d][i] = (4 * b[i] - 1) * grad(d, i);
    for (int k = 0; k < edges; ++k) {
      const auto [i, j] = edge(k);
      g[d][corners + k] = 4 * (b[i] * grad(d, j) + b[j] * grad(d, i));
    }
  }
  return g;
}

template <int D>
typename P2Shape<D>::Values P2Elements<D>::gather(const VecX& u, int element) const {
  typename Shape::Values local;
  for (int i = 0; i < Shape::nodes; ++i) local[i] = u[node[element][i]];
  return local;
}

template <int D>
double P2Elements<D>::value(const VecX& u, int element, const typename Shape::Point& b) const {
  return Shape::values(b).dot(gather(u, element));
}

template <int D>
Eigen::Matrix<double, D, 1> P2Elements<D>::gradient(const VecX& u, int element,
                                                    const typename Shape::Point& b) const {
  const auto slopes = Shape::slopes(b, grad[element]);
  const auto local = gather(u, element);
  Eigen::Matrix<double, D, 1> g;
  for (int d = 0; d < D; ++d) g[d] = slopes[d].dot(local);
  return g;
}

template <int D>
VecX P2Elements<D>::integral() const {
  // Triangle: 0 at corners, 1/3 at edges. Tetrahedron: -1/20 at corners, 1/5 at edges.
  constexpr double at_edge = D == 2 ? 1.0 / 3 : 1.0 / 5;
  constexpr double at_corner = (1 - Shape::edges * at_edge) / Shape::corners;
  VecX c = VecX::Zero(n_nodes());
  for (int e = 0; e < n_elements(); ++e)
    for (int i = 0; i < Shape::nodes; ++i) {
      if (D == 2 && i < Shape::corners) continue;  // exactly 0
      c[node[e][i]] += measure[e] * (i < Shape::corners ? at_corner : at_edge);
    }
  return c;
}

namespace {

/// Integral of lambda^a over a unit simplex of dimension D, divided by its measure: a! D! / (|a| +
/// D)!.
template <int D>
double monomial(const std::array<int, D + 1>& a) {
  double value = 1;
  int total = D;
  for (int k = 2; k <= D; ++k) value *= k;
  for (int power : a) {
    total += power;
    for (int k = 2; k <= power; ++k) value *= k;
  }
  for (int k = 2; k <= total; ++k) value /= k;
  return value;
}

/// A basis function as a sum of coefficient times lambda^a.
template <int D>
std::vector<std::pair<double, std::array<int, D + 1>>> monomials(int node) {
  using Shape = P2Shape<D>;
  std::array<int, D + 1> linear{}, quadratic{};
  if (node < Shape::corners) {
    linear[node] = 1;
    quadratic[node] = 2;
    return {{2, quadratic}, {-1, linear}};
  }
  for (int end : Shape::edge(node - Shape::corners)) ++quadratic[end];
  return {{4, quadratic}};
}

/// Integrals of products of basis functions over a simplex of measure 1.
template <int D>
Eigen::Matrix<double, P2Shape<D>::nodes, P2Shape<D>::nodes> unit_mass() {
  constexpr int n = P2Shape<D>::nodes;
  Eigen::Matrix<double, n, n> M = Eigen::Matrix<double, n, n>::Zero();
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (const auto& [p, a] : monomials<D>(i))
        for (const auto& [q, b] : monomials<D>(j)) {
          std::array<int, D + 1> sum{};
          for (int k = 0; k <= D; ++k) sum[k] = a[k] + b[k];
          M(i, j) += p * q * monomial<D>(sum);
        }
  return M;
}

}  // namespace

template <int D>
SpMat P2Elements<D>::mass() const {
  const auto unit_matrix = unit_mass<D>();
  Triplets entries;
  entries.reserve(node.size() * Shape::nodes * Shape::nodes);
  for (int e = 0; e < n_elements(); ++e)
    for (int i = 0; i < Shape::nodes; ++i)
      for (int j = 0; j < Shape::nodes; ++j)
        entries.emplace_back(node[e][i], node[e][j], measure[e] * unit_matrix(i, j));
  SpMat M(n_nodes(), n_nodes());
  M.setFromTriplets(entries.begin(), entries.end());
  return M;
}

VecX mean_edge_lengths(const IntrinsicTriangulation& T) {
  VecX length = VecX::Constant(T.n_edges(), -1);
  for (int f = 0; f < T.n_faces(); ++f)
    for (int k = 0; k < 3; ++k) length[T.side_edge(f, k)] = T.length(f, k);
  VecX sum = VecX::Zero(T.n_components), count = sum;
  for (int e = 0; e < T.n_edges(); ++e) {
    if (length[e] < 0) continue;
    sum[T.component[T.edges(e, 0)]] += length[e];
    ++count[T.component[T.edges(e, 0)]];
  }
  return sum.cwiseQuotient(count);
}

P2Elements<2> p2_elements(const IntrinsicTriangulation& T) {
  P2Elements<2> E;
  E.unit = T.unit;
  E.n_vertices = T.n_vertices;
  E.n_edges = T.n_edges();
  E.h = T.mean_edge_length;
  E.component_h = mean_edge_lengths(T);
  E.component = T.component;
  E.n_components = T.n_components;
  E.measure.resize(T.n_faces());
  E.node.resize(T.n_faces());
  E.grad.resize(E.node.size());
  E.side.resize(E.node.size());
  for (int f = 0; f < T.n_faces(); ++f) {
    Eigen::Vector3d& l = E.side[f] = T.length.row(f);
    const double h = E.component_h[T.component[T.faces(f, 0)]], longest = l.maxCoeff();
    const double margin = 1e-6 * std::max(longest, 1e-2 * h);
    const double slack = l.sum() - 2 * longest;  // of the triangle inequality
    if (slack < margin) {
      l.array() += margin - slack;
      ++E.mollified;
    }
    const TriangleShape t = triangle_shape(l[0], l[1], l[2], T.orientation[f] < 0);
    E.measure[f] = t.area;
    const double side = T.orientation[f] < 0 ? -1 : 1;
    for (int i = 0; i < 3; ++i) {
      // The opposite side, turned towards the corner, over twice the area.
      const Complex opposite = t.p[(i + 2) % 3] - t.p[(i + 1) % 3];
      const Complex g = Complex(0, side) * opposite / (2 * t.area);
      E.grad[f].col(i) << g.real(), g.imag();
      E.node[f][i] = T.faces(f, i);
      E.node[f][3 + i] = T.n_vertices + T.side_edge(f, i);
    }
  }
  return E;
}

template <int D>
SpMat p2_interpolation(const P2Elements<D>& E, std::span<const P2Point<D>> points) {
  Triplets entries;
  for (std::size_t r = 0; r < points.size(); ++r) {
    const auto q = P2Shape<D>::values(points[r].b);
    for (int i = 0; i < P2Shape<D>::nodes; ++i)
      if (q[i] != 0) entries.emplace_back(r, E.node[points[r].element][i], q[i]);
  }
  SpMat B(points.size(), E.n_nodes());
  B.setFromTriplets(entries.begin(), entries.end());
  return B;
}

template <int D>
VecX p2_values(const P2Elements<D>& E, const VecX& u, std::span<const P2Point<D>> points) {
  VecX values(points.size());
  for (std::size_t r = 0; r < points.size(); ++r)
    values[r] = E.value(u, points[r].element, points[r].b);
  return values;
}

template struct P2Shape<2>;
template struct P2Shape<3>;
template struct P2Elements<2>;
template struct P2Elements<3>;
template SpMat p2_interpolation(const P2Elements<2>&, std::span<const P2Point<2>>);
template SpMat p2_interpolation(const P2Elements<3>&, std::span<const P2Point<3>>);
template VecX p2_values(const P2Elements<2>&, const VecX&, std::span<const P2Point<2>>);
template VecX p2_values(const P2Elements<3>&, const VecX&, std::span<const P2Point<3>>);

}  // namespace littoral
