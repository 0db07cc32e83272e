// How the error grows as curves break (signed heat method, section 9.5.3): nodal lines of low
// Laplacian eigenfunctions are damaged, and the distance to what is left is compared with the
// distance to the whole. usage: littoral_broken_curves MESH...   prints a Markdown table.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "api/surface/discretization.h"
#include "contour/isolines.h"
#include "curves.h"
#include "io/read.h"

namespace littoral {
namespace {

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
    const SurfaceDomain domain = domain_of(mesh);
    const SurfaceDiscretization on(domain, {}, report);
    const VecX& M = on.operators()->scalar.M;
    const double edge = on.triangulation()->mean_edge_length * on.triangulation()->unit;
    const auto prepared = [&](Constraint constraint) {
      return prepare(AnyMethod(SignedHeat{.time_scale = 1, .constraint = constraint}), domain,
                     SolveHint::many_rhs, {}, report);
    };
    const auto held = prepared(Constraint::zero_set), free = prepared(Constraint::none);
    std::vector<double> error(n_damages, 0.0), area(n_damages, 0.0);
    const auto functions = eigenfunctions(*on.operators(), 5);
    for (std::size_t k = 0; k < functions.size(); ++k) {
      const Sources curves = whole(isolines(mesh, functions[k], 0));
      const VecX phi = held->solve(curves, {}, report).values;
      const double range = phi.maxCoeff() - phi.minCoeff();
      for (std::size_t d = 0; d < n_damages; ++d) {
        Sources input = damaged(curves, damages[d].drop, damages[d].reverse, unsigned(k));
        if (damages[d].offset > 0) {
          const auto copy = damaged(whole(isolines(mesh, phi, damages[d].offset * edge)),
                                    damages[d].drop, damages[d].reverse, unsigned(k) + 100);
          input.curves.insert(input.curves.end(), copy.curves.begin(), copy.curves.end());
        }
        const VecX broken = free->solve(input, {}, report).values;
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
