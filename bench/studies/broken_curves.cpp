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

/// What answers for a broken curve.
struct Answer {
  const char* name;
  AnyMethod method;
};

/// Mean over curves, for each damage and answer.
struct Errors {
  double distance = 0, area = 0;  // shares of the range, of the surface
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
  const Answer answers[] = {
      {"default", Automatic{.confidence = true}},
      {"zero set", Automatic{.completion = Completion::heat}},
      {"shortest", Automatic{.completion = Completion::shortest}},
      {"signed heat", SignedHeat{.time_scale = 1, .constraint = Constraint::none}}};
  std::printf("| mesh | faces | answer |");
  for (const Damage& d : damages) std::printf(" %s |", d.name);
  std::printf("\n|---|---|---|");
  for (std::size_t d = 0; d < std::size(damages); ++d) std::printf("---|");
  std::printf("\n");
  double sure[10] = {}, right[10] = {};  // area by confidence, in tenths
  for (int m = 0; m < n_meshes; ++m) {
    const SurfaceMesh mesh(io::read_surface(meshes[m]));
    Report report;
    const SurfaceDomain domain = domain_of(mesh);
    const SurfaceDiscretization on(domain, {}, report);
    const VecX& M = on.operators()->scalar.M;
    const double edge = on.triangulation()->mean_edge_length * on.triangulation()->unit;
    const auto prepared = [&](const AnyMethod& method) {
      return prepare(method, domain, SolveHint::many_rhs, {}, report);
    };
    const auto truth = prepared(Automatic{});
    std::vector<std::shared_ptr<const Solver<SurfaceDomain>>> solvers;
    for (const Answer& answer : answers) solvers.push_back(prepared(answer.method));
    Errors errors[std::size(answers)][std::size(damages)];
    const auto functions = eigenfunctions(*on.operators(), 5);
    const double share = 1 / static_cast<double>(functions.size());
    for (std::size_t k = 0; k < functions.size(); ++k) {
      const Sources curves = whole(isolines(mesh, functions[k], 0));
      const VecX phi = truth->solve(curves, {}, report).values;
      const double range = phi.maxCoeff() - phi.minCoeff();
      for (std::size_t d = 0; d < std::size(damages); ++d) {
        Sources input = damaged(curves, damages[d].drop, damages[d].reverse, unsigned(k));
        if (damages[d].offset > 0) {
          const auto copy = damaged(whole(isolines(mesh, phi, damages[d].offset * edge)),
                                    damages[d].drop, damages[d].reverse, unsigned(k) + 100);
          input.curves.insert(input.curves.end(), copy.curves.begin(), copy.curves.end());
        }
        for (std::size_t a = 0; a < std::size(answers); ++a) {
          const SurfaceAnswer answer = solvers[a]->solve(input, {}, report);
          const VecX& broken = answer.values;
          double e = 0, wrong = 0;
          for (Eigen::Index i = 0; i < phi.size(); ++i) {
            e += M[i] * std::abs(broken[i] - phi[i]);
            if (broken[i] * phi[i] < 0) wrong += M[i];
            if (answer.confidence.size() == 0 || damages[d].offset > 0) continue;
            const auto bin = std::min<std::size_t>(9, std::size_t(10 * answer.confidence[i]));
            sure[bin] += M[i] / M.sum();
            if (broken[i] * phi[i] >= 0) right[bin] += M[i] / M.sum();
          }
          errors[a][d].distance += share * e / M.sum() / range;
          errors[a][d].area += share * wrong / M.sum();
        }
      }
    }
    for (std::size_t a = 0; a < std::size(answers); ++a) {
      std::printf("| %s | %d | %s |", std::filesystem::path(meshes[m]).stem().c_str(),
                  mesh.n_faces(), answers[a].name);
      for (const Errors& e : errors[a])
        std::printf(" %.2f / %.2f |", 100 * e.distance, 100 * e.area);
      std::printf("\n");
    }
    std::fflush(stdout);
  }
  std::printf("\n| confidence | share of the area | right signs |\n|---|---|---|\n");
  double all = 0;
  for (const double a : sure) all += a;
  for (int bin = 0; bin < 10; ++bin)
    std::printf("| %.1f to %.1f | %.2f %% | %.2f %% |\n", bin / 10.0, (bin + 1) / 10.0,
                100 * sure[bin] / all, 100 * right[bin] / sure[bin]);
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
