#pragma once
// One solver, many sets of sources.

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <span>
#include <utility>
#include <vector>

#include "api/method.h"
#include "base/parallel.h"
#include "base/platform/memory.h"

namespace littoral {

/// What `solve` gives for one set of sources.
template <class D>
struct Solved {
  typename D::Answer answer;
  Report report;
};

/// Solves for each set of sources by itself: the first alone, which makes what all share, the
/// others as many at once as the solver takes, on all threads as far as there is memory, of which
/// the caller keeps `kept` bytes. put(first, some) gets the solves of sources `first` and on, in
/// any order, from several threads. The same bits for any number of threads, and the loop's to
/// rounding. Throws what solve throws, of the lowest source that it was reached for.
template <class D>
void solve_many(const Solver<D>& solver, const std::vector<typename D::Sources>& sources,
                double kept, Task task,
                const std::function<void(std::size_t first, std::vector<Solved<D>>& some)>& put) {
  if (sources.empty()) return;
  const auto alone = [&](std::size_t i, const Task& stage) {
    Solved<D> one;
    one.answer = solver.solve(sources[i], stage, one.report);
    return one;
  };
  {
    std::vector<Solved<D>> first;
    first.push_back(alone(0, task.stage(1 / static_cast<double>(sources.size()), "solving")));
    put(0, first);
  }
  const Task rest = task.stage(1, "solving");
  const AtOnce at_once = solver.at_once();
  const double room = std::max(0.0, memory_to_use() - kept) / std::max(1.0, at_once.bytes);
  const std::size_t n = sources.size() - 1, width = room >= 1 ? at_once.sources : 1;
  const std::size_t groups = (n + width - 1) / width;
  std::atomic<std::size_t> finished{0};
  const auto solve_group = [&](std::size_t group) {
    const std::size_t first = 1 + group * width, end = std::min(sources.size(), first + width);
    rest.checkpoint(static_cast<double>(finished) / static_cast<double>(n));
    std::vector<Solved<D>> some(end - first);
    typename Solver<D>::Answers answers(some.size());
    if (width > 1) {
      std::vector<Report> reports(some.size());
      answers =
          solver.solve_together(std::span(sources).subspan(first, some.size()), rest, reports);
      for (std::size_t i = 0; i < some.size(); ++i)
        if (answers[i]) some[i] = {std::move(*answers[i]), std::move(reports[i])};
    }
    for (std::size_t i = 0; i < some.size(); ++i)
      if (!answers[i]) {
        rest.checkpoint(static_cast<double>(finished) / static_cast<double>(n));
        some[i] = alone(first + i, Task());
      }
    put(first, some);
    finished += some.size();
  };
  // No more side by side than there is room for.
  std::size_t in_a_row = 1;
  if (width > 1 && room < static_cast<double>(groups))
    in_a_row = std::size_t(std::ceil(static_cast<double>(groups) / std::floor(room)));
  parallel_for(groups, in_a_row, [&](std::size_t first, std::size_t end) {
    for (std::size_t group = first; group < end; ++group) solve_group(group);
  });
}

}  // namespace littoral
