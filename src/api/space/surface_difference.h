#pragma once
// How far two surfaces are from each other.

#include "base/task.h"
#include "littoral/polygon_soup.h"

namespace littoral {

/// Distances from points of one surface to the nearest points of another one [length].
struct OneSidedDistance {
  double largest = 0, mean = 0, rms = 0, median = 0, p95 = 0, p99 = 0;  // 95 %, 99 % are nearer
  VecX at_vertices;                                                     // of the first surface
};

/// From `from` to `to`: at about `samples` points spread evenly over its area, the same in every
/// run, for the means; at these and all vertices for the largest. Of a cloud, its points. Throws
/// InputError where there is nothing, for coordinates that are not finite and for no area.
OneSidedDistance one_sided_distance(const PolygonSoup& from, const PolygonSoup& to, int samples,
                                    Task task);

/// n points (n x 3) spread evenly over the area, the same in every run. Throws InputError for no
/// area.
MatX3 spread_over(const PolygonSoup& surface, int n);

}  // namespace littoral
