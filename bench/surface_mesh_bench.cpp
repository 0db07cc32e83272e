// Connectivity of a mesh from its faces: time per face should not grow with their number.

#include <benchmark/benchmark.h>

#include <array>

#include "littoral/domain/surface_mesh.h"

namespace {

/// A square of n x n cells, two triangles each.
littoral::PolygonSoup square(int n) {
  littoral::PolygonSoup soup;
  soup.points.resize((n + 1) * (n + 1), 3);
  for (int v = 0; v < soup.points.rows(); ++v) soup.points.row(v) << v % (n + 1), v / (n + 1), 0;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * (n + 1) + i, b = a + 1, c = b + n + 1, d = c - 1;
      soup.add_face(std::array{a, b, c});
      soup.add_face(std::array{a, c, d});
    }
  return soup;
}

void build_surface_mesh(benchmark::State& state) {
  const littoral::PolygonSoup soup = square(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(littoral::SurfaceMesh(soup));
  state.SetItemsProcessed(state.iterations() * soup.n_faces());
}
BENCHMARK(build_surface_mesh)->Arg(100)->Arg(300)->Arg(1000)->Unit(benchmark::kMillisecond);

}  // namespace
