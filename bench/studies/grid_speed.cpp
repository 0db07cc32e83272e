// Exact distance with sign at the nodes of a grid: all together, and node by node.
// usage: littoral_grid_speed [--threads N] [--alone] MESH NODES...
//        NODES: along the longest side of the grid, which reaches a quarter of the mesh beyond it
// Prints a row for each: microseconds a node, processor (of all threads) and clock; the same node
// by node, each with the nearest face of the one before as a hint, unless --alone; and how far both
// differ, in sizes of the mesh.

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>

#include "api/space/sdf.h"
#include "base/parallel.h"
#include "io/read.h"
#include "methods/implicit/completed.h"
#include "spatial/triangulate.h"

namespace {

using namespace littoral;

struct Seconds {
  double cpu, clock;
};

template <class Body>
Seconds timed(const Body& body) {
  const auto begin = std::chrono::steady_clock::now();
  const std::clock_t cpu = std::clock();
  body();
  return {double(std::clock() - cpu) / CLOCKS_PER_SEC,
          std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count()};
}

}  // namespace

int main(int count, char** words) {
  bool alone = false;
  int at = 1;
  for (; at < count && words[at][0] == '-'; ++at) {
    if (std::strcmp(words[at], "--alone") == 0) alone = true;
    if (std::strcmp(words[at], "--threads") == 0 && at + 1 < count)
      set_thread_count(std::atoi(words[++at]));
  }
  if (count - at < 2) {
    std::fprintf(stderr, "usage: littoral_grid_speed [--threads N] [--alone] MESH NODES...\n");
    return 2;
  }
  PolygonSoup soup = triangulate(io::read_surface(words[at]));
  const double size = bounding_box(soup).size().maxCoeff();
  soup.points /= size;
  const MatX3i faces = triangles_of(soup);
  Report report;
  const CompletedSurface surface(soup.points, faces, 0.01, false, Task(), report);
  std::printf(
      "| faces | nodes a side | nodes | us, processor | us, clock | node by node | differ |\n");
  std::printf("|---|---|---|---|---|---|---|\n");
  for (++at; at < count; ++at) {
    GridOptions options;
    options.resolution = std::atoi(words[at]);
    const Grid grid = choose_grid(soup, options);
    const double n = static_cast<double>(grid.n_nodes());
    VecX values, slow;
    const Seconds together = timed([&] { values = surface.on_grid(grid, Task()); });
    std::printf("| %d | %s | %.0f | %.3f | %.3f |", static_cast<int>(faces.rows()), words[at], n,
                together.cpu / n * 1e6, together.clock / n * 1e6);
    if (!alone) {
      const Seconds singly =
          timed([&] { slow = surface.PointwiseDistance::on_grid(grid, Task()); });
      std::printf(" %.3f | %.1e |\n", singly.cpu / n * 1e6, (values - slow).cwiseAbs().maxCoeff());
    } else {
      std::printf(" | |\n");
    }
    std::fflush(stdout);
  }
  return 0;
}
