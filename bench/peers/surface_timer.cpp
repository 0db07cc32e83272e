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
#include <string>
#include <vector>

#include "api/surface/surface_domain.h"
#include "base/parallel.h"
#include "base/platform/memory.h"
#include "io/read.h"

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

/// The middle of `repeats` solves by one solver, after one that makes what they share; the sources
/// alternate.
double solves(const SignedHeat& method, const SurfaceDomain& domain,
              const std::vector<const Sources*>& sources, int repeats) {
  Report report;
  const auto solver = prepare(AnyMethod(method), domain, SolveHint::many_rhs, {}, report);
  std::vector<double> times;
  for (int round = 0; round <= repeats; ++round) {
    const Sources& next = *sources[static_cast<std::size_t>(round) % sources.size()];
    const double t = seconds([&] { solver->solve(next, {}, report); });
    if (round > 0) times.push_back(t);
  }
  return median(std::move(times));
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

  const SurfaceDomain domain = domain_of(mesh);
  const SignedHeat zero_set{.time_scale = 1, .constraint = Constraint::zero_set};
  const SignedHeat none{.time_scale = 1, .constraint = Constraint::none};
  VecX phi;
  say("first",
      seconds([&] { phi = solve_once(AnyMethod(zero_set), domain, sources, {}, report).values; }));
  say("first_peak_mb", peak_megabytes());
  std::ofstream(argv[5], std::ios::binary)
      .write(reinterpret_cast<const char*>(phi.data()),
             static_cast<std::streamsize>(sizeof(double)) * phi.size());
  if (repeats > 0) {
    SignedHeat level_sets = none, soft = none, preserved_normals = none;
    level_sets.constraint = Constraint::level_sets;
    soft.soft = 100;
    preserved_normals.preserve_normals = true;
    const auto say_solves = [&](const char* name, const SignedHeat& method) {
      say(name, solves(method, domain, {&sources}, repeats));
    };
    say_solves("none", none);
    say_solves("zero_set", zero_set);
    say_solves("level_sets", level_sets);
    say_solves("soft", soft);
    say_solves("preserved_normals", preserved_normals);
    say("moved_curve_zero_set", solves(zero_set, domain, {&others, &sources}, repeats));
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
