#pragma once
// What runs cost, roughly: measured constants.

#include <optional>
#include <string>

namespace littoral::cli {

struct RunCost {
  double seconds = 0;  // of one processor
  double bytes = 0;
};
/// What distance in space costs beside its nodes or points: the input in cells of the grid, or of
/// the finer one that points are asked on.
struct SurfaceWork {
  double faces = 0;        // triangles
  double cells = 0;        // about so many hold a part of the surface
  double free_length = 0;  // of free edges, in sides of a cell
  double open_faces = 0;   // faces, where there are free edges
};
/// Of a verb with a method on so many elements: vertices of a surface, nodes of a grid or points of
/// a query. None where nothing was measured.
std::optional<RunCost> run_cost(const std::string& verb, const std::string& method, double elements,
                                const SurfaceWork& work);

}  // namespace littoral::cli
