// Connectivity of a mesh from its faces: time per face should not grow with their number.

#include <benchmark/benchmark.h>

#include "domain/mesh/surface_mesh.h"
#include "test_meshes.h"

namespace {

void build_surface_mesh(benchmark::State& state) {
  const int n = static_cast<int>(state.range(0));
  const littoral::PolygonSoup soup = littoral::test::grid_soup(n, n);
  for (auto _ : state) benchmark::DoNotOptimize(littoral::SurfaceMesh(soup));
  state.SetItemsProcessed(state.iterations() * soup.n_faces());
}
BENCHMARK(build_surface_mesh)->Arg(100)->Arg(300)->Arg(1000)->Unit(benchmark::kMillisecond);

}  // namespace
