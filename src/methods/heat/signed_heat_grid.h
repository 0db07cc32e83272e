#pragma once
// The signed heat method in space on a regular grid (section 8.2).

#include <vector>

#include "base/option_table.h"
#include "base/task.h"
#include "littoral/options.h"
#include "littoral/report.h"
#include "operators/grid.h"
#include "sources/space/oriented_points.h"

namespace littoral {

/// Names, ranges, defaults and one sentence for each of the above.
const OptionTable<SpaceSignedHeat>& space_heat_options();

/// What is left to choose chosen: constraint and weight. `conforming`: on tets that are given or
/// follow the input.
SpaceSignedHeat settled(SpaceSignedHeat options, bool conforming);

/// Throws InputError for level sets with sharpen, which holds one zero set, and, where sources have
/// different values, for level sets; UnsupportedError for sharpen there.
void check_level_sets(const SpaceSignedHeat& options, bool different_values);

/// Generalized signed distance to the source at the nodes [length]. h is `sample_spacing(source)`.
///
/// X is the free-space convolution (convolve.h), Y = X / |X|, and phi solves L phi = G^T Y with the
/// natural boundary condition on the box. Constraint none: the mean of phi over the source (by
/// area) is 0. zero-set: the mean over the part of the source in each grid cell is 0, which follows
/// noise and holes cell by cell. soft = w: penalty w times the area in the cell over h, which
/// follows the source at the scale of h.
/// level-sets: one value along each part of the source, their mean by area 0. part: of each sample;
/// empty: all are one. value: what distance is counted from at each sample, which takes the place
/// of 0, in the mean over a cell; empty: 0.
VecX signed_heat_grid(const Grid& grid, const OrientedPoints& source,
                      const SpaceSignedHeat& options, Task task, Report& report,
                      const std::vector<int>& part = {}, const std::vector<double>& value = {});

/// What is held of the rows of a source, for `solve_constrained`, and the shift of its answer.
struct HeldRows {
  VecX softness;           // rows
  std::vector<int> group;  // rows, or empty
};
HeldRows held_rows(const SpaceSignedHeat& options, const VecX& weight, double scale,
                   const std::vector<int>& part);

}  // namespace littoral
