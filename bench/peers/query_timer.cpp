// Closest points with the sign of the winding number, and winding numbers, timed for queries.py.
// usage: littoral_query_timer MESH QUERIES THREADS OUT
//        QUERIES, OUT: doubles as the machine has them, 3 a point; distances, then winding numbers
// Prints processor and clock seconds of: building for distances, distances, building for winding
// numbers, winding numbers.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>

#include "base/parallel.h"
#include "io/read.h"
#include "methods/implicit/closest_point.h"
#include "spatial/morton_order.h"
#include "spatial/triangulate.h"
#include "spatial/winding_number.h"
#include "timed.h"

using namespace littoral;

int main(int count, char** words) {
  if (count != 5) {
    std::fprintf(stderr, "usage: littoral_query_timer MESH QUERIES THREADS OUT\n");
    return 2;
  }
  set_thread_count(std::atoi(words[3]));
  const PolygonSoup soup = triangulate(io::read_surface(words[1]));
  const MatX3i faces = triangles_of(soup);
  const std::string bytes = io::read_bytes(words[2]);
  const auto n = static_cast<Eigen::Index>(bytes.size() / sizeof(double) / 3);
  MatX3 queries(n, 3);
  std::copy_n(bytes.data(), static_cast<std::size_t>(n) * 3 * sizeof(double),
              reinterpret_cast<char*>(queries.data()));
  VecX distances, windings(n);
  std::unique_ptr<const PointwiseDistance> distance;
  std::unique_ptr<const WindingNumber> winding;
  timed([&] { distance = closest_point_distance(soup.points, faces, SignRule::winding); });
  timed([&] { distances = evaluate(*distance, queries, nullptr, Task()); });
  timed([&] { winding = std::make_unique<WindingNumber>(soup.points, faces); });
  timed([&] {
    const std::vector<int> order = morton_order(queries);
    parallel_for(static_cast<std::size_t>(n), 1024, [&](std::size_t begin, std::size_t end) {
      for (std::size_t at = begin; at < end; ++at)
        windings[order[at]] = (*winding)(queries.row(order[at]));
    });
  });
  std::ofstream out(words[4], std::ios::binary);
  for (const VecX* v : {&distances, &windings})
    out.write(reinterpret_cast<const char*>(v->data()),
              static_cast<std::streamsize>(static_cast<std::size_t>(n) * sizeof(double)));
  return out ? 0 : 1;
}
