// How long does a solve go on after it is asked to stop? One run to its end; then runs on one
// thread that are stopped after equal shares of its processor time.
// usage: littoral_cancellation STOPS MESH SUBDIVISIONS METHOD [OPTION VALUE]...

#include <pthread.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <map>
#include <mutex>
#include <string>
#include <thread>

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
};

Outcome solve(const SurfaceMesh& mesh, const Sources& sources, const AnyMethod& method,
              double stop_after) {
  clockid_t processor{};
  pthread_getcpuclockid(pthread_self(), &processor);
  const CancelToken token;
  std::mutex mutex;
  std::string stage;
  const Task task(token, [&](double, const std::string& name) {
    const std::lock_guard lock(mutex);
    stage = name;
  });
  Outcome out;
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
    Report report;
    solve_once(method, domain_of(mesh), sources, task, report);
  } catch (const Cancelled&) {
  }
  const double end = seconds(processor);
  over = true;
  watcher.join();
  out.total = end - start;
  out.after = asked > 0 ? std::max(0.0, end - asked) : 0;
  return out;
}

int run(int argc, char** argv) {
  set_thread_count(1);
  const int stops = std::atoi(argv[1]);
  PolygonSoup soup = io::read_surface(argv[2]);
  const VecX height = (soup.points.rowwise() - soup.points.row(0)).rowwise().norm();
  std::vector<int> curve = test::loop_at(soup, height, 0.3 * height.maxCoeff());
  for (int k = 0; k < std::atoi(argv[3]); ++k) soup = test::quartered(soup, &curve);
  const SurfaceMesh mesh(soup);
  Sources sources;
  sources.curves.emplace_back();
  for (int v : curve) sources.curves[0].nodes.push_back(SurfacePoint::at_vertex(v));
  OptionValues options;
  for (int k = 5; k + 1 < argc; k += 2) options.emplace_back(argv[k], argv[k + 1]);
  const AnyMethod method = AnyMethod::named(argv[4], options);

  const double before = seconds(CLOCK_PROCESS_CPUTIME_ID);
  solve(mesh, sources, method, 0);
  const double all = seconds(CLOCK_PROCESS_CPUTIME_ID) - before;
  std::printf("%d faces, %.2f processor seconds\n", mesh.n_faces(), all);
  std::map<std::string, std::pair<int, double>> worst;  // per stage: stops, the longest wait
  for (int k = 0; k < stops; ++k) {
    const Outcome o = solve(mesh, sources, method, all * (k + 0.5) / stops);
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
                 "usage: littoral_cancellation STOPS MESH SUBDIVISIONS METHOD [OPTION VALUE]...\n");
    return 2;
  }
  try {
    return littoral::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "littoral_cancellation: %s\n", error.what());
    return 1;
  }
}
