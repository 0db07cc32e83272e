#include "methods/geodesic/exact_polyhedral.h"

#include <algorithm>
#include <array>
#include <deque>
#include <memory>
#include <sstream>
#include <utility>

#include "base/fetch_ahead.h"
#include "base/index.h"
#include "base/option_table.h"
#include "base/thread_crew.h"
#include "methods/geodesic/ray_crossing.h"
#include "methods/geodesic/wave_queue.h"
#include "methods/heat/finalize.h"

namespace littoral {

namespace {

/// How many triangles paths run straight through after each time the limit on windows is met.
constexpr std::array<int, 4> straight = {Window::deep + 1, 16, 4, 0};
constexpr double most_held = 3e7;       // windows, 2 GB
constexpr double many_held = 5e5;       // windows, from which on they are forgotten sooner
constexpr double most_together = 3e4;   // windows
constexpr double worth_threads = 300;   // windows, of this and the next waves
constexpr std::size_t own_lines = 128;  // bytes: no line of a cache holds two of such

class Front {
 public:
  Front(const IntrinsicTriangulation& T, double most_windows, double tolerance)
      : search_(T, tolerance), T_(T), most_windows_(most_windows) {
    add_member();
  }

  void run(const std::vector<PolyhedralStart>& starts, const Task& task) {
    double steps = 0, next_check = 0;
    for (std::size_t started = 0;;) {
      now_ = least();
      while (started < starts.size() && starts[started].value <= now_) {
        begin(starts[started++]);
        now_ = least();
      }
      if (now_ == infinity) break;
      go_on();
      if (n_together_ == 0) continue;
      steps += double(n_together_);
      if (steps + windows() > next_check) {
        task.checkpoint(double(n_reached_) / T_.n_vertices);
        next_check = steps + windows() + 4096;
      }
      const double n_held = held();
      is_crowded_ = n_held > many_held;
      const bool full = windows() > budget_ || n_held > most_held * double(1 + relaxed_);
      if (full && relaxed_ + 1 < straight.size()) relax();
    }
  }

  VecX& distance() { return search_.distance; }
  VecXi& nearest() { return search_.nearest; }
  /// What distances may be off by, as a share of them, at most.
  double largest_error() const {
    double most = 0;
    for (int v = 0; v < T_.n_vertices; ++v)
      if (const double error = search_.error_at(v); error > 0)
        most = std::max(most, error / search_.distance[v]);
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
  struct Passing {
    double when;  // the front has passed the edge, as far as is known: perhaps later than that
    int edge;
  };
  /// What is on its way of a share of edges and vertices. Threads write to these side by side.
  struct alignas(own_lines) Share {
    WaveQueue queue;  // ids of edges with open windows; -1 - vertex
    std::deque<Passing> watched;
  };
  /// What one thread has at hand.
  struct alignas(own_lines) Part {
    std::vector<int> together;  // of the queues of its shares: what goes on now
    std::vector<RayCrossing::Batch*> to_take;
  };

  double held() const {
    double sum = 0;
    for (const auto& member : crew_) sum += member->envelopes.n_held();
    return sum;
  }

  void add_member() { crew_.push_back(std::make_unique<RayCrossing>(search_)); }

  void begin(const PolyhedralStart& start) {
    if (start.vertex < 0) {
      crew_[0]->clear();
      crew_[0]->leave_source(start);
      settle(1);
    } else if (offer({start.vertex, start.value, start.source, {}, 0})) {
      wait_at_vertex(start.vertex);
    }
  }
  bool offer(const RayCrossing::Offer& better) {
    const auto& [v, distance, source, arrival, error] = better;
    if (!(distance < search_.distance[v])) return false;
    if (search_.distance[v] == infinity) ++n_reached_;
    search_.distance[v] = distance;
    search_.nearest[v] = source;
    search_.arrival[v] = arrival;
    if (search_.tolerance > 0) search_.error[v] = error;
    return true;
  }

  double least() const {
    double least = infinity;
    for (const Share& share : shares_) least = std::min(least, share.queue.least());
    return least;
  }
  Share& share_of(int id) { return shares_[RayCrossing::share_of(id)]; }
  static std::size_t first_share(std::size_t part, std::size_t parts) {
    return part * RayCrossing::n_shares / parts;
  }

  /// Lets all go on that is due before anything of it changes others by much. Nobody sees what
  /// another of them sends: so they can do it at the same time, and the answer is the same whether
  /// they do or not. Edges go on by the threads that put their windows away, in whose caches these
  /// are.
  void go_on() {
    double end = infinity;
    std::size_t n_soon = 0;
    for (Share& share : shares_) {
      end = std::min(end, share.queue.until());
      n_soon += share.queue.n_soon();
    }
    const std::size_t most = std::size_t(most_together / windows_each_) / RayCrossing::n_shares + 1;
    const bool worth = double(n_soon) * windows_each_ > worth_threads;
    const std::size_t parts = worth ? most_parts_ : 1;
    while (crew_.size() < parts) add_member();
    threads_.run(parts, [&](std::size_t part) {
      RayCrossing& member = *crew_[part];
      member.clear();
      std::vector<int>& together = parts_[part].together;
      together.clear();
      for (std::size_t s = first_share(part, parts); s < first_share(part + 1, parts); ++s) {
        const std::size_t most_here = together.size() + most;
        shares_[s].queue.take_wave(now_, end, [&](const WaveQueue::Entry& entry) {
          if (together.size() >= most_here) return false;
          const bool is_old = entry.id < 0 && entry.key > search_.distance[-1 - entry.id];
          if (!is_old) together.push_back(entry.id);
          return true;
        });
      }
      for (std::size_t i = 0; i < together.size(); ++i) {
        for (int step = 0; step < RayCrossing::n_fetch_steps; ++step) {
          const std::size_t ahead = i + std::size_t(RayCrossing::n_fetch_steps - step);
          if (ahead < together.size()) fetch(member, together[ahead], step);
        }
        if (together[i] < 0)
          member.leave_vertex(-1 - together[i]);
        else
          member.go_on(together[i]);
      }
    });
    double n_windows = 0;
    n_together_ = 0;
    for (std::size_t part = 0; part < parts; ++part) {
      n_windows += double(crew_[part]->n_gone_on());
      n_together_ += parts_[part].together.size();
    }
    if (n_together_ == 0) return;
    windows_each_ = std::max(1.0, n_windows / double(n_together_));
    settle(parts);
  }

  static void fetch(const RayCrossing& member, int id, int step) {
    if (id < 0)
      member.fetch_vertex(-1 - id, step);
    else
      member.fetch(id, step);
  }

  /// Puts what the first members of the crew have collected where it belongs.
  void settle(std::size_t parts) {
    for (std::size_t part = 0; part < parts; ++part) {
      const std::vector<RayCrossing::Offer>& offers = crew_[part]->offers();
      for (std::size_t i = 0; i < offers.size(); ++i) {
        if (i + 6 < offers.size()) search_.fetch(offers[i + 6].vertex);
        const RayCrossing::Offer& o = offers[i];
        if (offer(o) && search_.pages.bends[o.vertex]) wait_at_vertex(o.vertex);
      }
    }
    // In as many parts as have sent, each with memory for windows at hand.
    threads_.run(parts, [&](std::size_t worker) {
      const std::size_t first = first_share(worker, parts), end = first_share(worker + 1, parts);
      std::vector<RayCrossing::Batch*>& mine = parts_[worker].to_take;
      mine.clear();
      for (std::size_t share = first; share < end; ++share)
        for (std::size_t part = 0; part < parts; ++part)
          for (const int i : crew_[part]->batches_of(share))
            mine.push_back(&crew_[part]->batches()[std::size_t(i)]);
      for (std::size_t i = 0; i < mine.size(); ++i) {
        if (i + 6 < mine.size()) {
          fetch_ahead(&search_.lists[mine[i + 6]->edge]);
          fetch_ahead(&search_.pages.edges[mine[i + 6]->edge]);
        }
        if (i + 3 < mine.size()) search_.lists[mine[i + 3]->edge].windows.fetch();
        take(*mine[i], crew_[worker]->envelopes);
      }
      for (std::size_t share = first; share < end; ++share) {
        forget_passed(shares_[share].watched, *crew_[worker]);
        shares_[share].queue.until();  // here, beside the others
      }
    });
  }
  void take(RayCrossing::Batch& batch, EdgeEnvelopes& envelopes) {
    WindowList& list = search_.lists[batch.edge];
    const PolyhedralPages::Edge& edge = search_.pages.edges[batch.edge];
    list.error = std::max(list.error, batch.error);
    const double least = envelopes.take(list, std::move(batch.windows), edge.length);
    if (!(least < infinity) || std::exchange(list.waits, true)) return;
    // Windows wait for what else the front brings, until it has passed the edge or gone on by its
    // `wait`.
    const double ends = std::max(search_.distance[edge.tail], search_.distance[edge.head]);
    const double due = std::max(least, std::min(ends, least + edge.wait));
    Share& share = share_of(batch.edge);
    share.queue.push({due, batch.edge, float(edge.wait)});
    if (!std::exchange(list.is_watched, true))
      share.watched.push_back({passed(batch.edge), batch.edge});
  }

  void wait_at_vertex(int v) {
    share_of(v).queue.push({search_.distance[v], -1 - v, search_.pages.vertex_wait[v]});
  }

  /// Windows of edges that the front has passed prune nothing that the ends of the edge do not.
  void forget_passed(std::deque<Passing>& watched, RayCrossing& member) {
    const std::size_t n = n_together_ / (is_crowded_ ? 1 : RayCrossing::n_shares / 2) + 1;
    for (std::size_t i = 0; i < n && !watched.empty(); ++i) {
      if (watched.size() > 12 && may_have_passed(watched[12])) {
        fetch_ahead(&search_.lists[watched[12].edge]);
        fetch_ahead(&search_.pages.edges[watched[12].edge]);
      }
      Passing next = watched.front();
      watched.pop_front();
      if (may_have_passed(next)) {
        WindowList& list = search_.lists[next.edge];
        next.when = passed(next.edge);
        if (!list.waits && (list.windows.empty() || next.when < now_)) {
          list.is_watched = false;
          member.envelopes.forget(list);
          continue;
        }
      }
      watched.push_back(next);
    }
  }
  bool may_have_passed(const Passing& edge) const {
    return edge.when < now_ || edge.when == infinity;
  }
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
      if (search_.distance[v] < infinity) wait_at_vertex(v);
  }
  /// What is nearer has its shortest path.
  double least_open() const {
    double least = infinity;
    for (const Share& share : shares_) {
      share.queue.for_each([&](const WaveQueue::Entry& entry) {
        if (entry.id >= 0)
          least = std::min(least, EdgeEnvelopes::least_open(search_.lists[entry.id]));
        else if (entry.key <= search_.distance[-1 - entry.id])
          least = std::min(least, entry.key);
      });
    }
    return least;
  }

  PolyhedralSearch search_;
  const IntrinsicTriangulation& T_;
  const double most_windows_;
  double budget_ = most_windows_;
  std::size_t relaxed_ = 0;  // times the limit was met
  double exact_within_ = infinity;
  std::array<Share, RayCrossing::n_shares> shares_;
  std::array<Part, RayCrossing::n_shares> parts_;
  std::size_t n_together_ = 0;  // edges and vertices that went on the last time
  double windows_each_ = 1;     // of the edges among them
  double now_ = 0;              // where the front is
  bool is_crowded_ = false;     // many windows are held
  std::vector<std::unique_ptr<RayCrossing>> crew_;
  ThreadCrew threads_;
  const std::size_t most_parts_ = threads_.size() > 1 ? std::min(4 * std::size_t(threads_.size()),
                                                                 RayCrossing::n_shares)
                                                      : 1;
  int n_reached_ = 0;
};

}  // namespace

ExactDistance exact_polyhedral(const IntrinsicTriangulation& T, const TriangleSources& sources,
                               const Task& task, Report& report, const ExactSearch& search) {
  double most_windows = search.most_windows;
  if (!(most_windows > 0)) most_windows = std::max(1e7, 1000.0 * T.n_faces());
  auto front = std::make_unique<Front>(T, most_windows, search.tolerance);
  double least = 0;
  const std::vector<PolyhedralStart> starts = starts_of(sources, least);
  front->run(starts, task);
  report.iterations.emplace_back("windows", front->windows());
  if (search.tolerance > 0)
    report.residuals.emplace_back("merged windows, share of a distance", front->largest_error());
  const double exact_within = (front->exact_within() + least) * T.unit;
  if (exact_within < infinity) {
    report.warn("not-converged",
                "exact distance met its limit of " + number_text(most_windows) +
                    " windows: values up to " + rounded_text(exact_within) +
                    " are exact; beyond, true distances are at least that and at most the values, "
                    "which are lengths of paths. Merge or remove overlapping faces");
  }
  VecX distance = std::move(front->distance());
  VecXi nearest = std::move(front->nearest());
  front.reset();  // large, and what follows needs memory, too
  distance.array() += least;
  return {finalize_field(T.component, T.n_components, T.unit, sources.reached, distance, report),
          std::move(nearest), exact_within};
}

}  // namespace littoral
