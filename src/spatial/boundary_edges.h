#pragma once
// Where a surface in space ends.

#include <array>
#include <vector>

#include "littoral/types.h"

namespace littoral {

/// The sides of faces that other faces do not run back along as often: the boundary of the surface
/// as a chain, each once, from vertex to vertex. None where the surface is closed and consistently
/// oriented, nonmanifold edges or not: its winding number is then an integer everywhere. Vertices
/// at one position count as one; faces with a corner that is not finite count as nothing, and so do
/// faces whose corners are in one line and whose sides all are free.
/// points: n x 3; faces: m x 3, rows index points.
std::vector<std::array<int, 2>> boundary_edges(const MatX3& points, const MatX3i& faces);

/// The same, each as often as it counts. `nothing`, unless null: 1 for faces in one line that count
/// as nothing.
std::vector<std::array<int, 2>> boundary_chain(const MatX3& points, const MatX3i& faces,
                                               std::vector<char>* nothing = nullptr);

/// A chain's edges, each as often as it is there one after the other, once.
std::vector<std::array<int, 2>> each_once(std::vector<std::array<int, 2>> chain);

/// The faces in their order, but for those with the corners of an earlier one, by position and in
/// the same sense: the surface as a set, which is covered once. m x 3, as given where there are no
/// copies.
MatX3i without_copies(const MatX3& points, const MatX3i& faces);

/// For each vertex, the lowest one at its position.
std::vector<int> same_positions(const MatX3& points);

}  // namespace littoral
