#include "methods/geodesic/exact_polyhedral.h"

#include <algorithm>
#include <array>
#include <limits>
#include <queue>
#include <sstream>
#include <utility>

#include "methods/geodesic/edge_envelopes.h"
#include "methods/geodesic/exact_polyhedral_pages.h"
#include "methods/geodesic/exact_polyhedral_starts.h"
#include "methods/heat/finalize.h"

namespace littoral {

namespace {

constexpr double inf = std::numeric_limits<double>::infinity();
constexpr double slack_share = EdgeEnvelopes::slack_share;
constexpr double coverage_share = 1e-9;  // of a side: rays this near a window's end reach a vertex
/// How many triangles paths run straight through after each time the limit on windows is met.
constexpr std::array<int, 4> straight = {65536, 16, 4, 0};
constexpr double most_held = 3e7;  // windows, 2 GB

double norm(double x, double y) { return std::sqrt(x * x + y * y); }
double cross(double ax, double ay, double bx, double by) { return ax * by - ay * bx; }

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

  void start_at(int vertex, int source) {
    if (distance_[vertex] == 0) return;
    distance_[vertex] = 0;
    nearest_[vertex] = source;
    ++n_reached_;
    queue_.push({0, -1 - vertex});
  }

  /// A source inside a triangle.
  void start_in(int triangle, const TriangleRays& rays, int source) {
    for (int k = 0; k < 3; ++k) offer(T_.faces(triangle, k), rays.corners[k], source);
    for (auto [side, w] : rays.leaving) {
      w.source = source;
      leave_face(side, w);
    }
  }

  void run(const Task& task) {
    std::size_t steps = 0;
    double next_check = 0;
    while (!queue_.empty()) {
      const double work = double(++steps) + windows();
      if (work > next_check) {
        task.checkpoint(double(n_reached_) / T_.n_vertices);
        next_check = work + 4096;
      }
      const auto [key, id] = queue_.top();
      queue_.pop();
      if (id < 0) {
        if (key > distance_[-1 - id]) continue;
        leave_vertex(-1 - id);
      } else {
        go_on(id, key);
      }
      if (steps % pages_.edges.size() == 0)
        for (int e = 0; e < T_.n_edges(); ++e) forget_passed(e, key);
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
  /// A window before one of its pages.
  struct Ray {
    const Window* w;
    double at_apex;       // its distance there, seen or not
    double apex0, apex1;  // > 0: the apex lies left of the ray at the window's start, end
  };

  void offer(int v, double distance, int source) {
    distance = std::max(distance, 0.0);  // beside a segment's line it may round to less
    if (!(distance < distance_[v])) return;
    if (distance_[v] == inf) ++n_reached_;
    distance_[v] = distance;
    nearest_[v] = source;
    if (pages_.bends[v]) queue_.push({distance, -1 - v});
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
    w.b0 = std::max(w.b0, 0.0);
    w.b1 = std::min(w.b1, edge.length);
    w.from = side;
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
    queue_.push({due, id});
  }

  /// Hands the new windows of an edge to its triangles.
  void go_on(int id, double now) {
    const PolyhedralPages::Edge& edge = pages_.edges[id];
    // Their way from memory is longer than it takes to collect the windows.
    __builtin_prefetch(&pages_.pages[edge.first_page]);
    __builtin_prefetch(&pages_.pages[edge.first_page] + 1);
    EdgeEnvelopes::List& list = envelopes_[id];
    list.due = inf;
    const double next = EdgeEnvelopes::take_open(list, now, open_);
    if (next < inf) wait(id, next);
    std::erase_if(open_, [&](Window& w) { return !trim(w, edge); });
    if (open_.empty()) return;
    bool turned = false;
    for (const PolyhedralPages::Page& page : pages_.at(id)) {
      rays_.clear();
      if (std::exchange(turned, page.turned) != page.turned)
        for (Window& w : open_) w.turn(edge.length);
      for (const Window& w : open_)
        if (w.from != page.side) look(w, page);
      for (const Ray& ray : rays_) propagate(ray, page);
      forget_passed(page.edge1, now);
      forget_passed(page.edge2, now);
    }
  }

  /// Windows of edges that the front has passed prune nothing that the ends of the edge do not.
  void forget_passed(int id, double now) {
    const PolyhedralPages::Edge& edge = pages_.edges[id];
    EdgeEnvelopes::List& list = envelopes_[id];
    if (list.windows.empty() || list.due < inf) return;
    const double ends = distance_[edge.tail] + distance_[edge.head];
    if (0.5 * (ends + edge.length) < now) envelopes_.forget(list);
  }

  /// What a window sees of the far corner.
  void look(const Window& w, const PolyhedralPages::Page& page) {
    const double px = page.apex.real(), py = page.apex.imag();
    const double gy = w.direction_y(), g0 = w.direction_x(w.b0), g1 = w.direction_x(w.b1);
    const double at_apex = w.at(px, py);
    const double apex0 = cross(g0, gy, px - w.b0, py), apex1 = cross(g1, gy, px - w.b1, py);
    rays_.push_back({&w, at_apex, apex0, apex1});
    const double tolerance = coverage_share * page.length;
    if (apex0 > gy * tolerance || apex1 < -gy * tolerance) return;
    offer(page.far, at_apex, w.source);
    Winner& winner = winner_[page.side];
    if (at_apex < winner.distance) {
      const double crossing =
          w.parallel ? px - py * w.x / w.y : w.x - w.y * (px - w.x) / (py - w.y);
      winner = {at_apex, std::clamp(crossing, w.b0, w.b1)};
    }
  }

  void propagate(const Ray& ray, const PolyhedralPages::Page& page) {
    const Window& w = *ray.w;
    if (w.depth >= straight[relaxed_]) return;
    const double px = page.apex.real(), py = page.apex.imag(), L = page.length;
    bool left = ray.apex0 < 0;
    bool right = ray.apex1 > 0;
    // One angle, one split: rays beyond those that reach the far corner soonest do not cross them.
    const Winner& winner = winner_[page.side];
    const double far = distance_[page.far], slack = slack_share * (far + L);
    if (ray.at_apex > winner.distance + slack) {
      if (w.b0 >= winner.crossing) left = false;
      if (w.b1 <= winner.crossing) right = false;
    }
    // Beyond the line from an end of the window to the far corner, that corner may be nearer.
    if (left && far + norm(px - w.b0, py) + slack < w.d0) left = false;
    if (right && far + norm(px - w.b1, py) + slack < w.d1) right = false;
    if (!left && !right) return;
    const double gy = w.direction_y(), g0 = w.direction_x(w.b0), g1 = w.direction_x(w.b1);
    Window child = w;
    child.open = true;
    child.depth = static_cast<std::uint16_t>(std::min(w.depth + 1, 65535));
    const Complex image(w.x, w.y);
    if (right) {
      // Where a ray from b along (g, gy) leaves, as a share of the way to the far corner.
      const auto share = [&](double b, double g) {
        return std::clamp(gy * (L - b) / cross(g, gy, px - L, py), 0.0, 1.0);
      };
      child.b0 = page.length1 * share(w.b1, g1);
      child.b1 = ray.apex0 > 0 ? page.length1 * share(w.b0, g0) : page.length1;
      const Complex along = (page.apex - L) / page.length1;
      Window there = seen_from(child, image, L, along);
      leave(next_side(page.side), page.edge1, page.turned1, there);
    }
    if (left) {
      const auto share = [&](double b, double g) {
        return std::clamp(-gy * b / cross(g, gy, px, py), 0.0, 1.0);
      };
      child.b0 = ray.apex1 < 0 ? page.length2 * (1 - share(w.b1, g1)) : 0;
      child.b1 = page.length2 * (1 - share(w.b0, g0));
      const Complex along = -page.apex / page.length2;
      Window there = seen_from(child, image, page.apex, along);
      leave(next_side(next_side(page.side)), page.edge2, page.turned2, there);
    }
  }

  static int next_side(int side) { return side % 3 == 2 ? side - 2 : side + 1; }

  /// Follows straight lines less far from now on, and lets paths bend at every vertex instead.
  void relax() {
    if (relaxed_++ == 0) exact_within_ = least_open();
    budget_ += most_windows_;
    std::fill(pages_.bends.begin(), pages_.bends.end(), 1);
    for (int v = 0; v < T_.n_vertices; ++v)
      if (distance_[v] < inf) queue_.push({distance_[v], -1 - v});
  }
  /// What is nearer has its shortest path.
  double least_open() const {
    double least = inf;
    for (auto waiting = queue_; !waiting.empty(); waiting.pop()) {
      const auto [key, id] = waiting.top();
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
  std::priority_queue<Entry> queue_;
  std::vector<Window> open_;
  std::vector<Ray> rays_;
  int n_reached_ = 0;
};

}  // namespace

ExactDistance exact_polyhedral(const IntrinsicTriangulation& T, const TriangleSources& sources,
                               const Task& task, Report& report, double most_windows) {
  if (!(most_windows > 0)) most_windows = std::max(1e7, 1000.0 * T.n_faces());
  Front front(T, most_windows);
  for (const auto* points : {&sources.nodes, &sources.isolated}) {
    for (std::size_t i = 0; i < points->vertices.size(); ++i)
      front.start_at(points->vertices[i], points->vertex_source[i]);
    for (std::size_t i = 0; i < points->inside.size(); ++i)
      front.start_in(points->inside[i].face, rays_of_point(T, points->inside[i]),
                     points->inside_source[i]);
  }
  for (const TriangleSources::Segment& s : sources.segments)
    front.start_in(s.triangle, rays_of_segment(T, s), s.source);
  front.run(task);
  report.iterations.emplace_back("windows", front.windows());
  const double exact_within = front.exact_within() * T.unit;
  if (exact_within < inf) {
    std::ostringstream text;
    text
        << "exact distance met its limit of " << most_windows << " windows: values up to "
        << front.exact_within() * T.unit
        << " are exact; beyond, true distances are at least that and at most the values, which are "
           "lengths of paths. Merge or remove overlapping faces";
    report.warn(text.str());
  }
  VecXi nearest = front.nearest();
  return {finalize_field(T.component, T.n_components, T.unit, sources.reached, front.distance(),
                         report),
          std::move(nearest), exact_within};
}

}  // namespace littoral
