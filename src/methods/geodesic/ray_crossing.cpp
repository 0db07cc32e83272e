#include "methods/geodesic/ray_crossing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/fetch_ahead.h"
#include "base/index.h"
#include "base/parallel.h"
#include "base/platform/memory.h"
#include "methods/geodesic/merge_windows.h"

namespace littoral {

namespace {

constexpr double coverage_share = 1e-9;  // of a side: rays this near a window's end reach a vertex

constexpr double bend_slack = 1e-6;  // of a bend of half a turn; costs 1e-12 of a path
const Complex half_turn(-1, bend_slack);

Complex apex_of(double a, double b, double c) {
  return {law_of_cosines(a, c, b) / (2 * a), 2 * area_of_lengths(a, b, c) / a};
}

/// Far corner of a triangle above its side, 3 triangle + k.
Complex apex_over(const PolyhedralPages& pages, int side) {
  const PolyhedralPages::Triangle& t = pages.triangles[side / 3];
  const int k = side % 3;
  return apex_of(t.length[k], t.length[(k + 1) % 3], t.length[(k + 2) % 3]);
}

}  // namespace

PolyhedralSearch::PolyhedralSearch(const IntrinsicTriangulation& triangulation, double tolerance)
    : T(triangulation),
      pages(T),
      distance(VecX::Constant(T.n_vertices, infinity)),
      nearest(VecXi::Constant(T.n_vertices, -1)),
      arrival(T.n_vertices),
      winner(3 * std::size_t(T.n_faces())),
      tolerance(tolerance),
      error(VecX::Zero(tolerance > 0 ? T.n_vertices : 0)) {
  return_freed_memory();
  reserve_together(lists, std::size_t(T.n_edges()));
  lists.resize(std::size_t(T.n_edges()));
  constexpr std::size_t side_grain = 1 << 16;
  parallel_for(winner.size(), side_grain, [&](std::size_t begin, std::size_t end) {
    std::fill(winner.begin() + index(begin), winner.begin() + index(end),
              Winner{std::numeric_limits<float>::infinity(), 0});
  });
}

PolyhedralSearch::Winner PolyhedralSearch::Winner::of(double distance, double crossing) {
  using Limits = std::numeric_limits<float>;
  float above = std::max(float(distance), Limits::min());
  if (above < distance) above = std::nextafter(above, Limits::infinity());
  return {above, float(crossing)};
}

void RayCrossing::clear() {
  offers_.clear();
  n_batches_ = n_gone_on_ = 0;
  for (std::vector<int>& batches : of_share_) batches.clear();
}

RayCrossing::Batch& RayCrossing::next_batch(int edge, std::size_t n) {
  if (n_batches_ == batches_.size()) batches_.emplace_back();
  of_share_[share_of(edge)].push_back(int(n_batches_));
  Batch& batch = batches_[n_batches_++];
  batch.edge = edge;
  batch.error = error_;
  batch.windows = envelopes.spare.take(n);
  return batch;
}

void RayCrossing::leave_source(const PolyhedralStart& start) {
  const int triangle = start.point ? start.point->face : start.segment->triangle;
  error_ = 0;
  const TriangleRays rays =
      start.point ? rays_of_point(T_, *start.point) : rays_of_segment(T_, *start.segment);
  for (int k = 0; k < 3; ++k)
    offers_.push_back({T_.faces(triangle, k), start.value + rays.corners[k], start.source, {}, 0});
  for (auto [side, w] : rays.leaving) {
    w.source = start.source;
    w.behind += start.value;
    leave(side, w);
  }
}

void RayCrossing::leave_vertex(int v) {
  const double d = s_.distance[v];
  const int source = s_.nearest[v];
  error_ = s_.error_at(v);
  for (const int side : s_.pages.around(v)) {
    const int f = side / 3, k1 = side % 3, k2 = (k1 + 1) % 3, k = (k1 + 2) % 3;
    const PolyhedralPages::Triangle& t = triangle(f);
    offers_.push_back({t.vertex[k1], d + t.length[k], source, {3 * f + k2, 1}, error_});
    offers_.push_back({t.vertex[k2], d + t.length[k2], source, {3 * f + k, 0}, error_});
  }
  const PolyhedralSearch::Arrival& arrival = s_.arrival[v];
  if (s_.pages.bends[v] == PolyhedralPages::behind && arrival.side >= 0)
    return leave_behind(v, arrival);
  for (const int side : s_.pages.around(v))
    leave_corner(v, side, apex_over(s_.pages, side), 0, triangle(side / 3).length[side % 3]);
}

/// Paths straight from a vertex through a stretch of the side across from it.
void RayCrossing::leave_corner(int v, int side, Complex apex, double b0, double b1) {
  Window w;
  w.b0 = b0;
  w.b1 = b1;
  w.x = apex.real();
  w.y = apex.imag();
  w.behind = s_.distance[v];
  w.source = s_.nearest[v];
  leave(side, w);
}

/// Only where it turns by at least half a turn on both sides can a path that bends be shortest.
void RayCrossing::leave_behind(int v, const PolyhedralSearch::Arrival& arrival) {
  corners_.clear();
  for (int side = 3 * (arrival.side / 3) + (arrival.side % 3 + 1) % 3;;) {
    const auto at = s_.pages.at(triangle(side / 3).edge[side % 3]);
    const int entered = at[0] == side ? at[1] : at[0], f = entered / 3, k = entered % 3;
    if (f == arrival.side / 3) break;
    const PolyhedralPages::Triangle& t = triangle(f);
    Corner c;
    c.from_start = t.vertex[k] == v;
    c.side = 3 * f + (c.from_start ? k + 1 : k + 2) % 3;
    c.length = t.length[c.side % 3];
    c.apex = apex_over(s_.pages, c.side);
    corners_.push_back(c);
    side = 3 * f + (c.from_start ? k + 2 : k + 1) % 3;
  }
  const Complex apex = apex_over(s_.pages, arrival.side);
  const double length = triangle(arrival.side / 3).length[arrival.side % 3];
  const double p = arrival.share * length, x = apex.real(), y = apex.imag();
  const std::size_t n = corners_.size();
  const HalfTurn ahead = turn({y * y + (p - x) * (length - x), y * (length - p)}, false);
  const HalfTurn back = turn({y * y + (x - p) * x, y * p}, true);
  for (std::size_t i = ahead.corner; i < n && i + back.corner < n; ++i) {
    const Corner& c = corners_[i];
    double b0 = i == ahead.corner ? ahead.crossing : 0;
    double b1 = i + back.corner == n - 1 ? c.length - back.crossing : c.length;
    if (!c.from_start) b0 = c.length - std::exchange(b1, c.length - b0);
    leave_corner(v, c.side, c.apex, b0, b1);
  }
}

/// Goes around a vertex, corner by corner, from a direction against the first leg (some multiple of
/// that rotation) until the path that arrived has turned by half a turn.
RayCrossing::HalfTurn RayCrossing::turn(Complex direction, bool backwards) const {
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    const Corner& c = corners_[backwards ? corners_.size() - 1 - i : i];
    const bool from_start = c.from_start != backwards;
    const double x = from_start ? c.apex.real() : c.length - c.apex.real(), y = c.apex.imag();
    const Complex leg(-x, -y), next = direction * (Complex(c.length - x, -y) * std::conj(leg));
    if ((next * std::conj(half_turn)).imag() >= 0) {
      const Complex ray = leg * (half_turn * std::conj(direction));
      const double crossing = ray.imag() < 0 ? x - y * ray.real() / ray.imag() : x;
      return {i, std::clamp(crossing, 0.0, c.length)};
    }
    direction = next / std::max(std::abs(next.real()), std::abs(next.imag()));
  }
  return {corners_.size(), 0};
}

/// Rays that leave a triangle through a side, in that side's coordinates with the triangle (and the
/// image) above it.
void RayCrossing::leave(int side, Window w) {
  const int id = triangle(side / 3).edge[side % 3];
  const PolyhedralPages::Edge& edge = s_.pages.edges[id];
  if (!s_.pages.leads_on(edge, side)) return;
  w.y = -w.y;
  if (triangle(side / 3).along[side % 3] < 0) w.turn(edge.length);
  w.page = s_.pages.page_of(edge, side);
  w.b0 = std::max(w.b0, 0.0);
  w.b1 = std::min(w.b1, edge.length);
  w.measure_ends();
  if (s_.ends(edge).trim(w)) envelopes.spare.push_back(next_batch(id, 1).windows, w);
}

void RayCrossing::fetch(int id, int step) const {
  const PolyhedralPages::Edge& edge = s_.pages.edges[id];
  if (step == 0) {
    fetch_ahead(&edge);
    fetch_ahead(&s_.lists[id]);
  } else if (step == 1) {
    fetch_ahead(&s_.distance[edge.tail]);
    fetch_ahead(&s_.distance[edge.head]);
    s_.lists[id].windows.fetch();
    for (const int side : s_.pages.at(edge)) {
      fetch_ahead(&triangle(side / 3));
      fetch_ahead(&s_.winner[side]);
    }
  } else if (step == 2) {
    for (const int side : s_.pages.at(edge)) fetch_corner(side / 3, (side % 3 + 2) % 3);
  }
}

void RayCrossing::fetch_vertex(int v, int step) const {
  if (step == 0) {
    fetch_ahead(&s_.pages.corner_offsets[v]);
    s_.fetch(v);
  } else if (step == 1) {
    fetch_ahead(s_.pages.around(v).data());
  } else if (step == 2) {
    for (const int side : s_.pages.around(v)) fetch_ahead(&triangle(side / 3));
  } else {
    for (const int side : s_.pages.around(v)) fetch_corner(side / 3, (side % 3 + 2) % 3);
  }
}

/// What is at a corner of a triangle, and the sides that it ends.
void RayCrossing::fetch_corner(int f, int k) const {
  const PolyhedralPages::Triangle& t = triangle(f);
  fetch_ahead(&s_.distance[t.vertex[k]]);
  fetch_ahead(&s_.pages.edges[t.edge[k]]);
  fetch_ahead(&s_.pages.edges[t.edge[(k + 2) % 3]]);
}

void RayCrossing::go_on(int id) {
  WindowList& list = s_.lists[id];
  list.waits = false;
  n_gone_on_ += list.windows.size();
  if (list.none_open || list.windows.empty()) return;
  const PolyhedralPages::Edge& edge = s_.pages.edges[id];
  const EdgeEnds ends = s_.ends(edge);
  const auto sides = s_.pages.at(edge);
  if (s_.tolerance > 0)
    list.error += merge_windows(list.windows, edge.length, s_.tolerance, list.error);
  error_ = list.error;
  if (window_kernels().all_whole(list.windows, ends)) {
    list.none_open = true;
    rays_.use(list.windows);
    const int from = rays_[0].page;
    for (int page = 0; page < int(sides.size()); ++page)
      if (page != from) cross(sides[std::size_t(page)]);
    return;
  }
  open_.clear();
  EdgeEnvelopes::take_open(list, [&](Window& w) {
    if (ends.trim(w)) open_.push_back(w);
  });
  for (std::size_t page = 0; page < sides.size(); ++page) {
    others_.resize(0);
    for (const Window& w : open_)
      if (w.page != page) envelopes.spare.push_back(others_, w);
    if (others_.empty()) continue;
    rays_.use(others_);
    cross(sides[page]);
  }
}

/// The rays at hand enter a triangle through a side and leave through the others.
void RayCrossing::cross(int side) {
  const int f = side / 3, k = side % 3, k1 = (k + 1) % 3, k2 = (k + 2) % 3;
  const PolyhedralPages::Triangle& t = triangle(f);
  const bool turned = t.along[k] < 0;
  TriangleAbove above{t.length[k], 0};
  above.apex = apex_over(s_.pages, side);
  if (turned) above.apex = Complex(above.length - above.apex.real(), above.apex.imag());
  rays_.look_at(above, coverage_share * above.length);
  const RayColumns& c = rays_.columns();
  const int apex = t.vertex[k2], n = rays_.size();
  const PolyhedralSearch::Winner& winner = s_.winner[side];
  far_ = s_.distance[apex];
  for (int i = rays_.first_covering(); i < rays_.last_covering(); ++i)
    if (c.covers[i]) look(rays_[i], above, side);
  const double around = 1e-7 * above.length;
  rays_.see_where_to({above.apex.real(), above.apex.imag(), winner.crossing - around,
                      winner.crossing + around, winner.distance, far_,
                      slack_share * (far_ + above.length), s_.most_straight});
  for (const int right : {1, 0}) {
    int first = 0, last = n;
    while (first < last && !(c.goes[first] & (1 + right))) ++first;
    if (first == last) continue;
    while (!(c.goes[last - 1] & (1 + right))) --last;
    const int next = (right == 1) != turned ? k1 : k2;  // of the triangle's sides
    const int id = t.edge[next];
    const PolyhedralPages::Edge& edge = s_.pages.edges[id];
    if (!s_.pages.leads_on(edge, 3 * f + next)) continue;
    // A side from the edge below runs to the apex as given, if it is k1, and else from there.
    const bool to_apex = (next == k1) == (t.along[next] > 0);
    const RayExit exit(above, t.length[next], right == 1, !to_apex);
    const double base = s_.distance[to_apex ? edge.tail : edge.head];
    leave_together(3 * f + next, id, above, exit,
                   {to_apex ? base : far_, to_apex ? far_ : base, edge.length}, first, last);
  }
}

/// A window whose rays reach the far corner.
void RayCrossing::look(const Window& w, const TriangleAbove& above, int side) {
  const double px = above.apex.real(), py = above.apex.imag();
  const double at_apex = w.at(px, py), reached = std::max(at_apex, 0.0);
  PolyhedralSearch::Winner& winner = s_.winner[side];
  if (!(reached < far_ || at_apex < winner.distance)) return;
  double crossing = w.parallel ? px - py * w.x / w.y : w.x - w.y * (px - w.x) / (py - w.y);
  crossing = std::clamp(crossing, w.b0, w.b1);
  if (reached < far_) {
    const int f = side / 3, k = side % 3;
    const PolyhedralPages::Triangle& t = triangle(f);
    const double share = crossing / above.length;
    far_ = reached;
    offers_.push_back({t.vertex[(k + 2) % 3],
                       reached,
                       w.source,
                       {side, t.along[k] < 0 ? 1 - share : share},
                       error_});
  }
  if (at_apex < winner.distance) winner = PolyhedralSearch::Winner::of(at_apex, crossing);
}

/// Windows from the tail to the head of a side, each compared with the one before it.
void RayCrossing::leave_together(int side, int id, const TriangleAbove& above, const RayExit& exit,
                                 const EdgeEnds& ends, int first, int last) {
  const std::uint16_t page = s_.pages.page_of(s_.pages.edges[id], side);
  rays_.leave(above, exit, ends, first, last);
  const RayColumns& c = rays_.columns();
  const bool turned = exit.turned();
  const int n = last - first, step = turned ? -1 : 1, start = turned ? last - 1 : first;
  WindowBlock& batch = next_batch(id, std::size_t(n)).windows;
  bool as_left = false;  // the last of the batch is the one before, and its head end as it left
  bool follows = true;   // and its start as it left or cut from the one before it
  for (int j = 0; j < n;) {
    const int i = start + step * j, pair = turned ? i : i - 1;
    if (follows && (j == 0 ? c.ends[i] == 0 : c.follows[pair] != 0)) {
      int beyond = j + 1;
      const std::int64_t* next = c.follows + (turned ? i - 1 : i);  // of windows j and j + 1
      while (beyond + 3 < n && (next[0] & next[step] & next[2 * step] & next[3 * step])) {
        beyond += 4;
        next += 4 * step;
      }
      for (; beyond < n && *next; ++beyond) next += step;
      if (j > 0 && c.meets[pair] == cut_once) {
        batch.column(WindowBlock::b1)[batch.size() - 1] = c.cut[pair];
        batch.column(WindowBlock::d1)[batch.size() - 1] = c.cut_first[pair];
      }
      const int k = start + step * (beyond - 1);
      envelopes.spare.make_room(batch, batch.size() + std::size_t(std::abs(k - i)) + 1);
      rays_.put(std::min(i, k), std::max(i, k) + 1, turned, page, batch);
      as_left = true;
      j = beyond;
      if (j == n) break;
      follows = false;
      continue;
    }
    ++j;
    follows = false;
    if (c.ends[i] & 8) {
      as_left = false;
      continue;
    }
    Window w = rays_.left_as(i, page);
    if (c.ends[i] != 0) {
      as_left = false;
      if (ends.trim(w)) {
        envelopes.spare.push_back(batch, w);
        envelopes.settle(batch, ends.length);
      }
      continue;
    }
    if (as_left && c.meets[pair] == cut_once) {
      const std::size_t o = batch.size() - 1;
      const double o_start = batch.column(WindowBlock::b0)[o];
      if (o_start <= w.b0 && c.cut[pair] - o_start > ends.narrow()) {
        batch.column(WindowBlock::b1)[o] = w.b0 = c.cut[pair];
        batch.column(WindowBlock::d1)[o] = c.cut_first[pair];
        w.d0 = c.cut_second[pair];
        envelopes.spare.push_back(batch, w);
        follows = true;
        continue;
      }
    }
    envelopes.spare.push_back(batch, w);
    follows = as_left && c.meets[pair] == apart;
    as_left = follows || envelopes.settle(batch, ends.length);
  }
  if (!batch.empty()) return;
  envelopes.spare.give(std::move(batch));
  --n_batches_;
  of_share_[share_of(id)].pop_back();
}

}  // namespace littoral
