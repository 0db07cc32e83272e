// Directions through sparse ones, and the Hessian energy of curved surfaces.

#include "operators/line_field.h"

#include <gtest/gtest.h>

#include <numbers>

#include "operators/curved_hessian.h"
#include "regularized_helpers.h"
#include "test_meshes.h"

namespace littoral {
namespace {

TEST(LineField, InterpolatesOnAPlaneAndForgetsSigns) {
  const SurfaceMesh mesh(test::jittered_grid_soup(8, 8, 0.2));
  Report report;
  const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
  const Vec3 x(0.6, 0.8, 0);
  const VecX V = interpolate_line_field(
      T, {{3, tangent_part(mesh, T, 3, x)}, {100, tangent_part(mesh, T, 100, -x)}}, {});
  for (int f = 0; f < mesh.n_faces(); ++f) {
    const Complex expected = tangent_part(mesh, T, f, x), v(V[2 * f], V[2 * f + 1]);
    EXPECT_NEAR(std::abs((std::conj(expected) * v).real()), 1, 1e-4) << f;
  }
}

TEST(CurvedHessian, LinearFunctionsOnThePlaneAndConstantsCostNothing) {
  const SurfaceMesh mesh(test::jittered_grid_soup(7, 6, 0.3));
  Report report;
  const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
  const SpMat W = curved_hessian(T, triangle_operators(T).vector);
  for (int axis = 0; axis < 2; ++axis) {
    const VecX u = mesh.points().col(axis);
    EXPECT_LT((W.selfadjointView<Eigen::Lower>() * u).cwiseAbs().maxCoeff(), 1e-9);
  }
  const SurfaceMesh sphere(test::octasphere_soup(4));
  const IntrinsicTriangulation S = intrinsic_triangulation(sphere, report);
  const SpMat H = curved_hessian(S, triangle_operators(S).vector);
  // z is an eigenfunction of Delta with eigenvalue -2: the energy is the integral of (2 z)^2.
  const VecX z = sphere.points().col(2);
  const double energy = z.dot(H.selfadjointView<Eigen::Lower>() * z);
  EXPECT_NEAR(energy * S.unit * S.unit / (16 * std::numbers::pi / 3), 1, 0.05);
}

}  // namespace
}  // namespace littoral
