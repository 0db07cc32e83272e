// Regularized geodesic distance against closed forms and the authors' answers.

#include "methods/regularized/regularized.h"

#include <gtest/gtest.h>

#include <numbers>

#include "littoral/error.h"
#include "one_call.h"
#include "operators/curved_hessian.h"
#include "regularized_helpers.h"
#include "test_meshes.h"

namespace littoral {
namespace {

using test::residual;
using test::solve;
using test::Solved;
using test::with_alpha;

Sources across_ring(int n) { return test::vertex_points({0, n, 2 * n, 3 * n}); }

TEST(RegularizedSolver, CircleWithDirichletEnergy) {
  const int n = 120;
  const SurfaceMesh mesh = test::ring(n, 3, 0.1);
  const double root = std::sqrt(2 * std::numbers::pi * 0.3), pi = std::numbers::pi;
  for (const double alpha : {0.0, 0.5, 1.5, 5.0}) {
    const VecX u = solve(mesh, across_ring(n), with_alpha(alpha / root, 1e-5)).u;
    const double a = std::min(alpha, pi), L = pi - a;  // eq. 6
    for (int i = 0; i < n; ++i) {
      const double x = 2 * pi * i / n, y = std::min(x, 2 * pi - x);
      double expected = y;
      if (alpha > 0 && y > L) {
        // Eq. 5; beyond alpha = pi the parabola starts at the source itself.
        expected = alpha <= pi ? pi - alpha / 2 - (x - pi) * (x - pi) / (2 * alpha)
                               : (pi * pi - (x - pi) * (x - pi)) / (2 * alpha);
      }
      EXPECT_NEAR(u[i], expected, 5e-3) << "alpha " << alpha << " column " << i;
    }
  }
}

TEST(RegularizedSolver, IntervalWithHessianEnergy) {
  // Supplement 4, on (0, 2 pi): a strip held at both ends, so that the kink at the source is free.
  const int n = 100;
  const double pi = std::numbers::pi, alpha = 0.4, c = std::cbrt(3 * alpha);
  PolygonSoup soup = test::grid_soup(n, 3);
  soup.points.col(0) *= 2 * pi;
  soup.points.col(1) *= 0.3;
  Sources ends;
  for (int j = 0; j <= 3; ++j)
    for (int i : {0, n}) ends.points.push_back(SurfacePoint::at_vertex(j * (n + 1) + i));
  const VecX u = solve(SurfaceMesh(soup), ends,
                       with_alpha(alpha / std::pow(2 * pi * 0.3, 1.5), 1e-5), Regularizer::hessian)
                     .u;
  for (int i = 0; i <= n; ++i) {
    const double x = 2 * pi * i / n - pi;
    const double expected = std::abs(x) > c
                                ? pi - std::abs(x)
                                : std::pow(x, 4) / (24 * alpha) - c * c * x * x / (4 * alpha) + pi -
                                      c + 5 * std::pow(c, 4) / (24 * alpha);
    EXPECT_NEAR(u[i], expected, 0.01) << i;
  }
}

/// Rings of a disk of radius 1.
SurfaceMesh disk(int rings) {
  PolygonSoup soup;
  const int n = 6 * rings;
  soup.points = MatX3::Zero(1 + n * rings, 3);
  for (int j = 0; j < rings; ++j)
    for (int i = 0; i < n; ++i) {
      const double a = 2 * std::numbers::pi * (i + 0.5 * (j % 2)) / n, r = (j + 1.0) / rings;
      soup.points.row(1 + j * n + i) << r * std::cos(a), r * std::sin(a), 0;
    }
  for (int i = 0; i < n; ++i) {
    test::add_triangle(soup, 0, 1 + i, 1 + (i + 1) % n);
    for (int j = 1; j < rings; ++j) {
      const int a = 1 + (j - 1) * n + i, b = 1 + (j - 1) * n + (i + 1) % n;
      const int c = 1 + j * n + i, d = 1 + j * n + (i + 1) % n;
      test::add_triangle(soup, a, c, j % 2 ? b : d);
      test::add_triangle(soup, j % 2 ? c : a, d, b);
    }
  }
  return SurfaceMesh(soup);
}

TEST(RegularizedSolver, DiskFromItsBoundary) {
  const int rings = 16;
  const SurfaceMesh mesh = disk(rings);
  Sources boundary;
  for (int i = 0; i < 6 * rings; ++i)
    boundary.points.push_back(SurfacePoint::at_vertex(1 + (rings - 1) * 6 * rings + i));
  const double alpha = 0.2;
  const VecX u = solve(mesh, boundary, with_alpha(alpha / std::sqrt(std::numbers::pi))).u;
  for (int v = 0; v < mesh.n_vertices(); ++v) {
    const double r = mesh.point(v).norm();  // S5
    const double expected = r <= 2 * alpha ? 1 - alpha - r * r / (4 * alpha) : 1 - r;
    EXPECT_NEAR(u[v], expected, 0.02) << v;
  }
}

TEST(RegularizedSolver, TendsToTheGeodesicDistance) {
  const SurfaceMesh mesh(test::octasphere_soup(3));
  double before = 1e9;
  for (const double alpha : {0.4, 0.1, 0.025, 0.0}) {
    const VecX u = solve(mesh, test::vertex_points({4}), with_alpha(alpha, 1e-3)).u;
    double worst = 0;
    for (int v = 0; v < mesh.n_vertices(); ++v)
      worst = std::max(worst, std::abs(u[v] - std::acos(std::clamp(mesh.point(v).z(), -1., 1.))));
    EXPECT_LT(worst, before);
    before = worst;
  }
  EXPECT_LT(before, 0.25);  // first order in the edge length at a point source
}

TEST(RegularizedSolver, SameWhateverTheUnit) {
  PolygonSoup soup = test::torus_soup(20, 12);
  for (const Regularizer regularizer : {Regularizer::dirichlet, Regularizer::hessian}) {
    const auto u =
        solve(SurfaceMesh(soup), test::vertex_points({3}), with_alpha(0.02, 1e-3), regularizer).u;
    for (const double scale : {1e-3, 1e3}) {
      PolygonSoup scaled = soup;
      scaled.points *= scale;
      const auto s =
          solve(SurfaceMesh(scaled), test::vertex_points({3}), with_alpha(0.02, 1e-3), regularizer)
              .u;
      EXPECT_LT((s / scale - u).cwiseAbs().maxCoeff(), 1e-3 * u.maxCoeff());
    }
  }
}

TEST(RegularizedSolver, HessianDoesNotSeeTheBoundary) {
  // A square: the gradient of the Dirichlet distance turns along the boundary, the Hessian one's
  // stays that of the plane.
  const SurfaceMesh mesh(test::grid_soup(16, 16, 1));
  const int source = 8 * 17 + 2;
  double error[2];
  int at = 0;
  for (const auto& [regularizer, alpha] :
       {std::pair(Regularizer::dirichlet, 0.2), std::pair(Regularizer::hessian, 0.01)}) {
    const VecX u =
        solve(mesh, test::vertex_points({source}), with_alpha(alpha, 1e-3), regularizer).u;
    error[at] = 0;
    for (int j = 0; j <= 16; ++j)  // the far side
      error[at] = std::max(
          error[at],
          std::abs(u[j * 17 + 16] - (mesh.point(j * 17 + 16) - mesh.point(source)).norm()));
    ++at;
  }
  EXPECT_LT(error[1], 0.6 * error[0]);
}

TEST(RegularizedSolver, AlignmentTurnsIsolines) {
  const SurfaceMesh mesh(test::grid_soup(20, 20, 1));
  VecX V(2 * mesh.n_faces());
  Report report;
  const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
  for (int f = 0; f < mesh.n_faces(); ++f) {
    const Complex x = tangent_part(mesh, T, f, Vec3::UnitX());
    V[2 * f] = x.real();
    V[2 * f + 1] = x.imag();
  }
  const VecX u = solve(mesh, test::vertex_points({10}), with_alpha(0.2), Regularizer::align, V).u;
  const VecX plain = solve(mesh, test::vertex_points({10}), with_alpha(0.2)).u;
  // Isolines of the aligned distance run along x at the top.
  auto spread = [](const VecX& d) { return d.tail(21).maxCoeff() - d.tail(21).minCoeff(); };
  EXPECT_LT(spread(u), 0.25 * spread(plain));
}

TEST(RegularizedSolver, MaxNormFollowsTheAxes) {
  // On the plane z = 0 the max norm of a gradient along an axis is 1, along a diagonal 1/sqrt(2):
  // rotated by 45 degrees the answer changes.
  PolygonSoup soup = test::grid_soup(12, 12, 1);
  const VecX u =
      solve(SurfaceMesh(soup), test::vertex_points({84}), with_alpha(0.3), Regularizer::max_norm).u;
  PolygonSoup turned = soup;
  for (int v = 0; v < soup.n_vertices(); ++v)
    turned.points.row(v) << (soup.points(v, 0) - soup.points(v, 1)) / std::sqrt(2.),
        (soup.points(v, 0) + soup.points(v, 1)) / std::sqrt(2.), 0;
  const VecX w =
      solve(SurfaceMesh(turned), test::vertex_points({84}), with_alpha(0.3), Regularizer::max_norm)
          .u;
  EXPECT_GT((u - w).cwiseAbs().maxCoeff(), 0.02);
  PolygonSoup quarter = soup;
  for (int v = 0; v < soup.n_vertices(); ++v)
    quarter.points.row(v) << -soup.points(v, 1), soup.points(v, 0), 0;
  const VecX q =
      solve(SurfaceMesh(quarter), test::vertex_points({84}), with_alpha(0.3), Regularizer::max_norm)
          .u;
  EXPECT_LT((u - q).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(RegularizedSolver, GapClosesAndBoundsTheObjective) {
  const SurfaceMesh mesh(test::octasphere_soup(1));
  Report report;
  const test::Problem p = test::problem(mesh, test::vertex_points({4}), report);
  VecX V(2 * mesh.n_faces());
  for (int f = 0; f < mesh.n_faces(); ++f) {
    const Complex x = tangent_part(mesh, p.T, f, Vec3(0.3, 0.5, 0.8));
    V[2 * f] = x.real();
    V[2 * f + 1] = x.imag();
  }
  for (const Regularizer regularizer :
       {Regularizer::dirichlet, Regularizer::hessian, Regularizer::max_norm, Regularizer::align}) {
    RegularizerData data;
    data.V = V;
    data.W = curved_hessian(p.T, p.ops->vector);
    data.frames = face_frames(mesh, p.T);
    const RegularizedSolver method(p.ops, regularizer, std::move(data), {});
    // From a vertex, and from inside a face, around which there are bounds.
    for (const KnownDistances& known :
         {KnownDistances{{4, 0}}, KnownDistances{{4, 0.1}, {9, 0.2}, {12, 0.3}}}) {
      const auto solved = [&](double gap, int iterations) {
        Regularized options = with_alpha(0.05, 1e-3);
        options.gap = gap;
        options.max_iterations = iterations;
        AdmmState state;
        return method.minimize(known, options, state, {});
      };
      const AdmmResult best = solved(1e-5, 100000);
      EXPECT_TRUE(best.converged);
      EXPECT_GE(best.gap, 0);
      EXPECT_LE(best.gap, 1e-5);
      for (const int iterations : {5, 20, 80}) {
        const AdmmResult early = solved(1e-12, iterations);
        // The optimum lies between the objective and its lower bound.
        const double slack = 2e-5 * std::abs(best.objective);
        EXPECT_GE(early.objective, best.objective - slack) << iterations;
        EXPECT_LE(early.objective - early.gap * std::abs(early.objective), best.objective + slack)
            << iterations;
      }
    }
  }
}

TEST(RegularizedSolver, EachComponentIsAProblemOfItsOwn) {
  const PolygonSoup grid = test::jittered_grid_soup(9, 7, 0.2);
  const int n = grid.n_vertices();
  for (const auto regularizer :
       {Regularizer::dirichlet, Regularizer::hessian, Regularizer::max_norm}) {
    const Regularized options = with_alpha(0.05, 2e-3);
    const VecX alone = solve(SurfaceMesh(grid), test::vertex_points({12}), options, regularizer).u;
    for (const double scale : {1.0, 1e-3, 1e-5}) {
      PolygonSoup both = grid;
      both.points.conservativeResize(2 * n + 1, 3);
      for (int v = 0; v < n; ++v)
        both.points.row(n + v) = scale * grid.points.row(v) + Vec3(3, 0, 0).transpose();
      both.points.row(2 * n).setZero();  // in no face
      for (int f = 0; f < grid.n_faces(); ++f) {
        const auto c = grid.face(f);
        test::add_triangle(both, n + c[0], n + c[1], n + c[2]);
      }
      const Solved s =
          solve(SurfaceMesh(both), test::vertex_points({12, n + 12}), options, regularizer);
      EXPECT_EQ(s.report.status, "converged");
      EXPECT_LT((s.u.head(n) - alone).cwiseAbs().maxCoeff(), 1e-9);
      EXPECT_LT((s.u.segment(n, n) / scale - alone).cwiseAbs().maxCoeff(), 1e-7) << scale;
      const double gap = residual(s.report, "duality gap");
      EXPECT_LT(gap, 10 * options.tolerance);
      EXPECT_EQ(gap, std::max(residual(s.report, "duality gap, component 0"),
                              residual(s.report, "duality gap, component 1")));
    }
  }
}

TEST(RegularizedSolver, ManySourcesAgreeHoweverTheyAreHeld) {
  // 64 rows go through the shared factor, more by elimination: adding a duplicate changes nothing.
  const SurfaceMesh mesh(test::grid_soup(30, 10));
  Sources few, many;
  for (int i = 0; i < 60; ++i) few.points.push_back(SurfacePoint::at_vertex(i));
  many = few;
  for (int i = 0; i < 20; ++i) many.points.push_back(SurfacePoint::at_vertex(i + 1));
  const VecX a = solve(mesh, few, with_alpha(0.05, 1e-4)).u,
             b = solve(mesh, many, with_alpha(0.05, 1e-4)).u;
  EXPECT_LT((a - b).cwiseAbs().maxCoeff(), 1e-3);
  for (int i = 60; i <= 123; ++i) many.points.push_back(SurfacePoint::at_vertex(i));
  const VecX c = solve(mesh, many, with_alpha(0, 1e-4)).u;
  for (int v = 0; v < mesh.n_vertices(); ++v)
    EXPECT_NEAR(c[v], std::max(0.0, mesh.point(v).y() - 0.3), 0.01);
}

TEST(RegularizedSolver, SourcesInsideFacesAndOnEdges) {
  // Barycentre of a face, middle of an edge: near the source the distance is that of the plane.
  const SurfaceMesh mesh(test::grid_soup(16, 16, 1));
  for (const SurfacePoint& p :
       {SurfacePoint::in_face(250, 0.5, 0.25, 0.25), SurfacePoint::on_edge(200, 0.25)}) {
    Sources sources;
    sources.points.push_back(p);
    const Vec3 at = mesh.position(p);
    const Solved s = solve(mesh, sources, with_alpha(0, 1e-3));
    EXPECT_EQ(s.report.status, "converged");
    double sum = 0;
    for (int v = 0; v < mesh.n_vertices(); ++v)
      sum += std::abs(s.u[v] - (mesh.point(v) - at).norm());
    EXPECT_LT(sum / mesh.n_vertices(), 0.02);  // first order at a point, edges of 1/16
  }
}

TEST(RegularizedSolver, CurvesThroughFaces) {
  const SurfaceMesh mesh(test::jittered_grid_soup(20, 20, 0.3));
  MatX3 line(2, 3);
  line << 0, 0.52, 0, 1, 0.52, 0;
  const VecX u = solve(mesh, test::space_curve(line, false), with_alpha(0, 1e-4)).u;
  double sum = 0;
  for (int v = 0; v < mesh.n_vertices(); ++v)
    sum += std::abs(u[v] - std::abs(mesh.point(v).y() - 0.52));
  EXPECT_LT(sum / mesh.n_vertices(), 0.03);  // edges of 1/20
}

TEST(RegularizedSolver, RobustToNoiseAndMeshing) {
  // Figures 9, 10: the same alpha on a regular, a jittered, a coarse-and-fine and noisy meshes. Of
  // the noise, half and .8 of an edge high as there, exact distance says how much longer it makes
  // ways.
  PolygonSoup graded = test::grid_soup(20, 20, 1), noisy = graded;
  for (int v = 0; v < graded.n_vertices(); ++v) {
    graded.points(v, 0) = std::pow(graded.points(v, 0), 1.7);
    noisy.points(v, 2) = 0.005 * std::sin(12.9898 * v);
  }
  auto at_middle = [](const PolygonSoup& soup) {
    const SurfaceMesh mesh(soup);
    const VecX u = solve(mesh, test::vertex_points({0}), with_alpha(0.1, 1e-4)).u;
    int nearest = 0;  // to the far corner
    for (int v = 0; v < mesh.n_vertices(); ++v)
      if ((mesh.point(v) - Vec3(1, 1, 0)).norm() < (mesh.point(nearest) - Vec3(1, 1, 0)).norm())
        nearest = v;
    return u[nearest];
  };
  const double regular = at_middle(test::grid_soup(20, 20, 1));
  EXPECT_NEAR(at_middle(test::jittered_grid_soup(20, 20, 0.3)), regular, 0.03 * regular);
  EXPECT_NEAR(at_middle(graded), regular, 0.06 * regular);
  EXPECT_NEAR(at_middle(noisy), regular, 0.06 * regular);
  const auto means = [](const PolygonSoup& soup) {
    const SurfaceMesh mesh(soup);
    const Sources corner = test::vertex_points({0});
    return std::pair(solve(mesh, corner, with_alpha(0.1, 1e-3)).u.mean(),
                     test::exact(mesh, corner).mean());
  };
  const auto [flat, exact_flat] = means(test::grid_soup(20, 20, 1));
  for (const double height : {0.5, 0.8}) {
    for (int v = 0; v < noisy.n_vertices(); ++v)
      noisy.points(v, 2) = height / 20 * std::sin(12.9898 * v);
    const auto [u, exact] = means(noisy);
    EXPECT_GT(exact, 1.05 * exact_flat);
    EXPECT_NEAR(u / flat, exact / exact_flat, 0.015) << height;
  }
}

TEST(RegularizedSolver, SmoothAtTheCutLocusInFewEigenfunctions) {
  // Supplement 10.2 in one dimension: on a ring the share of the energy above frequency 8 falls.
  const int n = 96;
  const SurfaceMesh mesh = test::ring(n, 3, 0.1);
  auto tail = [&](double alpha) {
    const VecX u = solve(mesh, across_ring(n), with_alpha(alpha, 1e-5)).u.head(n);
    double sum = 0;
    for (int k = 9; k <= n / 2; ++k) {
      double c = 0;
      for (int i = 0; i < n; ++i) c += u[i] * std::cos(2 * std::numbers::pi * k * i / n);
      sum += c * c;
    }
    return std::sqrt(sum) / n;
  };
  EXPECT_LT(tail(0.3), 0.75 * tail(0));
}

TEST(RegularizedSolver, BadInputSaysWhatIsWrong) {
  const SurfaceMesh mesh(test::grid_soup(3, 3));
  EXPECT_THROW(solve(mesh, test::vertex_points({0}), with_alpha(0.1), Regularizer::align),
               InputError);
  VecX V = VecX::Constant(2 * mesh.n_faces(), 1);
  V[3] = std::nan("");
  EXPECT_THROW(solve(mesh, test::vertex_points({0}), with_alpha(0.1), Regularizer::align, V),
               InputError);
  Report report;
  for (const auto& [name, value] :
       std::initializer_list<std::pair<const char*, const char*>>{{"alpha", "-1"},
                                                                  {"alpha", "nan"},
                                                                  {"beta", "-1"},
                                                                  {"regularizer", "smooth"},
                                                                  {"tolerance", "0"}})
    EXPECT_THROW(test::surface_distance(mesh, test::vertex_points({0}),
                                        AnyMethod::named("regularized", {{name, value}}), report),
                 InputError)
        << name;
  EXPECT_THROW(test::surface_distance(mesh, {}, Regularized{}, report), InputError);
  EXPECT_THROW(test::surface_distance(mesh, test::vertex_points({99}), Regularized{}, report),
               InputError);
  EXPECT_THROW(
      test::surface_distance(mesh, test::vertex_points({0}),
                             AnyMethod::named("belyaev-fayolle", {{"alpha", "1"}}), report),
      InputError);
  Regularized options = with_alpha(0.05, 1e-9);
  options.max_iterations = 3;
  EXPECT_EQ(solve(mesh, test::vertex_points({0}), options).report.status, "not converged");
}

}  // namespace
}  // namespace littoral
