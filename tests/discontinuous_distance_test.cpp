// Distance that jumps: exact on flat tori, the same as ever where nothing has to jump.

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "domain/intrinsic/intrinsic_triangulation.h"
#include "littoral/error.h"
#include "methods/heat/discontinuous.h"
#include "one_call.h"
#include "test_meshes.h"

namespace littoral {
namespace {

Sources vertex_loop(std::vector<int> vertices) {
  Sources sources;
  Curve& curve = sources.curves.emplace_back();
  for (int v : vertices) curve.nodes.push_back(SurfacePoint::at_vertex(v));
  return sources;
}

SurfaceAnswer distance(const SurfaceMesh& mesh, const Sources& sources, const SignedHeat& method) {
  Report report;
  return test::surface_answer(mesh, sources, method, report);
}

TEST(DiscontinuousDistance, LeavesIntegrableFieldsAlone) {
  // Unit vectors along x in the plane: phi = x, no jumps, no curl.
  const SurfaceMesh mesh(test::jittered_grid_soup(9, 9, 0.3));
  Report report;
  const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
  const JumpCalculus J = jump_calculus(T);
  VecX Y(2 * J.n_faces);
  for (int f = 0; f < J.n_faces; ++f) {
    const Vec3 d = (mesh.point(T.faces(f, 1)) - mesh.point(T.faces(f, 0))).normalized();
    Y[2 * f] = d.x();  // the frame's real axis runs along d
    Y[2 * f + 1] = -d.y();
  }
  EXPECT_LT(edge_curl(J, Y).cwiseAbs().maxCoeff(), 1e-9);
  const DiscontinuousField field = integrate_discontinuous(J, Y, 1, 0, {}, report);
  EXPECT_LT(field.objective, 1e-9);
  const double shift = field.phi(0, 0) * T.unit - mesh.point(T.faces(0, 0)).x();
  for (int f = 0; f < J.n_faces; ++f)
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(T.unit * field.phi(f, k) - shift, mesh.point(T.faces(f, k)).x(), 1e-9);
}

TEST(DiscontinuousDistance, AgreesWithTheContinuousOneWhereACurveBounds) {
  const SurfaceMesh mesh(test::octasphere_soup(4));
  Sources sources;
  MatX3 ring(61, 3);
  for (int i = 0; i <= 60; ++i) {
    const double a = 2 * std::acos(-1.0) * (i % 60) / 60;
    ring.row(i) << 0.8 * std::cos(a), 0.8 * std::sin(a), 0.6;
  }
  sources.space_curves.push_back({ring, true, "ring"});
  const VecX plain = distance(mesh, sources, {}).values;
  const SurfaceAnswer torn = distance(mesh, sources, {.discontinuous = true});
  EXPECT_LT((plain - torn.values).cwiseAbs().maxCoeff(), 0.2);  // two edge lengths, at the pole
  EXPECT_LT((plain - torn.values).cwiseAbs().mean(), 0.03);
  EXPECT_EQ(torn.shown->scalars.at("distance").size(), torn.shown->n_vertices());
}

TEST(DiscontinuousDistance, ALoopThatBoundsNothingGetsDistanceToBothSides) {
  // Round the tube of a thin torus: distance grows all the way round and jumps opposite the loop.
  constexpr int nu = 60, nv = 10;
  const double R = 1, r = 0.1;
  const SurfaceMesh mesh(test::torus_soup(nu, nv, R, r));
  std::vector<int> loop;
  for (int j = 0; j <= nv; ++j) loop.push_back(j % nv);
  const SurfaceAnswer torn =
      distance(mesh, vertex_loop(loop), {.time_scale = 16, .discontinuous = true});
  const VecX& phi = torn.shown->scalars.at("distance");
  // |grad phi| is 1 nearly everywhere: values run from - to + half the way round.
  const double half = std::acos(-1.0) * R;
  EXPECT_NEAR(phi.maxCoeff(), half, 0.15 * half);
  EXPECT_NEAR(phi.minCoeff(), -half, 0.15 * half);
  EXPECT_GT(torn.shown->n_vertices(), mesh.n_vertices());
  // Without jumps, the field has to be flattened: far from what distance is.
  const VecX plain = distance(mesh, vertex_loop(loop), {.time_scale = 16}).values;
  EXPECT_LT(plain.maxCoeff(), 0.75 * half);
  // Few vertices are torn: one ring of the tube, more or less.
  EXPECT_LT(torn.shown->n_vertices() - mesh.n_vertices(), 3 * nv);
}

TEST(DiscontinuousDistance, LeavesOutWhatBoundsNothing) {
  constexpr int nu = 24, nv = 16;
  const SurfaceMesh mesh(test::torus_soup(nu, nv));
  std::vector<int> tube, disk;
  for (int j = 0; j <= nv; ++j) tube.push_back(3 * nv + j % nv);
  for (int i = 8; i < 14; ++i) disk.push_back(i * nv + 2);
  for (int j = 2; j < 8; ++j) disk.push_back(14 * nv + j);
  for (int i = 14; i > 8; --i) disk.push_back(i * nv + 8);
  for (int j = 8; j >= 2; --j) disk.push_back(8 * nv + j);
  Sources both = vertex_loop(tube);
  both.curves.push_back(vertex_loop(disk).curves[0]);
  const VecX filtered = distance(mesh, both, {.bounding_only = true}).values;
  const VecX alone = distance(mesh, vertex_loop(disk), {}).values;
  EXPECT_LT((filtered - alone).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_THROW(distance(mesh, vertex_loop(tube), {.bounding_only = true}), InputError);
}

}  // namespace
}  // namespace littoral
