#pragma once
// Oriented points on a level set of sampled values: what makes a signed distance of any implicit
// function (thesis, section 5.2, figure 5.10).

#include "base/task.h"
#include "littoral/polygon_soup.h"
#include "littoral/volume.h"

namespace littoral {

/// Points (points x 3) on {values = level} with normals (points x 3) towards larger values: about
/// one for each cell that the level set passes, never closer to each other than half the smallest
/// spacing. They lie on the level set of the cubic interpolant (Catmull-Rom along each axis), and
/// normals are its gradient: errors of third and second order in the spacing for smooth functions,
/// which need not be distances. Cells with a value that is not finite are passed over.
///
/// Throws InputError for a grid of fewer than two nodes along an axis, a wrong number of values, a
/// level that is not finite, or if the level set meets no cell.
PolygonSoup level_points(const Volume& field, double level, const Task& task);

}  // namespace littoral
