#include "operators/curved_hessian.h"

#include <cmath>
#include <numbers>

namespace littoral {

namespace {

constexpr double without_area = 2e-6;  // a + b - c over the longest side

/// The connection Laplacian as real 2 x 2 blocks, both triangles.
SpMat real_laplacian(const VectorDiffusion& V) {
  if (!V.complex_linear()) return V.L_real({}).selfadjointView<Eigen::Lower>();
  const SpMatC connection = V.L({});
  Triplets entries;
  entries.reserve(connection.nonZeros() * 8);
  for (int j = 0; j < connection.outerSize(); ++j)
    for (SpMatC::InnerIterator it(connection, j); it; ++it) {
      const int i = it.row();
      const double a = it.value().real(), b = it.value().imag();
      auto put = [&](int row, int col, double re, double im) {
        entries.emplace_back(2 * row, 2 * col, re);
        entries.emplace_back(2 * row + 1, 2 * col + 1, re);
        entries.emplace_back(2 * row, 2 * col + 1, -im);
        entries.emplace_back(2 * row + 1, 2 * col, im);
      };
      put(i, j, a, i == j ? 0 : b);
      if (i != j) put(j, i, a, -b);
    }
  SpMat L(2 * V.n, 2 * V.n);
  L.setFromTriplets(entries.begin(), entries.end());
  return L;
}

/// Integral of kappa |X|^2: each interior vertex's angle defect is shared out to its corners by
/// angle; there X is the value of the Crouzeix-Raviart field, the sum over its edges with signs
/// +, +, - (opposite). Vertices of triangles without area are left out.
SpMat curvature(const IntrinsicTriangulation& T) {
  VecX defect = VecX::Constant(T.n_vertices, 2 * std::numbers::pi),
       total = VecX::Zero(defect.size());
  for (int e = 0; e < T.n_edges(); ++e)
    if (T.edge_use[e] != 2) defect[T.edges(e, 0)] = defect[T.edges(e, 1)] = 0;
  std::vector<char> inside(T.n_vertices, 1);
  for (int v = 0; v < T.n_vertices; ++v) inside[v] = defect[v] > 0;
  // A triangle without area has angles of no meaning, and may end the definiteness.
  for (int f = 0; f < T.n_faces(); ++f) {
    const auto sides = T.length.row(f);
    const double slack = sides.sum() - 2 * sides.maxCoeff();
    for (int k = 0; k < 3 && slack < without_area * sides.maxCoeff(); ++k)
      inside[T.faces(f, k)] = 0;
  }
  auto angle = [](const TriangleShape& t, int k) { return std::atan2(1.0, t.cot[k]); };
  for (int f = 0; f < T.n_faces(); ++f) {
    const TriangleShape t = T.shape(f);
    for (int k = 0; k < 3; ++k) total[T.faces(f, k)] += angle(t, k);
  }
  for (int v = 0; v < T.n_vertices; ++v) defect[v] = inside[v] ? defect[v] - total[v] : 0;
  Triplets entries;
  for (int f = 0; f < T.n_faces(); ++f) {
    const TriangleShape t = T.shape(f);
    for (int c = 0; c < 3; ++c) {
      const int v = T.faces(f, c);
      if (!inside[v] || !(total[v] > 0)) continue;
      const double weight = defect[v] * angle(t, c) / total[v];
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < 3; ++l) {
          const double sign = (k == (c + 1) % 3) == (l == (c + 1) % 3) ? 1 : -1;
          // Re(conj(X_k) X_l) with both in the face's frame.
          const Complex r =
              weight * sign * std::conj(T.edge_in_face(t, f, k)) * T.edge_in_face(t, f, l);
          const double s = T.seam(f, k) ? -1 : 1, q = T.seam(f, l) ? -1 : 1;
          const int row = 2 * T.side_edge(f, k), col = 2 * T.side_edge(f, l);
          entries.emplace_back(row, col, r.real());
          entries.emplace_back(row, col + 1, -r.imag() * q);
          entries.emplace_back(row + 1, col, s * r.imag());
          entries.emplace_back(row + 1, col + 1, s * r.real() * q);
        }
    }
  }
  SpMat K(2 * T.n_edges(), 2 * T.n_edges());
  K.setFromTriplets(entries.begin(), entries.end());
  return K;
}

/// du on the edges (2 edges x vertices): the mean of the gradients beside an edge, by area.
SpMat edge_gradient(const IntrinsicTriangulation& T, const VecX& mass) {
  Triplets entries;
  entries.reserve(std::size_t(T.n_faces()) * 18);
  for (int f = 0; f < T.n_faces(); ++f) {
    const TriangleShape t = T.shape(f);
    for (int k = 0; k < 3; ++k)
      for (int c = 0; c < 3; ++c) {
        const Complex hat =
            Complex(0, T.orientation[f]) * (t.p[(c + 2) % 3] - t.p[(c + 1) % 3]) / (2 * t.area);
        const int e = T.side_edge(f, k);
        const Complex z = t.area / 3 / mass[e] * T.face_to_edge(t, f, k, hat);
        entries.emplace_back(2 * e, T.faces(f, c), z.real());
        entries.emplace_back(2 * e + 1, T.faces(f, c), z.imag());
      }
  }
  SpMat X(2 * T.n_edges(), T.n_vertices);
  X.setFromTriplets(entries.begin(), entries.end());
  return X;
}

}  // namespace

SpMat curved_hessian(const IntrinsicTriangulation& T, const VectorDiffusion& vector) {
  const SpMat X = edge_gradient(T, vector.M);
  const SpMat inner = real_laplacian(vector) + curvature(T);
  const SpMat W = SpMat(X.transpose()) * SpMat(inner * X);
  return W.triangularView<Eigen::Lower>();
}

}  // namespace littoral
