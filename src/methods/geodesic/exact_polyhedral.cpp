#include "methods/geodesic/exact_polyhedral.h"

#include <algorithm>
#include <array>
#include <deque>
#include <memory>
#include <sstream>
#include <utility>

#include "base/index.h"
#include "base/option_table.h"
#include "base/thread_crew.h"
#include "methods/geodesic/ray_crossing.h"
#include "methods/heat/finalize.h"

namespace littoral {

namespace {

/// How many triangles paths run straight through after each time the limit on windows is met.
constexpr std::array<int, 4> straight = {Window::deep + 1, 16, 4, 0};
constexpr double most_held = 3e7;  // windows, 2 GB
constexpr double together_share =
    0.5;                               // of the wait of an edge: what is due until then goes on too
constexpr double most_together = 3e4;  // windows
constexpr double worth_threads = 300;  // windows to carry on; four times as many to put away

class Front {
 public:
  Front(const IntrinsicTriangulation& T, double most_windows, double tolerance)
      : search_(T), T_(T), most_windows_(most_windows) {
    search_.tolerance = tolerance;
    crew_.push_back(std::make_unique<RayCrossing>(search_));
  }

  void run(const std::vector<PolyhedralStart>& starts, const Task& task) {
    double steps = 0, next_check = 0;
    for (std::size_t started = 0;;) {
      while (started < starts.size() &&
             (queue_.empty() || starts[started].value <= queue_.front().key))
        begin(starts[started++]);
      if (queue_.empty()) break;
      const double now = queue_.front().key, load = collect();
      steps += double(together_.size());
      if (steps + windows() > next_check) {
        task.checkpoint(double(n_reached_) / T_.n_vertices);
        next_check = steps + windows() + 4096;
      }
      go_on(load);
      forget_passed(now);
      const bool full = windows() > budget_ || held() > most_held * double(1 + relaxed_);
      if (full && relaxed_ + 1 < straight.size()) relax();
    }
  }

  const VecX& distance() const { return search_.distance; }
  const VecXi& nearest() const { return search_.nearest; }
  /// What distances may be off by, as a share of them, at most.
  double largest_error() const {
    double most = 0;
    for (int v = 0; v < T_.n_vertices; ++v)
      if (search_.error[v] > 0) most = std::max(most, search_.error[v] / search_.distance[v]);
    return most;
  }
  double windows() const {
    double sum = 0;
    for (const auto& member : crew_) sum += member->envelopes.n_taken();
    return sum;
  }
  /// Distances up to here are exact.
  double exact_within() const { return exact_within_; }

 private:
  struct Entry {
    double key;
    int id;      // of an edge with open windows; -1 - vertex
    float wait;  // of the edge
    bool operator<(const Entry& other) const {
      return key > other.key || (key == other.key && id > other.id);
    }
  };

  double held() const {
    double sum = 0;
    for (const auto& member : crew_) sum += member->envelopes.n_held();
    return sum;
  }

  void begin(const PolyhedralStart& start) {
    if (start.vertex < 0) {
      crew_[0]->clear();
      crew_[0]->leave_source(start);
      settle(1, 0);
    } else if (offer({start.vertex, start.value, start.source, {}, 0})) {
      push({start.value, -1 - start.vertex, 0});
    }
  }
  void push(Entry entry) {
    queue_.push_back(entry);
    std::push_heap(queue_.begin(), queue_.end());
  }
  bool offer(const RayCrossing::Offer& better) {
    const auto& [v, distance, source, arrival, error] = better;
    if (!(distance < search_.distance[v])) return false;
    if (search_.distance[v] == infinity) ++n_reached_;
    search_.distance[v] = distance;
    search_.nearest[v] = source;
    search_.arrival[v] = arrival;
    search_.error[v] = error;
    return true;
  }

  /// Takes from the queue what goes on together: what is due before anything of it can have changed
  /// the rest by much. The number of windows.
  double collect() {
    together_.clear();
    double load = 0, until = infinity;
    std::size_t n_seen = 0;
    const auto see = [&] {
      for (; n_seen < together_.size(); ++n_seen) {
        if (together_[n_seen] < 0) continue;
        WindowList& list = search_.lists[together_[n_seen]];
        list.due = infinity;
        load += double(list.windows.size());
      }
    };
    while (!queue_.empty() && queue_.front().key <= until && load < most_together) {
      const auto [key, id, wait] = queue_.front();
      std::pop_heap(queue_.begin(), queue_.end());
      queue_.pop_back();
      if (id < 0) {
        if (key > search_.distance[-1 - id]) continue;
        for (const int side : search_.pages.around(-1 - id))
          until = std::min(until, key + together_share * wait_of(T_.side_edge(side / 3, side % 3)));
      } else {
        __builtin_prefetch(&search_.lists[id], 1);
        until = std::min(until, key + together_share * double(wait));
      }
      together_.push_back(id);
      if (together_.size() == n_seen + 32) see();
    }
    see();
    return load;
  }
  double wait_of(int edge) const { return search_.pages.edges[edge].wait; }

  /// Lets all that was collected go on. Nobody sees what another of them sends: so they can do it
  /// at the same time, and the answer is the same whether they do or not.
  void go_on(double load) {
    const std::size_t n = together_.size(), n_threads = std::size_t(threads_.size());
    const std::size_t parts =
        load > worth_threads && n_threads > 1 ? std::min<std::size_t>(n, 4 * n_threads) : 1;
    while (crew_.size() < parts) crew_.push_back(std::make_unique<RayCrossing>(search_));
    threads_.run(parts, [&](std::size_t part) {
      RayCrossing& member = *crew_[part];
      member.clear();
      const std::size_t end = (part + 1) * n / parts;
      for (std::size_t i = part * n / parts; i < end; ++i) {
        for (int step = 0; step < 3; ++step)
          if (i + 3 - step < end && together_[i + 3 - step] >= 0)
            member.fetch(together_[i + 3 - step], step);
        if (together_[i] < 0)
          member.leave_vertex(-1 - together_[i]);
        else
          member.go_on(together_[i]);
      }
    });
    settle(parts, load);
    for (const int id : together_)
      if (id >= 0) gone_on_.push_back({passed(id), id});
  }

  /// Puts what the first members of the crew have collected where it belongs.
  void settle(std::size_t parts, double load) {
    for (std::size_t part = 0; part < parts; ++part)
      for (const RayCrossing::Offer& o : crew_[part]->offers())
        if (offer(o) && search_.pages.bends[o.vertex]) push({o.distance, -1 - o.vertex, 0});
    const std::size_t n = load > 4 * worth_threads ? std::min<std::size_t>(parts, 16) : 1;
    threads_.run(n, [&](std::size_t share) {
      for (std::size_t part = 0; part < parts; ++part)
        for (std::size_t i = 0; i < crew_[part]->n_batches(); ++i) {
          RayCrossing::Batch& batch = crew_[part]->batch(i);
          if (i + 4 < crew_[part]->n_batches()) {
            __builtin_prefetch(&search_.lists[crew_[part]->batch(i + 4).edge]);
            __builtin_prefetch(&search_.pages.edges[crew_[part]->batch(i + 4).edge]);
          }
          if (std::size_t(batch.edge) % n != share) continue;
          double& error = search_.lists[batch.edge].error;
          error = std::max(error, batch.error);
          batch.least =
              crew_[share]->envelopes.take(search_.lists[batch.edge], std::move(batch.windows),
                                           search_.pages.edges[batch.edge].length);
        }
    });
    for (std::size_t part = 0; part < parts; ++part)
      for (std::size_t i = 0; i < crew_[part]->n_batches(); ++i) {
        const RayCrossing::Batch& batch = crew_[part]->batch(i);
        if (batch.least < infinity && search_.lists[batch.edge].due == infinity)
          wait(batch.edge, batch.least);
      }
  }

  /// Windows wait for what else the front brings, until it has passed the edge or gone on by its
  /// `wait`.
  void wait(int id, double least) {
    const PolyhedralPages::Edge& edge = search_.pages.edges[id];
    const double ends = std::max(search_.distance[edge.tail], search_.distance[edge.head]);
    double& due = search_.lists[id].due;
    due = std::max(least, std::min(ends, least + edge.wait));
    push({due, id, float(edge.wait)});
  }

  /// Windows of edges that the front has passed prune nothing that the ends of the edge do not.
  void forget_passed(double now) {
    for (std::size_t i = 0; i < 2 * together_.size() && !gone_on_.empty(); ++i) {
      if (gone_on_.size() > 12) {
        const Passing ahead = gone_on_[12];
        if (ahead.when < now || ahead.when == infinity) {
          __builtin_prefetch(&search_.lists[ahead.edge]);
          __builtin_prefetch(&search_.pages.edges[ahead.edge]);
        }
      }
      Passing next = gone_on_.front();
      gone_on_.pop_front();
      if (next.when < now || next.when == infinity) {
        WindowList& list = search_.lists[next.edge];
        if (list.windows.empty() || list.due < infinity) continue;  // it will go on again
        next.when = passed(next.edge);
        if (next.when < now) {
          crew_[n_forgotten_++ % crew_.size()]->envelopes.forget(list);
          continue;
        }
      }
      gone_on_.push_back(next);
    }
  }
  /// When the front has passed an edge, as far as is known: perhaps later than that.
  double passed(int id) const {
    const PolyhedralPages::Edge& edge = search_.pages.edges[id];
    return 0.5 * (search_.distance[edge.tail] + search_.distance[edge.head] + edge.length);
  }

  /// Follows straight lines less far from now on, and lets paths bend at every vertex instead.
  void relax() {
    if (relaxed_++ == 0) exact_within_ = least_open();
    search_.most_straight = straight[relaxed_];
    budget_ += most_windows_;
    std::fill(search_.pages.bends.begin(), search_.pages.bends.end(), PolyhedralPages::anywhere);
    for (int v = 0; v < T_.n_vertices; ++v)
      if (search_.distance[v] < infinity) push({search_.distance[v], -1 - v, 0});
  }
  /// What is nearer has its shortest path.
  double least_open() const {
    double least = infinity;
    for (const auto [key, id, wait] : queue_) {
      if (id >= 0)
        least = std::min(least, EdgeEnvelopes::least_open(search_.lists[id]));
      else if (key <= search_.distance[-1 - id])
        least = std::min(least, key);
    }
    return least;
  }

  PolyhedralSearch search_;
  const IntrinsicTriangulation& T_;
  const double most_windows_;
  double budget_ = most_windows_;
  std::size_t relaxed_ = 0;  // times the limit was met
  double exact_within_ = infinity;
  std::vector<Entry> queue_;   // a heap
  std::vector<int> together_;  // `Entry::id` of what goes on now
  struct Passing {
    double when;
    int edge;
  };
  std::deque<Passing> gone_on_;
  std::size_t n_forgotten_ = 0;
  std::vector<std::unique_ptr<RayCrossing>> crew_;
  ThreadCrew threads_;
  int n_reached_ = 0;
};

}  // namespace

ExactDistance exact_polyhedral(const IntrinsicTriangulation& T, const TriangleSources& sources,
                               const Task& task, Report& report, const ExactSearch& search) {
  double most_windows = search.most_windows;
  if (!(most_windows > 0)) most_windows = std::max(1e7, 1000.0 * T.n_faces());
  Front front(T, most_windows, search.tolerance);
  double least = 0;
  const std::vector<PolyhedralStart> starts = starts_of(sources, least);
  front.run(starts, task);
  report.iterations.emplace_back("windows", front.windows());
  if (search.tolerance > 0)
    report.residuals.emplace_back("merged windows, share of a distance", front.largest_error());
  const double exact_within = (front.exact_within() + least) * T.unit;
  if (exact_within < infinity) {
    report.warn("not-converged",
                "exact distance met its limit of " + number_text(most_windows) +
                    " windows: values up to " + rounded_text(exact_within) +
                    " are exact; beyond, true distances are at least that and at most the values, "
                    "which are lengths of paths. Merge or remove overlapping faces");
  }
  VecXi nearest = front.nearest();
  return {finalize_field(T.component, T.n_components, T.unit, sources.reached,
                         front.distance().array() + least, report),
          std::move(nearest), exact_within};
}

}  // namespace littoral
