// Error of signed heat over its time scale, for smooth curves, curves with corners, broken curves
// and points, against exact polyhedral distance to the whole curve.
// usage: littoral_time_scale MESH...   prints CSV, which time_scale.py turns into a table and a
// plot.

#include <cmath>
#include <cstdio>
#include <filesystem>

#include "api/surface/discretization.h"
#include "curves.h"
#include "io/read.h"

namespace littoral {
namespace {

constexpr double scales[] = {0.25, 1, 2, 4, 8, 16, 64};

struct Case {
  const char* kind;
  Sources whole, given;
};

std::vector<Case> cases(const SurfaceMesh& mesh, const Operators& ops) {
  std::vector<Case> out;
  const auto u = eigenfunctions(ops, 4);
  for (std::size_t k : {1, 3}) {
    const Sources smooth = whole(isolines(mesh, u[k], 0));
    const Sources corners = whole(isolines(mesh, u[k].cwiseMax(u[k - 1]), 0));
    out.push_back({"smooth curves", smooth, smooth});
    out.push_back({"curves with corners", corners, corners});
    out.push_back({"broken curves", smooth, damaged(smooth, 0.4, 0, static_cast<unsigned>(k))});
  }
  for (const int n : {1, 10}) {
    Sources points;
    for (int i = 0; i < n; ++i) {
      const int corner = static_cast<int>((i + 0.5) / n * 3 * mesh.n_faces());
      points.points.push_back(SurfacePoint::at_vertex(mesh.soup().corners[corner]));
    }
    out.push_back({"points", points, points});
  }
  return out;
}

void study(const char* path) {
  const SurfaceMesh mesh(io::read_surface(path));
  Report report;
  const SurfaceDomain domain = domain_of(mesh);
  const auto ops = SurfaceDiscretization(domain, {}, report).operators();
  const auto all = cases(mesh, *ops);
  std::vector<VecX> truth;
  for (const Case& c : all)
    truth.push_back(solve_once(AnyMethod(Exact{}), domain, c.whole, {}, report).values);
  const VecX& M = ops->scalar.M;
  for (const double scale : scales) {
    const auto solver = prepare(AnyMethod(SignedHeat{.time_scale = scale}), domain,
                                SolveHint::many_rhs, {}, report);
    for (std::size_t c = 0; c < all.size(); ++c) {
      const VecX phi = solver->solve(all[c].given, {}, report).values;
      double sum = 0, area = 0, most = 0, worst = 0;
      for (Eigen::Index i = 0; i < phi.size(); ++i) {
        if (!std::isfinite(truth[c][i]) || !std::isfinite(phi[i])) continue;
        const double error = std::abs(std::abs(phi[i]) - truth[c][i]);
        most = std::max(most, truth[c][i]);
        worst = std::max(worst, error);
        sum += M[i] * error;
        area += M[i];
      }
      std::printf("%s,%d,%s,%g,%.4f,%.4f\n", std::filesystem::path(path).stem().c_str(),
                  mesh.n_faces(), all[c].kind, scale, 100 * sum / area / most, 100 * worst / most);
    }
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace littoral

int main(int argc, char** argv) {
  std::printf("mesh,faces,source,scale,mean,largest\n");
  for (int k = 1; k < argc; ++k) {
    try {
      littoral::study(argv[k]);
    } catch (const std::exception& error) {
      std::fprintf(stderr, "%s: %s\n", argv[k], error.what());
    }
  }
  return 0;
}
