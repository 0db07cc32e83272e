#pragma once
// What goes on from an edge that windows lie on, or from a vertex where paths bend.

#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "base/fetch_ahead.h"
#include "methods/geodesic/edge_envelopes.h"
#include "methods/geodesic/exact_polyhedral_pages.h"
#include "methods/geodesic/exact_polyhedral_starts.h"
#include "methods/geodesic/ray_bundle.h"

namespace littoral {

/// What the search knows so far.
struct PolyhedralSearch {
  explicit PolyhedralSearch(const IntrinsicTriangulation& triangulation, double tolerance = 0);

  /// The ray through a side that reaches the far corner soonest, to the seventh digit: what its
  /// neighbours are told is that they cross it, and some may go on a little longer.
  struct Winner {
    float distance;  // there, not less
    float crossing;  // of the side

    static Winner of(double distance, double crossing);
  };

  /// The ray that reaches a vertex soonest: the side across from it, 3 triangle + k, and where the
  /// ray crosses that, as a share from its start; rays of sources in the triangle have none.
  struct Arrival {
    int side = -1;
    double share = 0;
  };

  const IntrinsicTriangulation& T;
  PolyhedralPages pages;
  WindowMemory memory;            // of lists and of what is sent to them
  LargeVector<WindowList> lists;  // edges
  VecX distance;                  // vertices; least found so far
  VecXi nearest;
  std::vector<Arrival> arrival;          // vertices
  LargeVector<Winner> winner;            // sides
  int most_straight = Window::deep + 1;  // how many triangles paths run straight through
  const double tolerance;                // share of a distance that merging may change it by
  VecX error;                            // vertices; see WindowList. Without a tolerance none

  EdgeEnds ends(const PolyhedralPages::Edge& edge) const {
    return {distance[edge.tail], distance[edge.head], edge.length};
  }
  double error_at(int v) const { return tolerance > 0 ? error[v] : 0; }
  /// Lets the processor read ahead what is known of a vertex.
  void fetch(int v) const {
    fetch_ahead(&distance[v]);
    fetch_ahead(&nearest[v]);
    fetch_ahead(&arrival[v]);
    if (tolerance > 0) fetch_ahead(&error[v]);
  }
};

/// Collects what edges and vertices send, without a change of anything that others read: several
/// can work on different edges at the same time.
class RayCrossing {
 public:
  explicit RayCrossing(PolyhedralSearch& search)
      : envelopes(search.memory), s_(search), T_(search.T) {}

  struct Offer {
    int vertex;
    double distance;
    int source;
    PolyhedralSearch::Arrival arrival;
    double error;
  };
  struct Batch {
    int edge;
    WindowBlock windows;
    double error;
  };

  void clear();
  /// Lets the processor read ahead what an edge or a vertex needs, in steps of which each looks at
  /// what the one before has fetched.
  static constexpr int n_fetch_steps = 4;
  void fetch(int edge, int step) const;
  void fetch_vertex(int v, int step) const;
  /// The windows of an edge that have not gone on, to its triangles.
  void go_on(int edge);
  /// Paths that bend at a vertex: along its edges and into its triangles.
  void leave_vertex(int v);
  void leave_source(const PolyhedralStart& start);

  const std::vector<Offer>& offers() const { return offers_; }
  /// Windows of the edges that have gone on.
  std::size_t n_gone_on() const { return n_gone_on_; }
  std::span<Batch> batches() { return {batches_.data(), n_batches_}; }
  /// Edges are divided into so many shares, neighbours in memory together, that several threads can
  /// put batches away.
  static constexpr std::size_t n_shares = 16;
  static std::size_t share_of(int edge) { return std::size_t(edge) / 64 % n_shares; }
  const std::vector<int>& batches_of(std::size_t share) const { return of_share_[share]; }

  EdgeEnvelopes envelopes;

 private:
  const PolyhedralPages::Triangle& triangle(int f) const { return s_.pages.triangles[f]; }
  void fetch_corner(int f, int k) const;
  void cross(int side);
  void look(const Window& w, const TriangleAbove& above, int side);
  void leave_together(int side, int edge, const TriangleAbove& above, const RayExit& exit,
                      const EdgeEnds& ends, int first, int last);
  void leave_corner(int v, int side, Complex apex, double b0, double b1);
  void leave_behind(int v, const PolyhedralSearch::Arrival& arrival);
  struct HalfTurn {
    std::size_t corner;  // corners passed before it
    double crossing;     // of the side across, from the end that comes first
  };
  HalfTurn turn(Complex direction, bool backwards) const;
  void leave(int side, Window w);
  Batch& next_batch(int edge, std::size_t n);

  PolyhedralSearch& s_;
  const IntrinsicTriangulation& T_;
  std::vector<Offer> offers_;
  std::vector<Batch> batches_;  // the first n_batches_ are in use
  std::size_t n_batches_ = 0, n_gone_on_ = 0;
  std::array<std::vector<int>, n_shares> of_share_;
  struct Corner {
    int side;         // across from the vertex
    bool from_start;  // the corner is entered at the leg to the start of that side
    double length;
    Complex apex;  // the vertex above that side
  };
  std::vector<Corner> corners_;
  std::vector<Window> open_;
  WindowBlock others_;  // the open ones that did not come through a triangle
  RayBundle rays_;
  double far_ = 0;    // distance of the far corner of the triangle that is crossed
  double error_ = 0;  // of what is sent
};

}  // namespace littoral
