#include "operators/tet_operators.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>

#include "base/counted.h"
#include "littoral/error.h"

namespace littoral {

namespace {

void check(const TetMesh& mesh) {
  for (int t = 0; t < mesh.n_tets(); ++t)
    for (int k = 0; k < 4; ++k) {
      const int v = mesh.tets(t, k);
      if (v < 0 || v >= mesh.n_vertices())
        throw InputError("tet " + std::to_string(t) + " refers to vertex " + std::to_string(v) +
                             "; the mesh has " + counted(mesh.n_vertices(), "vertex", "vertices") +
                             ", counted from 0",
                         "no-such-element");
      if (!mesh.points.row(v).allFinite())
        throw InputError("tet " + std::to_string(t) + " has vertex " + std::to_string(v) +
                             ", whose coordinates are not finite",
                         "not-finite");
    }
}

int number_faces(const TetMesh& mesh, Rows<int, 4>& tet_faces) {
  struct Side {
    std::array<int, 3> corners;
    int tet, k;
  };
  std::vector<Side> sides;
  for (int t = 0; t < mesh.n_tets(); ++t)
    for (int k = 0; k < 4; ++k) {
      Side s{{}, t, k};
      for (int j = 0, c = 0; j < 4; ++j)
        if (j != k) s.corners[c++] = mesh.tets(t, j);
      std::sort(s.corners.begin(), s.corners.end());
      sides.push_back(s);
    }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.corners, a.tet, a.k) < std::tie(b.corners, b.tet, b.k);
  });
  tet_faces.resize(mesh.n_tets(), 4);
  int n = 0;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    if (i == 0 || sides[i].corners != sides[i - 1].corners) ++n;
    tet_faces(sides[i].tet, sides[i].k) = n - 1;
  }
  return n;
}

}  // namespace

TetOperators tet_operators(const TetMesh& mesh) {
  check(mesh);
  TetOperators ops;
  ops.tets_ = mesh.tets;
  ops.n_faces = number_faces(mesh, ops.tet_faces);
  const int n = mesh.n_vertices();
  ops.volumes = VecX::Zero(mesh.n_tets());
  ops.gradients.assign(mesh.n_tets(), Eigen::Matrix<double, 4, 3>::Zero());
  std::vector<int> parent(n);
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  std::vector<char> used(n, 0);
  Triplets laplacian, face_laplacian, face_mass;
  for (int t = 0; t < mesh.n_tets(); ++t) {
    const Vec3 a = mesh.points.row(mesh.tets(t, 0));
    Eigen::Matrix3d edges;  // rows: corners 1 to 3 from corner 0
    for (int k = 0; k < 3; ++k) edges.row(k) = mesh.points.row(mesh.tets(t, k + 1)) - a.transpose();
    const double determinant = edges.determinant();
    const double V = std::abs(determinant) / 6;
    if (!(V > 1e-14 * std::pow(edges.rowwise().norm().maxCoeff(), 3))) continue;
    ops.volumes[t] = V;
    // grad lambda_k for k > 0 are the columns of the inverse; the four sum to zero.
    auto& g = ops.gradients[t];
    g.bottomRows<3>() = edges.inverse().transpose();
    g.row(0) = -g.bottomRows<3>().colwise().sum();
    for (int i = 0; i < 4; ++i) {
      const int vi = mesh.tets(t, i), fi = ops.tet_faces(t, i);
      used[vi] = 1;
      parent[root(vi)] = root(mesh.tets(t, 0));
      for (int j = 0; j < 4; ++j) {
        const int vj = mesh.tets(t, j), fj = ops.tet_faces(t, j);
        // phi_f = 1 - 3 lambda of the opposite corner: nine times the products of the lambdas.
        const double product = V * g.row(i).dot(g.row(j));
        if (vi >= vj) laplacian.emplace_back(vi, vj, product);
        if (fi >= fj) {
          face_laplacian.emplace_back(fi, fj, 9 * product);
          face_mass.emplace_back(fi, fj, (i == j ? 0.4 : -0.05) * V);
        }
      }
    }
  }
  if (!(ops.volumes.sum() > 0)) throw InputError("the tet mesh has no volume", "empty-input");
  ops.component.assign(n, -1);
  std::vector<int> number(n, -1);
  for (int v = 0; v < n; ++v) {
    if (used[v] == 0) continue;
    int& c = number[root(v)];
    if (c < 0) c = ops.n_components++;
    ops.component[v] = c;
  }
  const auto matrix = [](SpMat& to, Eigen::Index size, const Triplets& entries) {
    to.resize(size, size);
    to.setFromTriplets(entries.begin(), entries.end());
  };
  matrix(ops.L, n, laplacian);
  std::vector<char> held(ops.n_faces, 0);
  for (const auto& entry : face_mass) held[entry.row()] = 1;
  for (int f = 0; f < ops.n_faces; ++f)
    if (held[f] == 0) face_mass.emplace_back(f, f, 1);  // of flat tets alone: 0 stays 0
  matrix(ops.face_laplacian, ops.n_faces, face_laplacian);
  matrix(ops.face_mass, ops.n_faces, face_mass);
  return ops;
}

VecX TetOperators::divergence(const MatX3& Y) const {
  VecX b = VecX::Zero(L.rows());
  for (Eigen::Index t = 0; t < tets_.rows(); ++t) {
    const Eigen::Vector4d flux = volumes[t] * gradients[t] * Y.row(t).transpose();
    for (int k = 0; k < 4; ++k) b[tets_(t, k)] += flux[k];
  }
  return b;
}

MatX3 TetOperators::gradient(const VecX& u) const {
  MatX3 g = MatX3::Zero(tets_.rows(), 3);
  for (Eigen::Index t = 0; t < tets_.rows(); ++t)
    for (int k = 0; k < 4; ++k) g.row(t) += u[tets_(t, k)] * gradients[t].row(k);
  return g;
}

VecX TetOperators::vertex_mass() const {
  VecX mass = VecX::Zero(L.rows());
  for (Eigen::Index t = 0; t < tets_.rows(); ++t)
    for (int k = 0; k < 4; ++k) mass[tets_(t, k)] += volumes[t] / 4;
  return mass;
}

MatX3 TetOperators::to_tets(const MatX3& X) const {
  MatX3 mean(tet_faces.rows(), 3);
  for (Eigen::Index t = 0; t < tet_faces.rows(); ++t) {
    mean.row(t).setZero();
    for (int k = 0; k < 4; ++k) mean.row(t) += X.row(tet_faces(t, k)) / 4;
  }
  return mean;
}

}  // namespace littoral
