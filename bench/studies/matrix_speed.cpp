// Distances from many points to all vertices: by several right-hand sides at once and by a loop
// over solves, on the same factors.
// usage: littoral_matrix_speed SOURCES ROUNDS MESH METHOD...
// MESH: a file, or torus:N for one of N x N quads split in two.
//
// Both take turns; medians of all rounds, on one thread and on all. Prints Markdown.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "api/surface/pairs.h"
#include "base/parallel.h"
#include "io/read.h"
#include "one_call.h"
#include "test_meshes.h"

namespace littoral {
namespace {

struct Seconds {
  std::vector<double> processor, clock;

  template <class Body>
  void add(const Body& body) {
    const std::clock_t cpu = std::clock();
    const auto begin = std::chrono::steady_clock::now();
    body();
    clock.push_back(
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    processor.push_back(double(std::clock() - cpu) / CLOCKS_PER_SEC);
  }
};

double median(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  return 0.5 * (v[v.size() / 2] + v[(v.size() - 1) / 2]);
}

void run(std::size_t n_sources, int rounds, const SurfaceMesh& mesh, const std::string& method) {
  const SurfaceDomain domain = domain_of(mesh);
  std::mt19937 random(1);
  std::vector<SurfacePoint> points;
  while (points.size() < n_sources) {
    const int v = static_cast<int>(random() % static_cast<unsigned>(mesh.n_vertices()));
    if (mesh.vertex_component()[v] >= 0) points.push_back(SurfacePoint::at_vertex(v));
  }
  Report report;
  const auto solver =
      prepare(AnyMethod::named(method), domain, SolveHint::many_rhs, Task(), report);
  const test::OneByOne loop(solver);
  MatX at_once, one_by_one;
  for (const int threads : {1, 0}) {
    set_thread_count(threads);
    Seconds together, apart;
    for (int round = 0; round <= rounds; ++round) {
      Seconds first;  // makes what all share
      Report said;
      (round ? together : first).add([&] {
        at_once = distance_rows(*solver, domain, points, Task(), said);
      });
      (round ? apart : first).add([&] {
        one_by_one = distance_rows(loop, domain, points, Task(), said);
      });
    }
    double difference = 0;
    for (Eigen::Index i = 0; i < at_once.size(); ++i)
      if (at_once.data()[i] != one_by_one.data()[i])
        difference = std::max(difference, std::abs(at_once.data()[i] - one_by_one.data()[i]));
    const double a = median(together.processor), b = median(apart.processor);
    const double c = median(together.clock), d = median(apart.clock);
    double largest = 0;
    for (Eigen::Index i = 0; i < one_by_one.size(); ++i)
      if (std::isfinite(one_by_one.data()[i])) largest = std::max(largest, one_by_one.data()[i]);
    std::printf("| %s | %d | %d | %.3f | %.3f | %.2f | %.3f | %.3f | %.2f | %.1e |\n",
                method.c_str(), mesh.n_faces(), thread_count(), b, a, a / b, d, c, c / d,
                difference / largest);
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace littoral

int main(int argc, char** argv) {
  if (argc < 5) {
    std::fprintf(stderr, "usage: littoral_matrix_speed SOURCES ROUNDS MESH METHOD...\n");
    return 2;
  }
  const std::string name = argv[3], torus = "torus:";
  const int n = name.rfind(torus, 0) == 0 ? std::atoi(name.c_str() + torus.size()) : 0;
  const littoral::SurfaceMesh mesh(n > 0 ? littoral::test::torus_soup(n, n)
                                         : littoral::io::read_surface(name));
  std::printf(
      "| method | faces | threads | loop, processor s | at once | ratio | loop, clock s "
      "| at once | ratio | difference, of the largest |\n");
  std::printf("|---|---|---|---|---|---|---|---|---|---|\n");
  for (int i = 4; i < argc; ++i)
    littoral::run(static_cast<std::size_t>(std::atoi(argv[1])), std::atoi(argv[2]), mesh, argv[i]);
}
