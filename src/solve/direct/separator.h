#pragma once
// Separators of graphs, improved by moves of single vertices.

#include <array>
#include <cstdint>
#include <vector>

#include "base/task.h"
#include "solve/direct/graph.h"

namespace littoral {

/// A set of vertices of a graph that is to be light, and two parts without an edge between them
/// that are to weigh about the same. Vertices move from the separator to a part and pull their
/// neighbours in the other part into it (Fiduccia, Mattheyses 1982; for separators Ashcraft, Liu
/// 1996, one direction at a time as in METIS). Its buffers serve one graph after the other.
class Separator {
 public:
  /// A graph, which is kept by reference; all of it is part 1.
  void start(const Graph& graph);
  /// From a graph's separator to that of the graph that was contracted to it: vertex v of that went
  /// into coarse_of[v]. Throws Cancelled.
  void refined(const Graph& graph, const std::vector<int>& coarse_of, const Task& task);

  /// Starts again from `seed` alone, moves one vertex after the other from part 1 to part 0 until
  /// they weigh the same, and keeps the best state on the way.
  void grow(int seed);
  /// Passes of moves to one part and to the other in turn, `most` at most, until two of them have
  /// not helped.
  void improve(int most);

  /// Weight of the separator times that of the graph, more where the parts are uneven and much more
  /// where one is too heavy.
  std::int64_t cost() const;
  /// Of each vertex: the part, 0 or 1, or 2 in the separator.
  const std::vector<signed char>& sides() const { return side_; }
  /// Puts sides back that an earlier state had.
  void restore(const std::vector<signed char>& sides);

 private:
  struct Candidate {
    int gain, age, vertex;
    bool operator<(const Candidate& o) const {
      return gain != o.gain ? gain < o.gain : age < o.age;  // the newest first, which walks on
    }
  };
  struct Move {
    int vertex, pulled_end;
  };

  void count_sides();
  void add(int v);
  void begin_pass(int to);
  void offer(int v);
  bool best(Candidate& out);
  void move(int v);
  void end_pass(std::size_t moves_to_keep);

  const Graph* graph_ = nullptr;
  std::int64_t limit_ = 0;  // the most that a part should weigh
  std::vector<signed char> side_, coarse_side_;
  std::array<std::int64_t, 3> weight_{};
  std::vector<int> members_;  // of the separator, and some that left it

  // A pass.
  int to_ = 0;
  std::vector<int> pull_;    // of members: weight of their neighbours in the other part
  std::vector<char> moved_;  // vertices
  std::vector<Candidate> heap_;
  std::vector<Move> moves_;
  std::vector<int> pulled_;  // vertices that came into the separator, move after move
  int age_ = 0;
};

}  // namespace littoral
