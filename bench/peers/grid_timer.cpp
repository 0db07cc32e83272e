// Exact distance with sign at the nodes of a cube, timed for grids.py.
// usage: littoral_grid_timer MESH NODES THREADS OUT
//        NODES along each side, at -1 + 2 i / NODES; OUT: doubles as the machine has them, x
//        fastest
// Prints processor and clock seconds of what is prepared, and of the nodes.

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <optional>

#include "base/parallel.h"
#include "io/read.h"
#include "methods/implicit/completed.h"
#include "spatial/triangulate.h"
#include "timed.h"

using namespace littoral;

int main(int count, char** words) {
  if (count != 5) {
    std::fprintf(stderr, "usage: littoral_grid_timer MESH NODES THREADS OUT\n");
    return 2;
  }
  set_thread_count(std::atoi(words[3]));
  const PolygonSoup soup = triangulate(io::read_surface(words[1]));
  const MatX3i faces = triangles_of(soup);
  const int n = std::atoi(words[2]);
  const Grid grid{{n, n, n}, Vec3::Constant(-1), Vec3::Constant(2.0 / n)};
  Report report;
  std::optional<CompletedSurface> surface;
  VecX values;
  timed([&] { surface.emplace(soup.points, faces, 2.0 / n, false, Task(), report); });
  timed([&] { values = surface->on_grid(grid, Task()); });
  std::ofstream(words[4], std::ios::binary)
      .write(reinterpret_cast<const char*>(values.data()),
             std::streamsize(std::size_t(values.size()) * sizeof(double)));
  return 0;
}
