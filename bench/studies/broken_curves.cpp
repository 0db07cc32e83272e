// How the error grows as curves break (signed heat method, section 9.5.3): nodal lines of low
// Laplacian eigenfunctions are damaged, and the distance to what is left is compared with the
// distance to the whole. usage: littoral_broken_curves MESH...   prints a Markdown table.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <random>

#include "littoral/contour/isolines.h"
#include "littoral/domain/intrinsic_triangulation.h"
#include "littoral/io/read.h"
#include "littoral/methods/signed_heat.h"
#include "littoral/operators/triangles.h"
#include "littoral/sources/pieces.h"
#include "littoral/sources/triangle_source_terms.h"

namespace littoral {
namespace {

/// The first eigenfunctions of L u = lambda M u after the constant, by subspace iteration.
std::vector<VecX> eigenfunctions(const Operators& ops, int count) {
  const Calculus& C = ops.scalar;
  const Poisson poisson(C.L, C.component, C.n_components, {});
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  std::vector<VecX> U(static_cast<std::size_t>(count) + 4, VecX(C.M.size()));
  for (VecX& u : U)
    for (double& x : u) x = normal(random);
  Report unused;
  for (int step = 0; step < 60; ++step) {
    for (std::size_t i = 0; i < U.size(); ++i) {
      VecX b = C.M.cwiseProduct(U[i]);
      b -= C.M * (b.sum() / C.M.sum());
      VecX u = poisson.solve(b, unused);
      u.array() -= C.M.dot(u) / C.M.sum();
      for (std::size_t j = 0; j < i; ++j) u -= U[j] * U[j].dot(C.M.cwiseProduct(u));
      U[i] = u / std::sqrt(u.dot(C.M.cwiseProduct(u)));
    }
  }
  U.resize(static_cast<std::size_t>(count));
  return U;
}

SurfaceSources whole(const std::vector<Polyline>& lines) {
  SurfaceSources sources;
  for (const Polyline& line : lines) {
    SurfaceCurve curve{line.nodes, true, "nodal line"};
    if (line.closed) curve.nodes.push_back(curve.nodes.front());
    if (curve.nodes.size() > 1) sources.curves.push_back(std::move(curve));
  }
  return sources;
}

/// Cuts every curve into runs of 4 to 12 segments, drops a share of them and reverses another.
SurfaceSources damaged(const SurfaceSources& sources, double drop, double reverse, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(0, 1);
  SurfaceSources out;
  for (const SurfaceCurve& curve : sources.curves) {
    for (std::size_t i = 0; i + 1 < curve.nodes.size();) {
      const std::size_t end = std::min(curve.nodes.size() - 1, i + 4 + random() % 9);
      const bool first = out.curves.empty() && end + 1 == curve.nodes.size();  // keep at least one
      const bool dropped = u(random) < drop && !first, reversed = u(random) < reverse;
      SurfaceCurve run{{curve.nodes.begin() + static_cast<std::ptrdiff_t>(i),
                        curve.nodes.begin() + static_cast<std::ptrdiff_t>(end) + 1},
                       true,
                       curve.origin};
      if (reversed) std::reverse(run.nodes.begin(), run.nodes.end());
      if (!dropped) out.curves.push_back(std::move(run));
      i = end;
    }
  }
  return out;
}

struct Damage {
  const char* name;
  double drop, reverse, offset;  // offset: of a second copy of the curve, in edge lengths
};

int run(int n_meshes, char** meshes) {
  const Damage damages[] = {{"10 % missing", .1, 0, 0},
                            {"25 % missing", .25, 0, 0},
                            {"50 % missing", .5, 0, 0},
                            {"75 % missing", .75, 0, 0},
                            {"5 % reversed", 0, .05, 0},
                            {"20 % reversed", 0, .2, 0},
                            {"curve and its offset, 50 % missing", .5, 0, 3},
                            {"the same, 10 % reversed", .5, .1, 3}};
  constexpr std::size_t n_damages = std::size(damages);
  std::printf("| mesh | faces |");
  for (const Damage& d : damages) std::printf(" %s |", d.name);
  std::printf("\n|---|---|");
  for (std::size_t d = 0; d < n_damages; ++d) std::printf("---|");
  std::printf("\n");
  for (int m = 0; m < n_meshes; ++m) {
    const SurfaceMesh mesh(io::read_surface(meshes[m]));
    Report report;
    const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
    const auto ops = std::make_shared<const Operators>(triangle_operators(T));
    const SignedHeat method(ops, 1);
    auto distance = [&](const SurfaceSources& sources) {
      const SourceTerms terms = source_terms(mesh, T, prepare(mesh, sources, false, report));
      return method.solve(terms, {}, {}, report);
    };
    std::vector<double> error(n_damages, 0.0), area(n_damages, 0.0);
    const auto functions = eigenfunctions(*ops, 5);
    for (std::size_t k = 0; k < functions.size(); ++k) {
      const SurfaceSources curves = whole(isolines(mesh, functions[k], 0));
      const VecX phi = distance(curves);
      const double range = phi.maxCoeff() - phi.minCoeff();
      for (std::size_t d = 0; d < n_damages; ++d) {
        SurfaceSources input = damaged(curves, damages[d].drop, damages[d].reverse, unsigned(k));
        if (damages[d].offset > 0) {
          const double level = damages[d].offset * T.mean_edge_length * T.unit;
          const auto copy = damaged(whole(isolines(mesh, phi, level)), damages[d].drop,
                                    damages[d].reverse, unsigned(k) + 100);
          input.curves.insert(input.curves.end(), copy.curves.begin(), copy.curves.end());
        }
        SignedHeatOptions options;
        options.constraint = static_cast<int>(Constraint::none);
        const SourceTerms terms = source_terms(mesh, T, prepare(mesh, input, false, report));
        const VecX broken = method.solve(terms, options, {}, report);
        const VecX& M = ops->scalar.M;
        double e = 0, wrong = 0;
        for (Eigen::Index i = 0; i < phi.size(); ++i) {
          e += M[i] * std::abs(broken[i] - phi[i]);
          if (broken[i] * phi[i] < 0) wrong += M[i];
        }
        error[d] += e / M.sum() / range / static_cast<double>(functions.size());
        area[d] += wrong / M.sum() / static_cast<double>(functions.size());
      }
    }
    std::printf("| %s | %d |", std::filesystem::path(meshes[m]).stem().c_str(), mesh.n_faces());
    for (std::size_t d = 0; d < n_damages; ++d)
      std::printf(" %.1f / %.1f |", 100 * error[d], 100 * area[d]);
    std::printf("\n");
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace
}  // namespace littoral

int main(int argc, char** argv) {
  try {
    return littoral::run(argc - 1, argv + 1);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "littoral_broken_curves: %s\n", error.what());
    return 1;
  }
}
