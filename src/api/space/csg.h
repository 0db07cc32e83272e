#pragma once
// Distance to shapes made of several inputs: union, intersection, difference, blend and offset.

#include <memory>
#include <optional>
#include <vector>

#include "api/space/sdf.h"
#include "littoral/volume.h"
#include "methods/implicit/combined.h"

namespace littoral {

/// One input: a surface, soup or cloud asked by a method, or signed distance that is there already.
struct Shape {
  PolygonSoup surface;          // unless there is a field
  std::optional<Volume> field;  // taken as it is, trilinear (api/space/sampled_distance.h)
  SpaceRequest request;         // of the surface; of a field, only flip counts
};

/// What a volume of any values bounds at a level, to be measured from anew at points. Throws
/// InputError where there is nothing.
Shape shape_at_level(const Volume& volume, double level);

/// Shapes and what becomes of them: csg.operations has one entry for each but the first.
struct CsgShapes {
  std::vector<Shape> all;
  Csg csg;

  /// Nothing but one surface: then everything is as for that alone.
  bool plain() const {
    return all.size() == 1 && !all.front().field && csg.offset == 0 && csg.blend == 0;
  }
};

/// Adds what is said of a shape other than the first: its warnings, times and bad status.
void add_report_of(std::size_t shape, const Report& its, Report& report);

/// The box around all of them. Throws InputError for coordinates that are not finite.
Box bounding_box(const CsgShapes& shapes);

/// The longest side of the box around all of them [length], > 0. Throws InputError for shapes
/// without extent or with coordinates that are not finite.
double longest_side(const CsgShapes& shapes);

/// The grid asked for, around all of the shapes; a lone field's own grid if nothing else is asked.
/// Throws as for one input.
Grid choose_grid(const CsgShapes& shapes, const GridOptions& request);

/// Signed distance or, with several shapes, the bound that `combine` describes, at the nodes of the
/// grid [length]. The report is the first shape's, with all warnings. Throws as grid_distance for
/// one input, and InputError for radii that are not finite or negative.
VecX grid_distance(const CsgShapes& shapes, const Grid& grid, Task task, Report& report);

/// The same with the completion of the surface, where there is but one and the method has one.
SpaceAnswer grid_answer(const CsgShapes& shapes, const Grid& grid, Task task, Report& report);

/// The same at any point: a field that can be asked in the units of the input. Throws
/// UnsupportedError for methods that need a grid.
std::shared_ptr<const PointwiseDistance> pointwise_distance(const CsgShapes& shapes, Task task,
                                                            Report& report);

/// At points (queries x 3), with gradients (queries x 3) unless null.
VecX query_distance(const CsgShapes& shapes, const MatX3& queries, MatX3* gradients, Task task,
                    Report& report);

}  // namespace littoral
