#include "methods/geodesic/exact_polyhedral.h"

#include <algorithm>
#include <array>
#include <deque>
#include <limits>
#include <sstream>
#include <utility>

#include "methods/geodesic/edge_envelopes.h"
#include "methods/geodesic/exact_polyhedral_pages.h"
#include "methods/geodesic/exact_polyhedral_starts.h"
#include "methods/geodesic/ray_bundle.h"
#include "methods/heat/finalize.h"

namespace littoral {

namespace {

constexpr double inf = std::numeric_limits<double>::infinity();
constexpr double slack_share = EdgeEnvelopes::slack_share;
constexpr double coverage_share = 1e-9;  // of a side: rays this near a window's end reach a vertex
/// How many triangles paths run straight through after each time the limit on windows is met.
constexpr std::array<int, 4> straight = {Window::deep + 1, 16, 4, 0};
constexpr double most_held = 3e7;  // windows, 2 GB

double norm(double x, double y) { return std::sqrt(x * x + y * y); }

class Front {
 public:
  Front(const IntrinsicTriangulation& T, double most_windows)
      : T_(T),
        pages_(T),
        envelopes_(T.n_edges()),
        most_windows_(most_windows),
        distance_(VecX::Constant(T.n_vertices, inf)),
        nearest_(VecXi::Constant(T.n_vertices, -1)),
        winner_(3 * std::size_t(T.n_faces()), {inf, 0}) {}

  void run(const std::vector<PolyhedralStart>& starts, const Task& task) {
    std::size_t steps = 0, started = 0;
    double next_check = 0;
    while (true) {
      while (started < starts.size() &&
             (queue_.empty() || starts[started].value <= queue_.front().key))
        begin(starts[started++]);
      if (queue_.empty()) break;
      const double work = double(++steps) + windows();
      if (work > next_check) {
        task.checkpoint(double(n_reached_) / T_.n_vertices);
        next_check = work + 4096;
      }
      const auto [key, id] = queue_.front();
      std::pop_heap(queue_.begin(), queue_.end());
      queue_.pop_back();
      fetch_ahead();
      if (id < 0) {
        if (key > distance_[-1 - id]) continue;
        leave_vertex(-1 - id);
      } else {
        go_on(id, key);
      }
      const bool full =
          envelopes_.n_taken() > budget_ || envelopes_.n_held() > most_held * double(1 + relaxed_);
      if (full && relaxed_ + 1 < straight.size()) relax();
    }
  }

  const VecX& distance() const { return distance_; }
  const VecXi& nearest() const { return nearest_; }
  double windows() const { return envelopes_.n_taken(); }
  /// Distances up to here are exact.
  double exact_within() const { return exact_within_; }

 private:
  struct Entry {
    double key;
    int id;  // of an edge with open windows; -1 - vertex
    bool operator<(const Entry& other) const {
      return key > other.key || (key == other.key && id > other.id);
    }
  };
  struct Winner {
    double distance;  // least at the far corner among rays through a side
    double crossing;  // where they cross the side
  };
  void begin(const PolyhedralStart& start) {
    const int v = start.vertex;
    if (v < 0) {
      const int triangle = start.point ? start.point->face : start.segment->triangle;
      const TriangleRays rays =
          start.point ? rays_of_point(T_, *start.point) : rays_of_segment(T_, *start.segment);
      for (int k = 0; k < 3; ++k)
        offer(T_.faces(triangle, k), start.value + rays.corners[k], start.source);
      for (auto [side, w] : rays.leaving) {
        w.source = start.source;
        w.behind += start.value;
        leave_face(side, w);
      }
    } else if (start.value < distance_[v]) {
      if (distance_[v] == inf) ++n_reached_;
      distance_[v] = start.value;
      nearest_[v] = start.source;
      push({start.value, -1 - v});
    }
  }
  void push(Entry entry) {
    queue_.push_back(entry);
    std::push_heap(queue_.begin(), queue_.end());
  }

  /// The way of the next windows from memory is longer than it takes to cross a triangle.
  void fetch_ahead() const {
    for (std::size_t i = 0; i < std::min<std::size_t>(3, queue_.size()); ++i) {
      const int id = queue_[i].id;
      if (id < 0) continue;
      __builtin_prefetch(&pages_.edges[id]);
      __builtin_prefetch(&envelopes_[id]);
      if (i > 0) continue;
      const std::vector<Window>& next = envelopes_[id].windows;
      for (std::size_t j = 0; j < std::min<std::size_t>(16, next.size()); ++j)
        __builtin_prefetch(&next[j]);
    }
  }

  void offer(int v, double distance, int source) {
    distance = std::max(distance, 0.0);  // beside a segment's line it may round to less
    if (!(distance < distance_[v])) return;
    if (distance_[v] == inf) ++n_reached_;
    distance_[v] = distance;
    nearest_[v] = source;
    if (pages_.bends[v]) push({distance, -1 - v});
  }

  /// Paths that bend at a vertex: along its edges and into its triangles.
  void leave_vertex(int v) {
    const double d = distance_[v];
    const int source = nearest_[v];
    for (const int side : pages_.around(v)) {
      const int f = side / 3, k1 = side % 3, k2 = (k1 + 1) % 3, k = (k1 + 2) % 3;
      offer(T_.faces(f, k1), d + T_.length(f, k), source);
      offer(T_.faces(f, k2), d + T_.length(f, k2), source);
      const TriangleShape t =
          triangle_shape(T_.length(f, k1), T_.length(f, k2), T_.length(f, k), false);
      Window w;
      w.b1 = T_.length(f, k1);
      w.x = t.p[2].real();
      w.y = t.p[2].imag();
      w.behind = d;
      w.source = source;
      leave_face(side, w);
    }
  }

  /// Cuts off what the ends of the edge reach sooner; false if nothing is left.
  bool trim(Window& w, const PolyhedralPages::Edge& edge) const {
    const double tail = distance_[edge.tail], head = distance_[edge.head], L = edge.length;
    if (tail < inf) w.trim_start(tail, slack_share * (tail + L));
    if (head < inf && w.b1 > w.b0) w.trim_end(head, L, slack_share * (head + L));
    return w.b1 - w.b0 > EdgeEnvelopes::narrow_share * L;
  }

  void leave_face(int side, Window w) {
    const int f = side / 3, k = side % 3;
    leave(side, T_.side_edge(f, k), T_.along(f, k) < 0, w);
  }

  /// Rays that leave a triangle through a side, in that side's coordinates with the triangle (and
  /// the image) above it.
  void leave(int side, int id, bool turned, Window& w) {
    const PolyhedralPages::Edge& edge = pages_.edges[id];
    if (!pages_.leads_on(edge, side)) return;
    w.y = -w.y;
    if (turned) w.turn(edge.length);
    w.page = pages_.page_of(edge, side);
    w.b0 = std::max(w.b0, 0.0);
    w.b1 = std::min(w.b1, edge.length);
    w.measure_ends();
    if (!trim(w, edge)) return;
    EdgeEnvelopes::List& list = envelopes_[id];
    const double least = envelopes_.insert(list, edge.length, w);
    if (least < inf && list.due == inf) wait(id, least);
  }

  /// Windows wait for what else the front brings, until it has passed the edge or gone on by its
  /// `wait`.
  void wait(int id, double least) {
    const PolyhedralPages::Edge& edge = pages_.edges[id];
    const double ends = std::max(distance_[edge.tail], distance_[edge.head]);
    double& due = envelopes_[id].due;
    due = std::max(least, std::min(ends, least + edge.wait));
    push({due, id});
  }

  /// Hands the new windows of an edge to its triangles.
  void go_on(int id, double now) {
    const PolyhedralPages::Edge& edge = pages_.edges[id];
    EdgeEnvelopes::List& list = envelopes_[id];
    list.due = inf;
    open_.clear();
    const double next = EdgeEnvelopes::take_open(list, now, [&](Window& w) {
      if (trim(w, edge)) open_.push_back(&w);
    });
    if (next < inf) wait(id, next);
    const auto sides = pages_.at(edge);
    for (std::size_t page = 0; page < sides.size(); ++page) {
      rays_.clear();
      for (const Window* w : open_)
        if (w->page != page) rays_.add(*w);
      if (rays_.size() > 0) cross(sides[page]);
    }
    gone_on_.push_back(id);
    forget_passed(now);
  }

  /// Windows of edges that the front has passed prune nothing that the ends of the edge do not.
  void forget_passed(double now) {
    for (int i = 0; i < 2 && !gone_on_.empty(); ++i) {
      const int id = gone_on_.front();
      gone_on_.pop_front();
      EdgeEnvelopes::List& list = envelopes_[id];
      if (list.windows.empty() || list.due < inf) continue;  // it will go on again
      const PolyhedralPages::Edge& edge = pages_.edges[id];
      const double ends = distance_[edge.tail] + distance_[edge.head];
      if (0.5 * (ends + edge.length) < now)
        envelopes_.forget(list);
      else
        gone_on_.push_back(id);
    }
  }

  /// The rays at hand enter a triangle through a side and leave through the others.
  void cross(int side) {
    const int f = side / 3, k = side % 3, k1 = (k + 1) % 3, k2 = (k + 2) % 3;
    const bool turned = T_.along(f, k) < 0;
    TriangleAbove above{T_.length(f, k), 0};
    above.apex = apex_of(above.length, T_.length(f, k1), T_.length(f, k2));
    if (turned) above.apex = Complex(above.length - above.apex.real(), above.apex.imag());
    rays_.look_at(above);
    const int apex = T_.faces(f, k2), n = rays_.size();
    Winner& winner = winner_[side];
    const double tolerance = coverage_share * above.length;
    for (int i = 0; i < n; ++i) {
      const double gy = rays_[i].direction_y();
      if (rays_.at_start(i) > gy * tolerance || rays_.at_end(i) < -gy * tolerance) continue;
      look(rays_[i], above, apex, winner);
    }
    goes_.resize(n);
    int first[2] = {n, n}, last[2] = {0, 0};
    for (int i = 0; i < n; ++i) {
      goes_[i] = where_to(i, above, distance_[apex], winner);
      for (const int right : {0, 1})
        if (goes_[i] >> right & 1) {
          first[right] = std::min(first[right], i);
          last[right] = i + 1;
        }
    }
    for (const int right : {1, 0}) {
      if (first[right] >= last[right]) continue;
      const int next = (right == 1) != turned ? k1 : k2;  // of the triangle's sides
      // A side from the edge below runs to the apex as given, if it is k1, and else from there.
      const bool to_apex = (next == k1) == (T_.along(f, next) > 0);
      const RayExit exit(above, T_.length(f, next), right == 1, !to_apex);
      leave_together(3 * f + next, T_.side_edge(f, next), above, exit, first[right], last[right],
                     right);
    }
  }

  static Complex apex_of(double a, double b, double c) {
    return {law_of_cosines(a, c, b) / (2 * a), 2 * area_of_lengths(a, b, c) / a};
  }

  /// A window whose rays reach the far corner.
  void look(const Window& w, const TriangleAbove& above, int apex, Winner& winner) {
    const double px = above.apex.real(), py = above.apex.imag(), at_apex = w.at(px, py);
    offer(apex, at_apex, w.source);
    if (!(at_apex < winner.distance)) return;
    const double crossing = w.parallel ? px - py * w.x / w.y : w.x - w.y * (px - w.x) / (py - w.y);
    winner = {at_apex, std::clamp(crossing, w.b0, w.b1)};
  }

  /// Sides of the apex that a window goes on to: 1 left, 2 right.
  int where_to(int i, const TriangleAbove& above, double far, const Winner& winner) const {
    const Window& w = rays_[i];
    if (w.depth >= straight[relaxed_]) return 0;
    bool left = rays_.at_start(i)<0, right = rays_.at_end(i)> 0;
    const double px = above.apex.real(), py = above.apex.imag();
    const double slack = slack_share * (far + above.length);
    // One angle, one split: rays beyond those that reach the far corner soonest do not cross them.
    const bool beyond_left = left && w.b0 >= winner.crossing,
               beyond_right = right && w.b1 <= winner.crossing;
    if ((beyond_left || beyond_right) && w.at(px, py) > winner.distance + slack) {
      left &= !beyond_left;
      right &= !beyond_right;
    }
    // Beyond the line from an end of the window to the far corner, that corner may be nearer.
    const double reach = far + py + slack;  // py bounds the norms from below
    if (left && reach < w.d0 && far + norm(px - w.b0, py) + slack < w.d0) left = false;
    if (right && reach < w.d1 && far + norm(px - w.b1, py) + slack < w.d1) right = false;
    return int(left) + 2 * int(right);
  }

  void leave_together(int side, int id, const TriangleAbove& above, const RayExit& exit, int first,
                      int last, int right) {
    const PolyhedralPages::Edge& edge = pages_.edges[id];
    if (!pages_.leads_on(edge, side)) return;
    const std::uint16_t page = pages_.page_of(edge, side);
    rays_.leave(above, exit, first, last);
    // From the tail to the head of the side.
    for (int j = first; j < last; ++j) {
      const int i = exit.turned() ? first + last - 1 - j : j;
      if (!(goes_[i] >> right & 1)) continue;
      Window& w = envelopes_.next_of_batch();
      rays_.left_as(i, exit, page, w);
      if (trim(w, edge))
        envelopes_.settle_in_batch(edge.length);
      else
        envelopes_.leave_out_of_batch();
    }
    EdgeEnvelopes::List& list = envelopes_[id];
    const double least = envelopes_.take_batch(list, edge.length);
    if (least < inf && list.due == inf) wait(id, least);
  }

  /// Follows straight lines less far from now on, and lets paths bend at every vertex instead.
  void relax() {
    if (relaxed_++ == 0) exact_within_ = least_open();
    budget_ += most_windows_;
    std::fill(pages_.bends.begin(), pages_.bends.end(), 1);
    for (int v = 0; v < T_.n_vertices; ++v)
      if (distance_[v] < inf) push({distance_[v], -1 - v});
  }
  /// What is nearer has its shortest path.
  double least_open() const {
    double least = inf;
    for (const auto [key, id] : queue_) {
      if (id >= 0)
        least = std::min(least, EdgeEnvelopes::least_open(envelopes_[id]));
      else if (key <= distance_[-1 - id])
        least = std::min(least, key);
    }
    return least;
  }

  const IntrinsicTriangulation& T_;
  PolyhedralPages pages_;
  EdgeEnvelopes envelopes_;
  const double most_windows_;
  double budget_ = most_windows_;
  std::size_t relaxed_ = 0;  // times the limit was met
  double exact_within_ = inf;
  VecX distance_;  // vertices; least found so far
  VecXi nearest_;
  std::vector<Winner> winner_;  // sides
  std::vector<Entry> queue_;    // a heap
  std::deque<int> gone_on_;     // edges, nearly in order
  std::vector<const Window*> open_;
  RayBundle rays_;
  std::vector<char> goes_;
  int n_reached_ = 0;
};

}  // namespace

ExactDistance exact_polyhedral(const IntrinsicTriangulation& T, const TriangleSources& sources,
                               const Task& task, Report& report, double most_windows) {
  if (!(most_windows > 0)) most_windows = std::max(1e7, 1000.0 * T.n_faces());
  Front front(T, most_windows);
  double least = 0;
  const std::vector<PolyhedralStart> starts = starts_of(sources, least);
  front.run(starts, task);
  report.iterations.emplace_back("windows", front.windows());
  const double exact_within = (front.exact_within() + least) * T.unit;
  if (exact_within < inf) {
    std::ostringstream text;
    text
        << "exact distance met its limit of " << most_windows << " windows: values up to "
        << exact_within
        << " are exact; beyond, true distances are at least that and at most the values, which are "
           "lengths of paths. Merge or remove overlapping faces";
    report.warn("not-converged", text.str());
  }
  VecXi nearest = front.nearest();
  return {finalize_field(T.component, T.n_components, T.unit, sources.reached,
                         front.distance().array() + least, report),
          std::move(nearest), exact_within};
}

}  // namespace littoral
