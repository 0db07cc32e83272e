// How long does a solve go on after it is asked to stop? One run to its end, on one thread, and the
// longest time between two checkpoints in each stage, in which nothing stops it; then runs that are
// stopped after equal shares of its processor time.
// usage: littoral_cancellation STOPS MESH SUBDIVISIONS METHOD [OPTION VALUE]...
//        littoral_cancellation STOPS MESH grid:NODES METHOD [OPTION VALUE]...   in space

#include <pthread.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "api/space/sdf.h"
#include "api/surface/surface_domain.h"
#include "base/parallel.h"
#include "io/read.h"
#include "littoral/error.h"
#include "subdivided_meshes.h"

namespace littoral {
namespace {

double seconds(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Seconds that a solve has taken of its thread's processor: in all, or after the request to stop.
struct Outcome {
  double total = 0, after = 0;
  std::string stage;
  std::map<std::string, double> longest;  // from one checkpoint to the next, by the first's stage
};

using Job = std::function<void(const Task& task)>;

Outcome timed(const Job& job, double stop_after) {
  clockid_t processor{};
  pthread_getcpuclockid(pthread_self(), &processor);
  const CancelToken token;
  std::mutex mutex;
  std::string stage;
  Outcome out;
  double last = seconds(processor);
  const Task task(token, [&](double, const std::string& name) {
    const std::lock_guard lock(mutex);
    const double now = seconds(processor);
    out.longest[stage] = std::max(out.longest[stage], now - last);
    last = now;
    stage = name;
  });
  std::atomic<bool> over{false};
  double asked = 0;
  const double start = seconds(processor);
  std::thread watcher([&] {
    if (!(stop_after > 0)) return;
    // A library call runs on a thread of its own while the solving one waits: process time then.
    const double begin = seconds(CLOCK_PROCESS_CPUTIME_ID);
    while (!over && seconds(CLOCK_PROCESS_CPUTIME_ID) - begin < stop_after)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    {
      const std::lock_guard lock(mutex);
      out.stage = stage;
    }
    asked = seconds(processor);
    token.cancel();
  });
  try {
    job(task);
  } catch (const Cancelled&) {
  }
  const double end = seconds(processor);
  over = true;
  watcher.join();
  out.total = end - start;
  out.after = asked > 0 ? std::max(0.0, end - asked) : 0;
  return out;
}

Job on_grid(const PolygonSoup& soup, int nodes, const AnyMethod& method) {
  GridOptions options;
  options.resolution = nodes;
  return [soup, method, grid = choose_grid(soup, options)](const Task& task) {
    Report report;
    grid_distance(soup, grid, {method}, task, report);
  };
}

Job on_surface(PolygonSoup soup, int subdivisions, const AnyMethod& method) {
  const VecX height = (soup.points.rowwise() - soup.points.row(0)).rowwise().norm();
  std::vector<int> curve = test::loop_at(soup, height, 0.3 * height.maxCoeff());
  for (int k = 0; k < subdivisions; ++k) soup = test::quartered(soup, &curve);
  const auto mesh = std::make_shared<const SurfaceMesh>(soup);
  Sources sources;
  sources.curves.emplace_back();
  for (int v : curve) sources.curves[0].nodes.push_back(SurfacePoint::at_vertex(v));
  std::printf("%d faces\n", mesh->n_faces());
  return [mesh, sources, method](const Task& task) {
    Report report;
    solve_once(method, domain_of(*mesh), sources, task, report);
  };
}

int run(int argc, char** argv) {
  set_thread_count(1);
  const int stops = std::atoi(argv[1]);
  const PolygonSoup soup = io::read_surface(argv[2]);
  const std::string domain = argv[3], in_space = "grid:";
  OptionValues options;
  for (int k = 5; k + 1 < argc; k += 2) options.emplace_back(argv[k], argv[k + 1]);
  const AnyMethod method = AnyMethod::named(argv[4], options);
  const Job job = domain.starts_with(in_space)
                      ? on_grid(soup, std::stoi(domain.substr(in_space.size())), method)
                      : on_surface(soup, std::stoi(domain), method);

  const double before = seconds(CLOCK_PROCESS_CPUTIME_ID);
  for (const auto& [stage, longest] : timed(job, 0).longest)
    std::printf("%.3f at most between two checkpoints in '%s'\n", longest, stage.c_str());
  const double all = seconds(CLOCK_PROCESS_CPUTIME_ID) - before;
  std::printf("%.2f processor seconds\n", all);
  std::map<std::string, std::pair<int, double>> worst;  // per stage: stops, the longest wait
  for (int k = 0; k < stops; ++k) {
    const Outcome o = timed(job, all * (k + 0.5) / stops);
    auto& [n, longest] = worst[o.stage];
    ++n;
    longest = std::max(longest, o.after);
    std::printf("stopped after %.2f in '%s': %.3f\n", all * (k + 0.5) / stops, o.stage.c_str(),
                o.after);
    std::fflush(stdout);
  }
  for (const auto& [stage, w] : worst)
    std::printf("| %s | %d | %.3f |\n", stage.c_str(), w.first, w.second);
  return 0;
}

}  // namespace
}  // namespace littoral

int main(int argc, char** argv) {
  if (argc < 5) {
    std::fprintf(stderr,
                 "usage: littoral_cancellation STOPS MESH SUBDIVISIONS|grid:NODES METHOD [OPTION "
                 "VALUE]...\n");
    return 2;
  }
  try {
    return littoral::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "littoral_cancellation: %s\n", error.what());
    return 1;
  }
}
