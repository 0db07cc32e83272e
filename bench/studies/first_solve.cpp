// The first signed-heat solve of a mesh that is in memory: connectivity, operators, factors, solve
// and zero set, on one thread.
// usage: littoral_first_solve ROUNDS (MESH SOURCES)... [VALUES]
//
// Every round solves on each mesh, so that all but the first find memory that the process has had
// before. Prints user and system seconds of each, and the clock of its stages; writes the last
// distances as doubles to VALUES.

#include <sys/resource.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include "api/surface/surface_domain.h"
#include "base/parallel.h"
#include "io/read.h"

namespace littoral {
namespace {

struct Used {
  double user = 0, system = 0;
  long faults = 0;

  static Used so_far() {
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    const auto seconds = [](const timeval& t) {
      return double(t.tv_sec) + 1e-6 * double(t.tv_usec);
    };
    return {seconds(used.ru_utime), seconds(used.ru_stime), used.ru_minflt};
  }
};

int run(int argc, char** argv) {
  set_thread_count(1);
  const int rounds = std::atoi(argv[1]), meshes = (argc - 2) / 2;
  VecX phi;
  std::printf(
      "| mesh | round | user s | system s | pages touched | stages, clock s |\n"
      "|---|---|---|---|---|---|\n");
  for (int round = 0; round < rounds; ++round)
    for (int m = 0; m < meshes; ++m) {
      const std::string file = argv[2 + 2 * m];
      PolygonSoup soup = io::read_surface(file);
      Report report;
      const Sources sources = io::read_sources(argv[3 + 2 * m], SurfaceMesh(soup), 0, report);
      const Used before = Used::so_far();
      const SurfaceMesh mesh(std::move(soup));
      phi = solve_once(AnyMethod(SignedHeat{}), domain_of(mesh), sources, {}, report).values;
      const Used after = Used::so_far();
      std::string stages;
      for (const auto& [stage, seconds] : report.timings) {
        char text[64];
        std::snprintf(text, sizeof text, "%s %.3f ", stage.c_str(), seconds);
        stages += text;
      }
      std::printf("| %s | %d | %.3f | %.3f | %ld | %s|\n",
                  file.substr(file.find_last_of('/') + 1).c_str(), round + 1,
                  after.user - before.user, after.system - before.system,
                  after.faults - before.faults, stages.c_str());
    }
  if (argc % 2 != 0)
    std::ofstream(argv[argc - 1], std::ios::binary)
        .write(reinterpret_cast<const char*>(phi.data()),
               static_cast<std::streamsize>(sizeof(double)) * phi.size());
  return 0;
}

}  // namespace
}  // namespace littoral

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fprintf(stderr, "usage: littoral_first_solve ROUNDS (MESH SOURCES)... [VALUES]\n");
    return 2;
  }
  try {
    return littoral::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "littoral_first_solve: %s\n", error.what());
    return 1;
  }
}
