// How the error grows as curves break (signed heat method, section 9.5.3): nodal lines of low
// Laplacian eigenfunctions are damaged, and the distance to what is left is compared with the
// distance to the whole. usage: littoral_broken_curves MESH...   prints a Markdown table.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "contour/isolines.h"
#include "curves.h"
#include "domain/intrinsic/intrinsic_triangulation.h"
#include "io/read.h"
#include "methods/heat/signed_heat.h"
#include "operators/triangles.h"
#include "sources/pieces.h"
#include "sources/triangle_source_system.h"

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
    const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
    const auto ops = std::make_shared<const Operators>(triangle_operators(T));
    const SignedHeatSolver method(ops, 1);
    auto distance = [&](const Sources& sources) {
      const SourceSystem terms =
          source_system(mesh, T, place_sources(mesh, sources, report));
      return method.solve(terms, {}, {}, report);
    };
    std::vector<double> error(n_damages, 0.0), area(n_damages, 0.0);
    const auto functions = eigenfunctions(*ops, 5);
    for (std::size_t k = 0; k < functions.size(); ++k) {
      const Sources curves = whole(isolines(mesh, functions[k], 0));
      const VecX phi = distance(curves);
      const double range = phi.maxCoeff() - phi.minCoeff();
      for (std::size_t d = 0; d < n_damages; ++d) {
        Sources input = damaged(curves, damages[d].drop, damages[d].reverse, unsigned(k));
        if (damages[d].offset > 0) {
          const double level = damages[d].offset * T.mean_edge_length * T.unit;
          const auto copy = damaged(whole(isolines(mesh, phi, level)), damages[d].drop,
                                    damages[d].reverse, unsigned(k) + 100);
          input.curves.insert(input.curves.end(), copy.curves.begin(), copy.curves.end());
        }
        SignedHeat options;
        options.constraint = Constraint::none;
        const SourceSystem terms =
            source_system(mesh, T, place_sources(mesh, input, report));
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
