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
#include <vector>

#include "api/surface/surface_domain.h"
#include "io/read.h"

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
  const SurfaceDomain domain = domain_of(mesh);
  const SignedHeat zero_set{.time_scale = 1, .constraint = Constraint::zero_set};
  VecX phi;
  std::printf("{\n \"first\": %.6g,\n", cpu_seconds([&] {
                phi = solve_once(AnyMethod(zero_set), domain, given, {}, report).values;
              }));
  std::ofstream(argv[4], std::ios::binary)
      .write(reinterpret_cast<const char*>(phi.data()),
             static_cast<std::streamsize>(sizeof(double)) * phi.size());
  const struct {
    const char* name;
    Constraint constraint;
  } cases[] = {{"none", Constraint::none},
               {"zero_set", Constraint::zero_set},
               {"level_sets", Constraint::level_sets}};
  for (const auto& c : cases) {
    if (repeats <= 0) break;
    SignedHeat method = zero_set;
    method.constraint = c.constraint;
    const auto solver = prepare(AnyMethod(method), domain, SolveHint::many_rhs, {}, report);
    std::vector<double> times;
    for (int round = 0; round <= repeats; ++round) {
      const double t = cpu_seconds([&] { solver->solve(given, {}, report); });
      if (round > 0) times.push_back(t);  // the first makes what the others share
    }
    std::sort(times.begin(), times.end());
    std::printf(" \"%s\": %.6g,\n", c.name, times[times.size() / 2]);
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
