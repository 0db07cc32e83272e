#pragma once
// What distance in space is measured from: meshes, soups and clouds become the same thing.

#include "base/task.h"
#include "littoral/polygon_soup.h"
#include "littoral/report.h"
#include "littoral/types.h"

namespace littoral {

/// Samples of an oriented surface.
struct OrientedPoints {
  MatX3 points{0, 3};   // samples x 3
  MatX3 normals{0, 3};  // samples x 3, unit, outward: distance is positive where they point
  VecX areas;           // samples [length^2], > 0

  Eigen::Index size() const { return points.rows(); }
};

/// One, at the barycentre, or three half way between it and the corners: these integrate quadratic
/// functions exactly.
enum class SamplesPerTriangle { one, three };

/// One sample per triangle, at its barycentre (section 8.2), or three. Polygons are triangulated
/// first; triangles with a side longer than `max_side` [length] are halved until no side is
/// (infinity: never). Faces without area are left out, with a warning.
///
/// Throws InputError for a soup without faces, a face with a vertex that is not finite, faces that
/// all have no area, or more than 2^26 samples.
OrientedPoints sample_faces(const PolygonSoup& soup, double max_side, Report& report,
                            SamplesPerTriangle count = SamplesPerTriangle::one,
                            const Task& task = {});

/// One sample per point, with its normal made unit and the area of its Voronoi cell among its
/// neighbours in its tangent plane. Points whose normal is zero or not finite are left out, with a
/// warning; points at one place share their area.
///
/// Throws InputError for fewer than three places, a point that is not finite, no normals, or
/// normals that are all zero.
OrientedPoints sample_cloud(const PolygonSoup& cloud, Report& report);

/// Distinct points with unit normals, in the order given; no areas. Coincident points become one
/// with their mean normal; where normals cancel the point is left out; both with a warning. Throws
/// InputError if a number is not finite (naming the point), a normal is zero, or nothing remains.
OrientedPoints distinct_points(const OrientedPoints& cloud, Report& report);

/// Mean distance between neighbouring samples, weighted by area: the side of an equilateral
/// triangle of the samples' area. On meshes of even triangles this is the mean edge length.
double sample_spacing(const OrientedPoints& samples);

}  // namespace littoral
