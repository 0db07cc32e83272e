// Points as tori: processor time of fitting and asking, errors and memory, on tori of ever more
// random points. usage: littoral_tori_speed POINTS...    Prints Markdown; one thread.

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "methods/tori/tori.h"
#include "torus_helpers.h"

namespace littoral {
namespace {

const double pi = std::acos(-1.0);
using test::tube;

/// Microseconds of processor time a call, for `count` calls in one.
double microseconds(int count, const std::function<void()>& calls) {
  const std::clock_t start = std::clock();
  calls();
  return 1e6 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC / count;
}

/// Memory of the process [bytes].
double memory() {
  std::ifstream in("/proc/self/statm");
  double all = 0, resident = 0;
  in >> all >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE));
}

void row(int n) {
  constexpr int queries = 20000, repeats = 5;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1.5, 1.5);
  std::normal_distribution<double> normal;
  const OrientedPoints cloud = test::torus_cloud(n, random);
  const double spacing = std::sqrt(4 * pi * pi * tube / n);
  const PointTree tree(cloud.points);
  std::vector<Torus> fitted;
  const TorusFit learned = TorusFit::by(LearnedFit::built_in());
  const double by_net = microseconds(n, [&] { fitted = fit_tori(cloud, tree, learned); });
  const double fit = microseconds(n, [&] { fitted = fit_tori(cloud, tree, TorusFit::exact()); });
  const double before = memory();
  double built = 0;
  const auto make = [&](ToriPrecision precision) {
    std::unique_ptr<const ToriDistance> out;
    built = microseconds(
        n, [&] { out = std::make_unique<const ToriDistance>(cloud.points, fitted, precision); });
    return out;
  };
  const std::unique_ptr<const ToriDistance> full = make(ToriPrecision::full);
  const double bytes = (memory() - before) / n;
  const std::unique_ptr<const ToriDistance> single = make(ToriPrecision::single);
  std::printf("| %d | %.2f | %.2f | %.2f | %.0f |", n, fit, by_net, built, bytes);
  for (const double reach : {1.0, 8.0, 0.0}) {  // spacings from a point; 0: anywhere in a box
    std::vector<Vec3> places;
    for (int i = 0; i < queries; ++i) {
      const Vec3 p = cloud.points.row(static_cast<int>(random() % static_cast<unsigned>(n)));
      const Vec3 away(normal(random), normal(random), normal(random));
      const Vec3 any(uniform(random), uniform(random), uniform(random));
      places.push_back(reach > 0 ? Vec3(p + reach * spacing * away) : any);
    }
    double error = 0, slow = 1e9, fast = 1e9;
    for (int repeat = 0; repeat < repeats; ++repeat) {
      error = 0;
      slow = std::min(slow, microseconds(queries, [&] {
                        for (const Vec3& x : places) {
                          const double exact = std::hypot(std::hypot(x[0], x[1]) - 1, x[2]) - tube;
                          error += std::abs(full->value(x) - exact) / queries;
                        }
                      }));
      double sum = 0;
      fast = std::min(fast, microseconds(queries, [&] {
                        for (const Vec3& x : places) sum += single->value(x);
                      }));
      if (!std::isfinite(sum)) std::printf("not finite");
    }
    double with_gradient = 1e9, off = 0;
    for (int repeat = 0; repeat < repeats; ++repeat) {
      double sum = 0;
      with_gradient = std::min(with_gradient, microseconds(queries, [&] {
                                 for (const Vec3& x : places) sum += full->at(x).gradient.norm();
                               }));
      if (!std::isfinite(sum)) std::printf("not finite");
    }
    for (const Vec3& x : places)
      off = std::max(off, (full->at(x).gradient - full->jet(x).gradient).norm());
    if (off > 1e-6) std::fprintf(stderr, "gradients differ from plain sums by %.1e\n", off);
    MatX3 batch(queries, 3);
    for (int i = 0; i < queries; ++i) batch.row(i) = places[i];
    double together = 1e9;
    for (int repeat = 0; repeat < repeats; ++repeat)
      together = std::min(together, microseconds(queries, [&] {
                            const VecX values = evaluate(*full, batch, nullptr, Task());
                            if (!values.allFinite()) std::printf("not finite");
                          }));
    std::printf(" %.2f, %.2f, %.2f, %.2f, %.1e |", slow, with_gradient, together, fast, error);
  }
  std::printf("\n");
  std::fflush(stdout);
}

}  // namespace
}  // namespace littoral

int main(int argc, char** argv) {
  littoral::set_thread_count(1);
  std::printf(
      "| points | fit, us a point | learned fit | tree and sides | bytes a point | query 1 spacing "
      "away: one, with gradient, many, single, us, error | 8 spacings | anywhere |\n"
      "|---|---|---|---|---|---|---|---|\n");
  for (int i = 1; i < argc; ++i) littoral::row(std::max(20, std::atoi(argv[i])));
  return 0;
}
