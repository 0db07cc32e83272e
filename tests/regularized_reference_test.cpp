// Regularized distance against the authors' answers.

#include <gtest/gtest.h>

#include <fstream>

#include "regularized_helpers.h"

namespace littoral {
namespace {

using test::solve;
using test::with_alpha;

double difference(const VecX& u, const std::filesystem::path& file) {
  std::ifstream in(file);
  VecX e(u.size());
  for (double& value : e)
    if (!(in >> value)) return 1e9;
  return (u - e).cwiseAbs().maxCoeff() / e.maxCoeff();
}

constexpr const char* spot = "reference/rgd/spot_rr";

TEST(RegularizedSolver, ReferenceDirichletSlow) {
  LITTORAL_NEEDS_SHARED(spot);
  const auto folder = test::shared() / spot;
  const SurfaceMesh mesh = test::one_based_mesh(folder);
  const VecX u = solve(mesh, test::vertex_points({2272}), with_alpha(0.05, 7e-5)).u;
  EXPECT_LT(difference(u, folder / "u_D_alpha0.05_tight.txt"), 1e-3);
}

TEST(RegularizedSolver, ReferenceHessianSlow) {
  LITTORAL_NEEDS_SHARED(spot);
  const auto folder = test::shared() / spot;
  const SurfaceMesh mesh = test::one_based_mesh(folder);
  const VecX u =
      solve(mesh, test::vertex_points({2272}), with_alpha(0.001, 1e-2), Regularizer::hessian).u;
  EXPECT_LT(difference(u, folder / "u_H_a0.001.txt"), 0.02);
}

TEST(RegularizedSolver, ReferenceAlignedSlow) {
  LITTORAL_NEEDS_SHARED(spot);
  const auto folder = test::shared() / spot;
  const SurfaceMesh mesh = test::one_based_mesh(folder);
  std::ifstream in(folder / "vf_int_faces3.txt");
  Report report;
  const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
  VecX V(2 * mesh.n_faces());
  for (int f = 0; f < mesh.n_faces(); ++f) {
    Vec3 v;
    in >> v[0] >> v[1] >> v[2];
    const Complex z = tangent_part(mesh, T, f, v);
    V[2 * f] = z.real();
    V[2 * f + 1] = z.imag();
  }
  Regularized options = with_alpha(0.05, 2e-3);
  options.beta = 200;  // the authors' program weighs alignment twice as much as eq. 8 says
  const VecX u = solve(mesh, test::vertex_points({2272}), options, Regularizer::align, V).u;
  EXPECT_LT(difference(u, folder / "u_vfa_a0.05_b100.txt"), 0.02);
}

}  // namespace
}  // namespace littoral
