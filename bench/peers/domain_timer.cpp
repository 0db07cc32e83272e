// Times signed heat on polygon meshes and point clouds for bench/peers/domains.py, which runs it
// beside other programs.
// usage: littoral_domain_timer SURFACE SOURCES REPEATS VALUES
// SURFACE without faces is a point cloud. Prints processor seconds and peak memory as JSON; writes
// the zero-set distances as doubles to VALUES.

#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <functional>
#include <memory>
#include <vector>

#include "domain/cloud/cloud_surface.h"
#include "domain/mesh/polygon_surface.h"
#include "io/read.h"
#include "methods/heat/signed_heat.h"
#include "operators/nodal.h"
#include "sources/nodal_source_system.h"
#include "sources/refined_sources.h"

namespace littoral {
namespace {

/// Processor time of all threads: means the same on a machine that does other things as well.
double cpu_seconds(const std::function<void()>& call) {
  const std::clock_t start = std::clock();
  call();
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

int run(char** argv) {
  const SurfaceMesh mesh(io::read_surface(argv[1]));
  const int repeats = std::atoi(argv[3]);
  Report report;
  const Sources given = io::read_sources(argv[2], mesh, 0, report);
  std::unique_ptr<SignedHeatSolver> method;
  SourceSystem terms;
  SignedHeat options;
  options.time_scale = 1;
  options.constraint = Constraint::zero_set;
  VecX phi;
  auto solve_first = [&](SolveHint expect) {
    const NodalSurface S = mesh.n_faces()
                               ? polygon_surface(mesh, report)
                               : cloud_surface(mesh.points(), mesh.soup().normals, report);
    const auto ops = std::make_shared<const Operators>(nodal_operators(S));
    terms = nodal_source_system(
        S, place_sources(*S.refined, refined_sources(mesh, *S.refined, S.face_offsets, given),
                         false, report));
    method = std::make_unique<SignedHeatSolver>(ops, 1, Task(), Diffusions{true, false}, expect);
    phi = method->solve(terms, options, {}, report);
  };
  std::printf("{\n \"first\": %.6g,\n", cpu_seconds([&] { solve_first(SolveHint::single_rhs); }));
  std::ofstream(argv[4], std::ios::binary)
      .write(reinterpret_cast<const char*>(phi.data()),
             static_cast<std::streamsize>(sizeof(double)) * phi.size());
  if (repeats > 0) solve_first(SolveHint::many_rhs);
  const struct {
    const char* name;
    Constraint constraint;
  } cases[] = {{"none", Constraint::none},
               {"zero_set", Constraint::zero_set},
               {"level_sets", Constraint::level_sets}};
  std::vector<double> times[3];
  for (int round = 0; round <= repeats; ++round)  // the first is not counted
    for (int c = 0; c < 3; ++c) {
      options.constraint = static_cast<int>(cases[c].constraint);
      const double t = cpu_seconds([&] { method->solve(terms, options, {}, report); });
      if (round > 0) times[c].push_back(t);
    }
  for (int c = 0; c < 3 && repeats > 0; ++c) {
    std::sort(times[c].begin(), times[c].end());
    std::printf(" \"%s\": %.6g,\n", cases[c].name, times[c][times[c].size() / 2]);
  }
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  std::printf(" \"peak_mb\": %.6g\n}\n", static_cast<double>(usage.ru_maxrss) / 1024);
  return 0;
}

}  // namespace
}  // namespace littoral

int main(int argc, char** argv) {
  if (argc != 5) {
    std::fprintf(stderr, "usage: littoral_domain_timer SURFACE SOURCES REPEATS VALUES\n");
    return 2;
  }
  try {
    return littoral::run(argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "littoral_domain_timer: %s\n", error.what());
    return 1;
  }
}
