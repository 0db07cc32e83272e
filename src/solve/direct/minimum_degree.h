#pragma once
// Minimum degree orders of small graphs with a boundary.

#include <cstdint>
#include <vector>

namespace littoral {

/// Eliminates vertices 0 .. n - 1, each time one with the fewest neighbours, between which edges
/// are put then; vertices of the boundary, which are eliminated later, count as neighbours. Rows of
/// the graph are bits, and nothing about degrees is approximate.
class MinimumDegree {
 public:
  /// The boundary has the numbers n .. n + boundary - 1.
  MinimumDegree(int n, int boundary);
  /// An edge from one of the n to any vertex; to be given from both ends if both are of the n.
  void add_edge(int vertex, int to) { row(vertex)[to / 64] |= bit(to); }
  /// The order; among equals the smallest number first.
  std::vector<int> order();

 private:
  static std::uint64_t bit(int vertex) { return std::uint64_t{1} << (vertex % 64); }
  /// Neighbours of a vertex and itself.
  std::uint64_t* row(int vertex) { return bits_.data() + std::size_t(vertex) * words_; }

  int n_;
  std::size_t words_;
  std::vector<std::uint64_t> bits_;
};

}  // namespace littoral
