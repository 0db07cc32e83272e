// Times surface signed heat for bench/peers/compare.py, which runs it beside other programs.
// usage: littoral_surface_timer MESH SOURCES OTHER_SOURCES REPEATS VALUES wall|cpu
// Prints seconds, sizes and peak memory as JSON; writes the zero-set distances as doubles to
// VALUES. cpu: processor seconds on one thread, which a busy machine changes least.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fstream>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "base/platform/memory.h"
#include "domain/intrinsic/intrinsic_triangulation.h"
#include "io/read.h"
#include "methods/heat/signed_heat.h"
#include "operators/triangles.h"
#include "sources/pieces.h"
#include "sources/triangle_source_system.h"

namespace littoral {
namespace {

bool processor_time = false;

double now() {
  timespec t{};
  clock_gettime(processor_time ? CLOCK_PROCESS_CPUTIME_ID : CLOCK_MONOTONIC, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double seconds(const std::function<void()>& call) {
  const double start = now();
  call();
  return now() - start;
}

double median(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  return v.empty() ? 0 : 0.5 * (v[v.size() / 2] + v[(v.size() - 1) / 2]);
}

double peak_megabytes() { return peak_memory() / (1 << 20); }

SignedHeat constrained(Constraint constraint) {
  SignedHeat options;
  options.time_scale = 1;
  options.constraint = static_cast<int>(constraint);
  return options;
}

int run(char** argv) {
  processor_time = std::strcmp(argv[6], "cpu") == 0;
  if (processor_time) set_thread_count(1);
  const SurfaceMesh mesh(io::read_surface(argv[1]));
  const int repeats = std::atoi(argv[4]);
  Report report;
  const Sources sources = io::read_sources(argv[2], mesh, 0, report);
  const Sources others = io::read_sources(argv[3], mesh, 0, report);
  auto say = [](const char* name, double value) { std::printf(" \"%s\": %.6g,\n", name, value); };
  std::printf("{\n");
  say("faces", mesh.n_faces());

  VecX phi;
  say("first", seconds([&] {
        const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
        const auto ops = std::make_shared<const Operators>(triangle_operators(T));
        const auto terms = source_system(mesh, T, place_sources(mesh, sources, report));
        const SignedHeatSolver method(ops, 1, {}, {true, false}, SolveHint::single_rhs);
        phi = method.solve(terms, constrained(Constraint::zero_set), {}, report);
      }));
  say("first_peak_mb", peak_megabytes());
  std::ofstream(argv[5], std::ios::binary)
      .write(reinterpret_cast<const char*>(phi.data()),
             static_cast<std::streamsize>(sizeof(double)) * phi.size());
  if (repeats > 0) {
    const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
    const auto ops = std::make_shared<const Operators>(triangle_operators(T));
    const SignedHeatSolver method(ops, 1, {}, {true, false});
    const auto terms = source_system(mesh, T, place_sources(mesh, sources, report));
    struct Case {
      const char* name;
      SignedHeat options;
    };
    std::vector<Case> cases = {{"none", constrained(Constraint::none)},
                               {"zero_set", constrained(Constraint::zero_set)},
                               {"level_sets", constrained(Constraint::level_sets)},
                               {"soft", constrained(Constraint::none)},
                               {"preserved_normals", constrained(Constraint::none)}};
    cases[3].options.soft = 100;
    cases[4].options.preserve_normals = true;
    std::vector<std::vector<double>> times(cases.size());
    std::vector<double> moved;
    for (int round = 0; round <= repeats; ++round) {  // the first is not counted
      for (std::size_t c = 0; c < cases.size(); ++c) {
        const double t = seconds([&] { method.solve(terms, cases[c].options, {}, report); });
        if (round > 0) times[c].push_back(t);
      }
      const Sources& next = round % 2 ? sources : others;
      const double t = seconds([&] {
        const auto fresh = source_system(mesh, T, place_sources(mesh, next, report));
        method.solve(fresh, cases[1].options, {}, report);
      });
      if (round > 0) moved.push_back(t);
    }
    for (std::size_t c = 0; c < cases.size(); ++c) say(cases[c].name, median(times[c]));
    say("moved_curve_zero_set", median(moved));
  }
  std::printf(" \"peak_mb\": %.6g\n}\n", peak_megabytes());
  return 0;
}

}  // namespace
}  // namespace littoral

int main(int argc, char** argv) {
  if (argc != 7) {
    std::fprintf(stderr,
                 "usage: littoral_surface_timer MESH SOURCES OTHER_SOURCES REPEATS VALUES "
                 "wall|cpu\n");
    return 2;
  }
  try {
    return littoral::run(argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "littoral_surface_timer: %s\n", error.what());
    return 1;
  }
}
