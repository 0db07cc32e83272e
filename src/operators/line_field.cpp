#include "operators/line_field.h"

#include <Eigen/Geometry>
#include <cmath>

#include "solve/poisson/poisson.h"

namespace littoral {

namespace {

/// Axes of a face in space: along its side 0, and to its left or right as its frame has it.
std::pair<Vec3, Vec3> axes(const SurfaceMesh& mesh, int face, int orientation) {
  const auto c = mesh.face(face);
  const Vec3 p = mesh.point(c[0]);
  const double scale = (mesh.point(c[1]) - p).cwiseAbs().maxCoeff();
  if (!(scale > 0)) return {Vec3::UnitX(), Vec3::UnitY()};
  const Vec3 x = ((mesh.point(c[1]) - p) / scale).normalized();
  const Vec3 q = (mesh.point(c[2]) - p) / scale;
  Vec3 y = q - q.dot(x) * x;
  if (!(y.norm() > 0)) y = x.unitOrthogonal();
  return {x, orientation * y.normalized()};
}

/// Re(conj(a) b)-type blocks of z -> r z between edge unknowns, through the reflections at seams.
void add_block(Triplets& out, int row, int col, Complex r, bool seam_row, bool seam_col) {
  const double s = seam_row ? -1 : 1, c = seam_col ? -1 : 1;
  out.emplace_back(2 * row, 2 * col, r.real());
  out.emplace_back(2 * row, 2 * col + 1, -r.imag() * c);
  out.emplace_back(2 * row + 1, 2 * col, s * r.imag());
  out.emplace_back(2 * row + 1, 2 * col + 1, s * r.real() * c);
}

}  // namespace

Complex tangent_part(const SurfaceMesh& mesh, const IntrinsicTriangulation& T, int mesh_face,
                     const Vec3& v) {
  const auto [x, y] = axes(mesh, mesh_face, T.orientation[T.triangle_of_face[mesh_face]]);
  return {v.dot(x), v.dot(y)};
}

MatX3 face_frames(const SurfaceMesh& mesh, const IntrinsicTriangulation& T) {
  MatX3 frames(2 * T.n_faces(), 3);
  for (int f = 0; f < mesh.n_faces(); ++f) {
    const int t = T.triangle_of_face[f];
    if (t < 0) continue;
    const auto [x, y] = axes(mesh, f, T.orientation[t]);
    frames.row(2 * t) = x;
    frames.row(2 * t + 1) = y;
  }
  return frames;
}

VecX interpolate_line_field(const IntrinsicTriangulation& T,
                            const std::vector<std::pair<int, Complex>>& directions,
                            const Task& task) {
  constexpr double grip = 1e5;    // of the given directions against smoothness
  constexpr double faint = 1e-9;  // keeps components without a direction definite
  Triplets entries;
  auto squared_edge = [&](const TriangleShape& t, int f, int k) {
    const Complex d = T.edge_in_face(t, f, k);
    return d * d;
  };
  for (int f = 0; f < T.n_faces(); ++f) {
    const TriangleShape t = T.shape(f);
    for (int k = 0; k < 3; ++k) {
      const int l = (k + 1) % 3, a = T.side_edge(f, k), b = T.side_edge(f, l);
      const bool sa = T.seam(f, k), sb = T.seam(f, l);
      const double w = 2 * t.cot[l];  // as in the connection Laplacian, with doubled angles
      const Complex r = -w * std::conj(squared_edge(t, f, k)) * squared_edge(t, f, l);
      add_block(entries, a, a, w, sa, sa);
      add_block(entries, b, b, w, sb, sb);
      add_block(entries, a, b, r, sa, sb);
      add_block(entries, b, a, std::conj(r), sb, sa);
      add_block(entries, a, a, faint, sa, sa);
    }
  }
  VecX rhs = VecX::Zero(2 * T.n_edges());
  for (const auto& [f, v] : directions) {
    const TriangleShape t = T.shape(f);
    const Complex target = v * v / std::norm(v);
    for (int k = 0; k < 3; ++k) {
      const bool sk = T.seam(f, k);
      const Complex ek = squared_edge(t, f, k), pull = grip / 3 * std::conj(ek) * target;
      rhs[2 * T.side_edge(f, k)] += pull.real();
      rhs[2 * T.side_edge(f, k) + 1] += sk ? -pull.imag() : pull.imag();
      for (int l = 0; l < 3; ++l)
        add_block(entries, T.side_edge(f, k), T.side_edge(f, l),
                  grip / 9 * std::conj(ek) * squared_edge(t, f, l), sk, T.seam(f, l));
    }
  }
  for (int e = 0; e < T.n_edges(); ++e)
    if (T.edge_use[e] == 0) add_block(entries, e, e, 1, false, false);
  SpMat K(2 * T.n_edges(), 2 * T.n_edges());
  K.setFromTriplets(entries.begin(), entries.end());
  const VecX z = DefiniteSystem(SpMat(K.triangularView<Eigen::Lower>()), task).solve(rhs);
  VecX V = VecX::Zero(2 * T.n_faces());
  for (int f = 0; f < T.n_faces(); ++f) {
    const TriangleShape t = T.shape(f);
    Complex sum = 0;
    for (int k = 0; k < 3; ++k) {
      const int e = T.side_edge(f, k);
      sum += Complex(z[2 * e], T.seam(f, k) ? -z[2 * e + 1] : z[2 * e + 1]) * squared_edge(t, f, k);
    }
    if (!(std::abs(sum) > 1e-30)) continue;
    const Complex v = std::sqrt(sum / std::abs(sum));
    V[2 * f] = v.real();
    V[2 * f + 1] = v.imag();
  }
  return V;
}

}  // namespace littoral
