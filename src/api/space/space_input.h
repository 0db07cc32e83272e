#pragma once
// What all distances in space begin with: the input moved to the origin, scaled and sampled.

#include <memory>
#include <string>
#include <vector>

#include "api/space/frame.h"
#include "base/task.h"
#include "littoral/polygon_soup.h"
#include "littoral/report.h"
#include "sources/space/oriented_points.h"

namespace littoral {

/// What distance in space is measured from: a surface where the soup has faces, otherwise a cloud.
struct SpaceSources {
  const PolygonSoup& soup;
  bool flip = false;              // reverse all normals: the other side is positive
  bool estimate_normals = false;  // of a cloud, instead of those it has
  // What distance is counted from [length]: nothing, one number for all, or one for each face or
  // each point of a cloud.
  std::vector<double> values{};
};

/// The same in a frame's units: triangles, or points with normals, and samples.
struct SpaceInput {
  PolygonSoup surface;      // triangles, or points with normals and no faces
  OrientedPoints samples;   // of it, as fine as was asked for
  std::vector<Torus> tori;  // at the points, where the file held fitted ones; or empty
  bool flipped = false;     // normals were reversed
  std::vector<double> values, sample_values;  // of triangles or points, and of samples; or empty

  bool is_cloud() const { return surface.n_faces() == 0; }
  MatX3i triangles() const;  // faces x 3
};

/// Of the faces or, without any, of the points. Throws InputError for an input without either, and
/// for coordinates that are not finite.
Box bounding_box(const PolygonSoup& input);
/// "(x, y, z) to (x, y, z)" in messages.
std::string box_text(const Box& box);

/// Faces are sampled so that no side is longer than max_side. Throws InputError where there is
/// nothing to measure from.
SpaceInput make_input(const SpaceSources& sources, const Frame& frame, double max_side, Task& task,
                      Report& report);

/// Throws InputError for a grid without two nodes along each axis, a box that is not finite or too
/// many nodes, IoError if computing on it will not fit into memory.
void check_grid(const Grid& grid);

/// The box of the input; throws InputError unless it meets that of the grid, and as check_grid.
Box box_on_grid(const PolygonSoup& input, const Grid& grid);

}  // namespace littoral
