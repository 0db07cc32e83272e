// Exact polyhedral distance from one vertex and from curves: time and windows a triangle, beside the
// simple search of the tests.
//
// usage: littoral_exact_speed [--simple] [--rounds N] MESH...    prints Markdown; medians of processor time, one thread

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <iostream>
#include <string>

#include "api/surface/surface_domain.h"
#include "littoral/littoral.h"
#include "methods/geodesic/exact_polyhedral.h"
#include "simple_exact.h"

using namespace littoral;

namespace {

template <class Run>
double median_seconds(int rounds, const Run& run) {
  std::vector<double> seconds;
  for (int i = 0; i < rounds; ++i) {
    const std::clock_t start = std::clock();
    run();
    seconds.push_back(double(std::clock() - start) / CLOCKS_PER_SEC);
  }
  std::nth_element(seconds.begin(), seconds.begin() + rounds / 2, seconds.end());
  return seconds[std::size_t(rounds) / 2];
}

/// From one vertex, and from a polyline of vertices across the mesh.
std::vector<std::pair<std::string, Sources>> all_sources(int n) {
  return {{"vertex", Sources(SurfacePoint::at_vertex(0))},
          {"curve", Sources().add(Curve::along_vertices({0, n / 5, n / 3, n / 2}))}};
}

}  // namespace

int main(int argc, char** argv) {
  int rounds = 3;
  bool simple = false;
  std::vector<std::string> files;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--simple")
      simple = true;
    else if (word == "--rounds" && i + 1 < argc)
      rounds = std::max(1, std::atoi(argv[++i]));
    else
      files.push_back(word);
  }
  if (files.empty()) return std::cerr << "usage: littoral_exact_speed [--simple] MESH...\n", 2;
  std::cout << "| mesh | triangles | from | us a triangle | windows a triangle | simple: us | "
               "windows | difference |\n|---|---|---|---|---|---|---|---|\n";
  for (const std::string& file : files) {
    const SurfaceMesh mesh(read_mesh(file).soup());
    Report report;
    const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
    for (const auto& [name, sources] : all_sources(mesh.n_vertices())) try {
        const TriangleSources on =
            triangle_sources(mesh, T, place_sources(mesh, sources, report));
        ExactDistance exact;
        Report last;
        const double per_triangle = 1e6 / T.n_faces();
        const double seconds = median_seconds(rounds, [&] {
          last = {};
          exact = exact_polyhedral(T, on, {}, last);
        });
        double windows = 0;
        for (const auto& [loop, count] : last.iterations)
          if (loop == "windows") windows = count;
        std::cout << "| " << file.substr(file.rfind('/') + 1) << " | " << T.n_faces() << " | "
                  << name << " | " << seconds * per_triangle << " | " << windows / T.n_faces();
        if (simple) {
          std::pair<VecX, double> old;
          const double slow = median_seconds(1, [&] { old = test::simple_exact(T, on); });
          double worst = 0, largest = 0;
          for (int v = 0; v < T.n_vertices; ++v) {
            if (!std::isfinite(old.first[v])) continue;
            largest = std::max(largest, old.first[v]);
            worst = std::max(worst, std::abs(exact.distance[v] / T.unit - old.first[v]));
          }
          std::cout << " | " << slow * per_triangle << " | " << old.second / T.n_faces() << " | "
                    << worst / largest;
        }
        std::cout << " |" << std::endl;
        for (const std::string& warning : last.warnings)
          if (warning.find("limit") != std::string::npos) std::cerr << warning << "\n";
      } catch (const Error& error) {
        std::cerr << file << ": " << error.what() << "\n";
      }
  }
}
