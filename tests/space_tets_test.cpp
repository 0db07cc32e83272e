// The tet lattice, its operators, and signed heat on it.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "api/space/sdf.h"
#include "domain/tet/tet_lattice.h"
#include "littoral/error.h"
#include "methods/heat/signed_heat_tets.h"
#include "operators/tet_operators.h"
#include "space_helpers.h"
#include "tet_helpers.h"

namespace littoral {
namespace {

TetLattice lattice() {
  MatX3 points(2, 3);
  points << 0.3, 0.4, 0.1, -0.9, 0.95, 0.2;
  return {Vec3::Constant(-1), 2, 5, points};
}

TEST(TetLattice, FillsTheCubeConformingly) {
  const TetLattice tets = lattice();
  const TetMesh& mesh = tets.mesh();
  double volume = 0;
  std::map<std::array<int, 3>, int> faces;
  for (int t = 0; t < mesh.n_tets(); ++t) {
    std::array<Vec3, 4> p;
    for (int k = 0; k < 4; ++k) p[k] = mesh.points.row(mesh.tets(t, k));
    const double six = (p[1] - p[0]).cross(p[2] - p[0]).dot(p[3] - p[0]);
    EXPECT_GT(six, 0);
    volume += six / 6;
    for (int k = 0; k < 4; ++k) {
      std::array<int, 3> face{};
      for (int j = 0, c = 0; j < 4; ++j)
        if (j != k) face[c++] = mesh.tets(t, j);
      std::sort(face.begin(), face.end());
      ++faces[face];
    }
  }
  EXPECT_NEAR(volume, 8, 1e-12);
  // Faces of one tet only must lie on the cube: there are no cracks inside.
  double boundary = 0;
  for (const auto& [face, count] : faces) {
    ASSERT_LE(count, 2);
    if (count == 2) continue;
    std::array<Vec3, 3> p;
    for (std::size_t k = 0; k < 3; ++k) p[k] = mesh.points.row(face[k]);
    boundary += (p[1] - p[0]).cross(p[2] - p[0]).norm() / 2;
    const Vec3 middle = (p[0] + p[1] + p[2]) / 3;
    EXPECT_NEAR(middle.cwiseAbs().maxCoeff(), 1, 1e-12);
  }
  EXPECT_NEAR(boundary, 24, 1e-12);
}

TEST(TetLattice, IsFineAtThePointsAndCoarseFarAway) {
  const TetLattice tets = lattice();
  const auto size_at = [&](const Vec3& x) {
    const TetPoint p = tets.locate(x);
    const Vec3 a = tets.mesh().points.row(tets.mesh().tets(p.tet, 0));
    return (tets.mesh().points.row(tets.mesh().tets(p.tet, 3)).transpose() - a).norm();
  };
  EXPECT_EQ(tets.finest(), 2.0 / 32);
  EXPECT_LT(size_at(Vec3(0.3, 0.4, 0.1)), 0.06);
  EXPECT_GT(size_at(Vec3(0.9, -0.9, -0.9)), 0.2);
  EXPECT_LT(tets.mesh().n_tets(), 32 * 32 * 32 * 12 / 20);
}

TEST(TetLattice, LocatesPointsByTheirBarycentricCoordinates) {
  const TetLattice tets = lattice();
  const MatX3 queries = test::random_points(300, 1);
  for (Eigen::Index i = 0; i < queries.rows(); ++i) {
    const TetPoint p = tets.locate(queries.row(i));
    ASSERT_GE(p.tet, 0);
    Vec3 x = Vec3::Zero();
    for (int k = 0; k < 4; ++k) {
      EXPECT_GE(p.barycentric[k], -1e-9);
      x += p.barycentric[k] * tets.mesh().points.row(tets.mesh().tets(p.tet, k)).transpose();
    }
    EXPECT_LT((x - queries.row(i).transpose()).norm(), 1e-12);
  }
  EXPECT_EQ(tets.locate(Vec3(2, 0, 0)).tet, -1);
}

TEST(TetOperators, AreExactForConstantAndLinearFunctions) {
  const TetLattice tets = lattice();
  const TetOperators ops = tet_operators(tets.mesh());
  EXPECT_NEAR(ops.volumes.sum(), 8, 1e-12);
  EXPECT_EQ(ops.n_components, 1);
  const auto times = [](const SpMat& lower, const VecX& x) {
    return VecX(lower.selfadjointView<Eigen::Lower>() * x);
  };
  const VecX one = VecX::Ones(ops.n_faces);
  EXPECT_LT(times(ops.face_laplacian, one).norm(), 1e-10);
  EXPECT_NEAR(one.dot(times(ops.face_mass, one)), 8, 1e-10);
  const Vec3 g(1, -2, 0.5);
  VecX f = VecX::Zero(ops.n_faces);  // at the barycentres of faces
  for (int t = 0; t < tets.mesh().n_tets(); ++t)
    for (int k = 0; k < 4; ++k) {
      Vec3 middle = Vec3::Zero();
      for (int j = 0; j < 4; ++j)
        if (j != k) middle += tets.mesh().points.row(tets.mesh().tets(t, j)).transpose() / 3;
      f[ops.tet_faces(t, k)] = g.dot(middle);
    }
  EXPECT_NEAR(f.dot(times(ops.face_laplacian, f)), 8 * g.squaredNorm(), 1e-9);
  const VecX u = tets.mesh().points * g;
  EXPECT_NEAR(u.dot(times(ops.L, u)), 8 * g.squaredNorm(), 1e-9);
  const MatX3 Y = g.transpose().replicate(tets.mesh().n_tets(), 1);
  EXPECT_LT((ops.divergence(Y) - times(ops.L, u)).norm(), 1e-10);
}

TEST(TetOperators, OfTetsAsACalculusKnowTheBoundaryAndTheEdgesOfRegularTets) {
  const int n = 3;
  const TetMesh box = test::tet_box(n);
  const Calculus C = tet_calculus(std::make_shared<const TetOperators>(tet_operators(box)));
  for (int v = 0; v < box.n_vertices(); ++v) {
    const Vec3 x = box.points.row(v);
    const bool inside = x.minCoeff() > 1e-9 && x.maxCoeff() < 1 - 1e-9;
    EXPECT_EQ(C.boundary[static_cast<std::size_t>(v)] == 0, inside) << x.transpose();
  }
  EXPECT_NEAR(C.A.sum(), 1, 1e-12);
  EXPECT_NEAR(C.M.sum(), 1, 1e-12);
  const Vec3 g(2, -1, 0.5);
  EXPECT_LT((C.G.apply(box.points * g) - g.replicate(C.A.size(), 1)).cwiseAbs().maxCoeff(), 1e-9);
  TetMesh regular;  // with edges of length 3
  regular.points.resize(4, 3);
  regular.points << 1, 1, 1, 1, -1, -1, -1, 1, -1, -1, -1, 1;
  regular.points *= 3 / std::sqrt(8.0);
  regular.tets.resize(1, 4);
  regular.tets << 0, 1, 2, 3;
  EXPECT_NEAR(tet_calculus(std::make_shared<const TetOperators>(tet_operators(regular))).h, 3,
              1e-12);
}

TEST(TetOperators, SayWhatIsWrong) {
  TetMesh mesh;
  mesh.points = test::random_points(4, 1);
  mesh.tets.resize(1, 4);
  mesh.tets << 0, 1, 2, 4;
  EXPECT_THROW(tet_operators(mesh), InputError);
  mesh.tets << 0, 1, 2, 2;
  EXPECT_THROW(tet_operators(mesh), InputError);
  mesh.tets << 0, 1, 2, 3;
  mesh.points(2, 1) = std::nan("");
  EXPECT_THROW(tet_operators(mesh), InputError);
}

TEST(SignedHeatTets, SphereErrorFallsWithTheSpacingAndValuesReachTheGrid) {
  const PolygonSoup sphere = test::octasphere_soup(4);
  const auto error = [&](int n, const char* constraint) {
    const SpaceRequest request{AnyMethod::named("signed-heat", {{"constraint", constraint}})};
    Report report;
    const Grid grid = test::cube_grid(n, 1.5);
    const auto [on_grid, function, field, completion] =
        tet_distance(sphere, grid, {}, request, Task(), report);
    double near = 0;
    int count = 0;
    for (int v = 0; v < field.mesh.n_vertices(); ++v) {
      const double exact = field.mesh.points.row(v).norm() - 1;
      if (std::abs(exact) > 0.3) continue;
      near += std::abs(field.values[v] - exact);
      ++count;
    }
    EXPECT_LT(test::mean_error(grid, on_grid, [](const Vec3& x) { return x.norm() - 1; }), 0.08);
    return near / count;
  };
  for (const char* constraint : {"none", "zero-set"}) {
    const double coarse = error(9, constraint), fine = error(17, constraint);
    EXPECT_LT(fine, 0.02) << constraint;
    EXPECT_LT(fine, 0.7 * coarse) << constraint;
  }
}

TEST(SignedHeatTetsSlow, OneSolveIsAsTheSolvesOnAFactor) {
  const OrientedPoints source = test::sphere_samples(3);
  const TetLattice tets(Vec3::Constant(-1.5), 3, 4, source.points);
  const auto ops = std::make_shared<const TetOperators>(tet_operators(tets.mesh()));
  std::vector<TetPoint> places;
  std::vector<int> cubes;
  for (Eigen::Index i = 0; i < source.size(); ++i) {
    places.push_back(tets.locate(source.points.row(i)));
    cubes.push_back(tets.cube_of(places.back().tet));
  }
  const TetSourceSystem system = tet_source_system(tets.mesh(), *ops, source, places, cubes);
  for (const double time_scale : {0.25, 1.0, 2.0}) {
    SpaceSignedHeat options;
    options.time_scale = time_scale;
    Report report;
    const auto by = [&](SolveHint hint) {
      return TetHeatSolver(ops, hint).signed_distance(system, tets.finest(), 0.01 * tets.finest(),
                                                      options, Task(), report);
    };
    const VecX once = by(SolveHint::single_rhs), factored = by(SolveHint::many_rhs);
    EXPECT_LT((once - factored).cwiseAbs().maxCoeff(), 1e-9) << time_scale;
    EXPECT_NE(once, factored) << time_scale << ": two ways indeed, of " << ops->n_faces << " faces";
  }
}

TEST(SpaceTets, WhereTheGradientIsOffUnitLengthHeatSaysSo) {
  for (const bool uneven : {false, true}) {
    TetMesh mesh = test::tet_box(8);
    if (uneven) mesh.points = mesh.points.array().pow(4).matrix().eval();  // crowded at the source
    TetSources sources;
    sources.vertices = {uneven ? 0 : 364};  // a corner, or the middle
    Report report;
    const VecX d = test::tet_mesh_distance(mesh, sources, SpaceSignedHeat{}, report);
    double share = -1;
    for (const auto& [name, value] : report.residuals)
      if (name == "volume fraction with gradient off unit length") share = value;
    // The same by hand: linear functions on tets.
    double off = 0, all = 0;
    for (Eigen::Index t = 0; t < mesh.tets.rows(); ++t) {
      Eigen::Matrix3d E;
      Vec3 rise;
      for (int k = 0; k < 3; ++k) {
        E.row(k) = mesh.points.row(mesh.tets(t, k + 1)) - mesh.points.row(mesh.tets(t, 0));
        rise[k] = d[mesh.tets(t, k + 1)] - d[mesh.tets(t, 0)];
      }
      const double volume = std::abs(E.determinant());
      all += volume;
      if (std::abs((E.inverse() * rise).norm() - 1) > 0.25) off += volume;
    }
    EXPECT_NEAR(share, off / all, 1e-6);
    EXPECT_EQ(share > 0.3, uneven);
    EXPECT_EQ(std::ranges::any_of(report.warnings,
                                  [](const auto& w) { return w.code == "gradient-off-unit"; }),
              uneven);
  }
}

}  // namespace
}  // namespace littoral
