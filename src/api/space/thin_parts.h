#pragma once
// Does a grid hold the thin parts of what distance is measured from?

#include "api/space/space_input.h"
#include "littoral/volume.h"
#include "methods/implicit/pointwise.h"

namespace littoral {

/// Reports which share of the surface bounds parts, or gaps, thinner than the grid's spacing that
/// no node lies in, so that contours miss or tear them, and warns beyond a hundredth, naming the
/// resolution that would hold them.
///
/// A sample is held if cells at it and a spacing to either side of it have nodes both inside and
/// outside. Of the others, those that touch a ball of the missing side count: the largest one
/// there is as thick as the part (as in Ma, Bae and Choi, "3D medial axis point approximation
/// using nearest neighbors and the normal field", 2012). So sheets do not count, and edges and
/// corners of thick parts do not. All in the input's frame; values at the nodes of the grid.
void warn_of_thin_parts(const PointwiseDistance& distance, const OrientedPoints& samples,
                        const Grid& grid, const VecX& values, Report& report);

}  // namespace littoral
