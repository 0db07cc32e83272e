#pragma once
// Small vertex separators of whole graphs.

#include <deque>
#include <vector>

#include "base/task.h"
#include "solve/direct/graph.h"
#include "solve/direct/separator.h"

namespace littoral {

/// Cuts graphs, one after the other, with the same buffers.
class Bisection {
 public:
  /// Of each vertex the part, 0 or 1, between which there is no edge, or 2 for the light separator
  /// between parts of similar weight. The graph is contracted along heavy edges until it is small,
  /// cut there by growing a part from several seeds, and the cut improved on the way back
  /// (Hendrickson, Leland 1995; Karypis, Kumar 1998). The same graph always gets the same cut.
  /// graph: without weights of edges, not empty. Throws Cancelled.
  const std::vector<signed char>& cut(const Graph& graph, const Task& task);

 private:
  /// A graph that another was contracted to, and which of its vertices each vertex went into.
  struct Level {
    Graph graph;
    std::vector<int> coarse_of;
  };

  void match(const Graph& g, int most, const Task& task);
  void match_by_neighbour(const Graph& g, int most);
  void contract(const Graph& g, Level& level, const Task& task);
  void cut_by_growing(const Graph& g, int seeds);

  std::deque<Level> levels_;
  std::vector<int> match_;  // the vertex that each is joined with; itself: none
  std::vector<int> place_;  // of a neighbour in the row at hand
  Separator separator_;
};

}  // namespace littoral
