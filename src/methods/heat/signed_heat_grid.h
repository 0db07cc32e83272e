#pragma once
// The signed heat method in space on a regular grid (section 8.2).

#include "base/option_table.h"
#include "base/report.h"
#include "base/task.h"
#include "operators/grid.h"
#include "sources/oriented_points.h"

namespace littoral {

/// How values at the source are held (section 7.1): not, at zero, or pulled towards zero. Level
/// sets of parts are not told apart in space.
enum class SpaceConstraint { none, zero_set, soft };

struct SpaceHeatOptions {
  double time_scale = 1;  // t = time_scale h^2
  int constraint = static_cast<int>(SpaceConstraint::soft);
  double soft = 10;      // weight of the penalty
  bool sharpen = false;  // afterwards (7.3), for whoever calls
};

/// Names, ranges, defaults and one sentence for each of the above.
const OptionTable<SpaceHeatOptions>& space_heat_options();

/// Generalized signed distance to the source at the nodes [length]. h is `sample_spacing(source)`.
///
/// X is the free-space convolution (convolve.h), Y = X / |X|, and phi solves L phi = G^T Y with the
/// natural boundary condition on the box. Constraint none: the mean of phi over the source (by
/// area) is 0. zero-set: the mean over the part of the source in each grid cell is 0, which follows
/// noise and holes cell by cell. soft = w: penalty w times the area in the cell over h, which
/// follows the source at the scale of h.
VecX signed_heat_grid(const Grid& grid, const OrientedPoints& source,
                      const SpaceHeatOptions& options, Task task, Report& report);

}  // namespace littoral
