// Integration in the L1 sense beside COIN Clp, on residual functions of broken loops on a torus.
// Prints Markdown rows. usage: littoral_l1_timer FACES... (a minus: without Clp)

#include <ClpSimplex.hpp>
#include <ClpSolve.hpp>
#include <CoinPackedMatrix.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <numbers>
#include <random>

#include "base/index.h"
#include "base/parallel.h"
#include "domain/intrinsic/intrinsic_triangulation.h"
#include "methods/winding/jump_laplace.h"
#include "methods/winding/residual.h"
#include "test_meshes.h"

namespace {

using namespace littoral;

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// What step 3 of surface winding numbers integrates, and what the linear solve before it takes.
struct Instance {
  L1Integration problem;
  double poisson_seconds = 0;
};

/// Three loops round the tube of a torus and one along it, each with a fifth of it missing.
Instance instance(int faces) {
  const int nv = static_cast<int>(std::lround(std::sqrt(faces / 4.0))), nu = 2 * nv;
  PolygonSoup soup = test::torus_soup(nu, nv);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> jitter(-0.2 / nv, 0.2 / nv);
  for (int v = 0; v < soup.n_vertices(); ++v)
    for (int k = 0; k < 3; ++k) soup.points(v, k) += jitter(random);
  const SurfaceMesh mesh(std::move(soup));
  Report report;
  const JumpCalculus J = jump_calculus(intrinsic_triangulation(mesh, report));
  VecX curve = VecX::Zero(J.n_edges);
  const auto step = [&](int a, int b) {
    const int e = mesh.find_edge(a, b);
    curve[e] += mesh.edges()(e, 0) == a ? 1 : -1;
  };
  for (const int i : {nu / 8, nu / 3, nu / 2})
    for (int j = 0; j < nv; ++j)
      if (j * 10 / nv % 5 != 2) step(i * nv + j, i * nv + (j + 1) % nv);
  for (int i = 0; i < nu; ++i)
    if (i * 20 / nu % 5 != 2) step(i * nv + nv / 3, (i + 1) % nu * nv + nv / 3);
  Instance out;
  const double start = cpu_seconds();
  const CornerFunction u = solve_jump_laplace(J, curve, {}, Boundary::natural, {}, report);
  out.poisson_seconds = cpu_seconds() - start;
  const VecX gamma = harmonic_part(J, darboux_derivative(J, u), {});
  const VecX c = jump_derivative(J, integrate_locally(J, gamma));
  L1Integration& p = out.problem;
  p.n = J.n_faces;
  p.c = c;
  p.w = J.length;
  p.lo = VecX::Constant(J.n_edges, -infinity);
  p.hi = -p.lo;
  for (int e = 0; e < J.n_edges; ++e) {
    p.f.push_back(J.sides[e][0].face);
    p.g.push_back(J.sides[e][1].face);
    if (curve[e] == 0) continue;
    p.w[e] *= 0.01;
    p.lo[e] = std::min(0.0, curve[e]);
    p.hi[e] = std::max(0.0, curve[e]);
  }
  return out;
}

/// The optimum by Clp's barrier method, without crossover, on the circulation (DESIGN: one row a
/// face, one capacitated column an edge and one column a finite bound).
double clp_optimum(const L1Integration& p) {
  std::vector<double> lower, upper, cost, values;
  std::vector<int> starts{0}, rows;
  const auto column = [&](int from, int to, double lo, double hi, double c) {
    rows.insert(rows.end(), {from, to});
    values.insert(values.end(), {1.0, -1.0});
    starts.push_back(static_cast<int>(rows.size()));
    lower.push_back(lo);
    upper.push_back(hi);
    cost.push_back(c);
  };
  for (Eigen::Index e = 0; e < p.n_arcs(); ++e) {
    column(p.f[e], p.g[e], -p.w[e], p.w[e], -p.c[e]);
    if (std::isfinite(p.hi[e])) column(p.f[e], p.g[e], 0, COIN_DBL_MAX, p.hi[e] - p.c[e]);
    if (std::isfinite(p.lo[e])) column(p.g[e], p.f[e], 0, COIN_DBL_MAX, p.c[e] - p.lo[e]);
  }
  const std::vector<double> zero(static_cast<std::size_t>(p.n), 0.0);
  ClpSimplex model;
  model.setLogLevel(0);
  model.loadProblem(static_cast<int>(cost.size()), p.n, starts.data(), rows.data(), values.data(),
                    lower.data(), upper.data(), cost.data(), zero.data(), zero.data());
  ClpSolve options;
  options.setSolveType(ClpSolve::useBarrierNoCross);
  model.initialSolve(options);
  return -model.objectiveValue();
}

}  // namespace

int main(int argc, char** argv) {
  set_thread_count(1);
  std::printf(
      "| faces | littoral, s | certified gap | of the Poisson solve | Clp barrier, s | ratio | "
      "optima differ, relative |\n|---|---|---|---|---|---|---|\n");
  for (int i = 1; i < argc; ++i) {
    const int faces = std::atoi(argv[i]);
    const Instance in = instance(std::abs(faces));
    Report report;
    double start = cpu_seconds();
    const L1Solution ours = integrate_l1(in.problem, {}, {}, report);
    const double seconds = cpu_seconds() - start;
    std::printf("| %d | %.3f | %.1e | %.0fx |", in.problem.n, seconds, std::abs(ours.gap()),
                seconds / in.poisson_seconds);
    if (faces > 0) {
      start = cpu_seconds();
      const double theirs = clp_optimum(in.problem);
      const double clp_seconds = cpu_seconds() - start;
      std::printf(" %.2f | %.2f | %.1e |\n", clp_seconds, seconds / clp_seconds,
                  std::abs(theirs - ours.primal) / ours.primal);
    } else {
      std::printf(" not run | | |\n");
    }
    std::fflush(stdout);
  }
}
