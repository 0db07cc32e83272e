#pragma once
// The shortest way to complete broken curves so that they bound: integer winding numbers on faces.

#include <vector>

#include "base/task.h"
#include "littoral/report.h"
#include "littoral/types.h"
#include "operators/jump_calculus.h"

namespace littoral {

/// Winding numbers that change by what the curve says, but for jumps of least total length.
struct ShortestCompletion {
  VecXi region;  // faces, from 0 on each part
  VecX jump;     // edges, of the winding number: left minus right

  /// Of the faces that edges connect, those of three or more faces among them; lengths in units of
  /// the triangulation.
  struct Part {
    double given = 0;      // curve, as often as it runs along each edge
    double added = 0;      // jumps off the curve
    double overruled = 0;  // curve whose jump is another
    int largest = 0;       // winding number
    int ends = 0;          // where an odd number of edges of the curve meet, off the boundary
    bool solved = true;    // false: it does not bound, and no completion was asked for

    bool bounds() const { return solved && added == 0 && overruled == 0; }
  };
  std::vector<Part> parts;
  std::vector<int> part;  // faces
};

/// Which parts that do not bound get a completion.
enum class Complete { none, without_ends, all };

/// `curve` (edges): how often it runs along each edge, against counted negative. Parts whose
/// curve bounds are labelled by walking over the faces; others by a minimum-cost flow, in which a
/// jump that differs from the curve's costs `curve_weight` times its length on the curve, and its
/// length elsewhere. Throws UnsupportedError where the curve runs along an edge of three or more
/// faces, which has no sides.
ShortestCompletion shortest_completion(const JumpCalculus& J, const VecX& curve, Complete which,
                                       double curve_weight, const Task& task, Report& report);

}  // namespace littoral
