// Exact polyhedral distance from one vertex and from a curve: time and windows a triangle, beside
// the simple search of the tests, or beside itself with a limit on windows.
//
// usage: littoral_exact_speed [--simple | --limit WINDOWS_A_TRIANGLE] [--rounds N] MESH...
// prints Markdown; medians of processor time on one thread; differences in % of the largest
// distance

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <iostream>
#include <string>

#include "littoral/littoral.h"
#include "methods/geodesic/exact_polyhedral.h"
#include "simple_exact.h"

using namespace littoral;

namespace {

struct Measured {
  VecX distance;  // input units
  double seconds = 0, windows = 0;
};

template <class Run>
Measured median(int rounds, const Run& run) {
  Measured last;
  std::vector<double> seconds;
  for (int i = 0; i < rounds; ++i) {
    const std::clock_t start = std::clock();
    last = run();
    seconds.push_back(double(std::clock() - start) / CLOCKS_PER_SEC);
  }
  std::nth_element(seconds.begin(), seconds.begin() + rounds / 2, seconds.end());
  last.seconds = seconds[std::size_t(rounds) / 2];
  return last;
}

Measured exact(const IntrinsicTriangulation& T, const TriangleSources& on, double most_windows) {
  Report report;
  Measured m;
  m.distance = exact_polyhedral(T, on, {}, report, {most_windows, 0}).distance;
  m.windows = report.iterations.front().second;
  return m;
}

Measured simple(const IntrinsicTriangulation& T, const TriangleSources& on) {
  Measured m;
  std::tie(m.distance, m.windows) = test::simple_exact(T, on);
  m.distance *= T.unit;
  return m;
}

/// Largest and mean difference over the largest distance.
std::string difference(const VecX& a, const VecX& b) {
  double worst = 0, sum = 0, largest = 0;
  int n = 0;
  for (Eigen::Index v = 0; v < a.size(); ++v) {
    if (!std::isfinite(a[v])) continue;
    ++n;
    largest = std::max(largest, a[v]);
    worst = std::max(worst, std::abs(a[v] - b[v]));
    sum += std::abs(a[v] - b[v]);
  }
  std::ostringstream text;
  text.precision(2);
  text << 100 * worst / largest << " / " << 100 * sum / n / largest;
  return text.str();
}

/// From one vertex, and from a polyline of vertices across the mesh.
std::vector<std::pair<std::string, Sources>> all_sources(int n) {
  return {{"vertex", Sources(SurfacePoint::at_vertex(0))},
          {"curve", Sources().add(Curve::along_vertices({0, n / 5, n / 3, n / 2}))}};
}

}  // namespace

int main(int argc, char** argv) {
  int rounds = 3;
  bool beside_simple = false;
  double limit = 0;
  std::vector<std::string> files;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--simple")
      beside_simple = true;
    else if (word == "--limit" && i + 1 < argc)
      limit = std::atof(argv[++i]);
    else if (word == "--rounds" && i + 1 < argc)
      rounds = std::max(1, std::atoi(argv[++i]));
    else
      files.push_back(word);
  }
  if (files.empty())
    return std::cerr << "usage: littoral_exact_speed [--simple | --limit X] MESH...\n", 2;
  const bool beside = beside_simple || limit > 0;
  std::cout << "| mesh | triangles | from | us | windows |"
            << (beside ? (limit > 0 ? " limited: us |" : " simple: us |") : "")
            << (beside ? " windows | difference, largest / mean |" : "")
            << "\n|---|---|---|---|---|" << (beside ? "---|---|---|\n" : "\n");
  for (const std::string& file : files) {
    const SurfaceMesh mesh(read_mesh(file).soup());
    Report report;
    const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
    const double n = T.n_faces();
    for (const auto& [name, sources] : all_sources(mesh.n_vertices())) try {
        const TriangleSources on = triangle_sources(mesh, T, place_sources(mesh, sources, report));
        const Measured best = median(rounds, [&] { return exact(T, on, 0); });
        std::cout.precision(3);
        std::cout << "| " << file.substr(file.rfind('/') + 1) << " | " << T.n_faces() << " | "
                  << name << " | " << 1e6 * best.seconds / n << " | " << best.windows / n << " |";
        if (beside) {
          const Measured other = limit > 0 ? median(rounds, [&] { return exact(T, on, limit * n); })
                                           : median(1, [&] { return simple(T, on); });
          std::cout << " " << 1e6 * other.seconds / n << " | " << other.windows / n << " | "
                    << difference(best.distance, other.distance) << " |";
        }
        std::cout << std::endl;
      } catch (const Error& error) {
        std::cerr << file << ": " << error.what() << "\n";
      }
  }
}
