#pragma once
// How the level set of a trilinear function runs through one grid cell, and triangles for it.
// Corner c of a cell lies at its bits (x: 1, y: 2, z: 4); everything is about the eight values
// minus the level.

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "littoral/types.h"

namespace littoral::cell {

/// Edge e runs along axis e / 4 from corner `tail` to corner `head`.
struct Edge {
  int tail, head, axis;
  unsigned faces;  // bit 2 a + s: lies on the face where axis a is at s
};
const std::array<Edge, 12>& edges();

/// Closed chains of crossed edges on the faces of a cell; positive corners lie to the left seen
/// from outside the cell, so a polygon spanned by a chain faces them.
struct Loops {
  int count = 0;
  std::array<int, 5> begin{};   // loops + 1, into edge
  std::array<int, 12> edge{};   // crossed edges in order
  std::array<int, 8> region{};  // per corner: the part of the cell's faces of one sign it is in
  int size(int loop) const { return begin[loop + 1] - begin[loop]; }
};

/// Traces the chains. `positive` has bit c set where corner c is above the level. On a face with
/// alternating signs the sign of the bilinear function's saddle decides which corners are joined
/// (Nielson and Hamann 1991), so that neighbouring cells agree.
Loops trace_loops(const std::array<double, 8>& value, unsigned positive);

/// Two loops that bound one tube instead of two discs, where there are such: the trilinear function
/// joins, inside the cell, two regions that its faces keep apart.
std::optional<std::pair<int, int>> find_tunnel(const std::array<double, 8>& value,
                                               unsigned positive, const Loops& loops);

/// A piece of surface: corners 0..11 are the crossings of the cell's edges, from 12 on `inner`.
struct Patch {
  std::vector<Vec3> inner;                    // points inside the cell, in cell coordinates 0..1
  std::vector<std::array<int, 3>> triangles;  // counter-clockwise seen from larger values
  void clear() {
    inner.clear();
    triangles.clear();
  }
};

/// What is known of a cell.
struct Cell {
  std::array<double, 8> value;    // minus the level
  unsigned positive = 0;          // bit c: corner c is above the level
  std::array<Vec3, 12> crossing;  // of the crossed edges, in cell coordinates
  Vec3 spacing = Vec3::Ones();    // [length]
  bool trilinear = true;          // false: points inside are not moved onto the level set
};

/// Spans each chain of crossings by a disc, or two of them by a tube, so that edges inside the cell
/// never lie on its faces, where a neighbour might draw the same one. Discs are triangulated with
/// the shortest diagonals; where none are allowed, around a point inside.
void span_cell(const Cell& cell, Patch& patch);

}  // namespace littoral::cell
