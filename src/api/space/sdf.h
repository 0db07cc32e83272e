#pragma once
// Signed distance in space in one call: from a mesh, soup or cloud to values on a grid or at
// points.

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "api/space/space_domain.h"
#include "base/task.h"
#include "littoral/polygon_soup.h"
#include "littoral/report.h"
#include "littoral/types.h"
#include "littoral/volume.h"

namespace littoral {

/// How an input is measured from: by which method, and from which side.
struct SpaceRequest {
  AnyMethod method;               // none: SpaceAutomatic
  bool flip = false;              // reverse all normals: the other side is positive
  bool estimate_normals = false;  // of a cloud, instead of those it has
  std::vector<double> values{};   // what distance is counted from, as of SpaceSources [length]
};

/// Throws InputError for values out of range, whatever the input is.
void check_grid_options(const GridOptions& request);

/// The grid asked for. With bounds, nodes lie on all of them, and spacings differ by axis as little
/// as that allows. Throws InputError for values out of range and for an input without extent,
/// IoError if computing on it will not fit into memory.
Grid choose_grid(const PolygonSoup& input, const GridOptions& request);

/// Signed distance at the nodes of the grid [length], negative inside.
///
/// Values scale with the input and do not change when it is moved with the grid. The report gets
/// method, domain, all options with the values used, sizes and seconds per stage. Throws InputError
/// for bad input (nothing to measure from, a box that misses it, ...), IoError where memory will
/// not do, Cancelled.
VecX grid_distance(const PolygonSoup& input, const Grid& grid, const SpaceRequest& request,
                   Task task, Report& report);

/// The same with the completion of the surface, where the method has one [length].
SpaceAnswer grid_answer(const PolygonSoup& input, const Grid& grid, const SpaceRequest& request,
                        Task task, Report& report);

/// The same through tets that fill the grid's box; with the values at their vertices.
SpaceAnswer tet_distance(const PolygonSoup& input, const Grid& grid, const TetFilling& filling,
                         const SpaceRequest& request, Task task, Report& report);

/// Signed distance (queries) [length] and, unless null, its gradient (queries x 3) at points
/// (queries x 3). Throws UnsupportedError for methods that need a grid, InputError for queries that
/// are not finite, otherwise as grid_distance.
VecX query_distance(const PolygonSoup& input, const MatX3& queries, const SpaceRequest& request,
                    MatX3* gradients, Task task, Report& report);

/// A field for such queries, in the units of the input [length]; may be asked from several threads.
/// Throws as query_distance.
std::shared_ptr<const PointwiseDistance> pointwise_distance(const PolygonSoup& input,
                                                            const SpaceRequest& request, Task task,
                                                            Report& report);

/// Throws InputError naming the first query (queries x 3) that is not finite; they are counted from
/// `first`.
void check_queries(const MatX3& queries, Eigen::Index first = 0);

/// Generalized winding number (queries) at points (queries x 3): 1 inside, 0 outside of a closed
/// surface. Of the request, only flip and estimate_normals count. `smoothing` > 0 convolves it with
/// a Gaussian of that deviation [length]; points of clouds should be closer together. Throws as
/// query_distance.
VecX query_winding(const PolygonSoup& input, const MatX3& queries, const SpaceRequest& request,
                   Task task, Report& report, double smoothing = 0);

/// The same at the nodes of a grid.
VecX grid_winding(const PolygonSoup& input, const Grid& grid, const SpaceRequest& request,
                  Task task, Report& report, double smoothing = 0);

/// The tori that method tori fits to the input, as a cloud that later calls take as it is
/// (api/space/tori_cloud.h). Throws as query_distance.
PolygonSoup fit_tori_cloud(const PolygonSoup& input, const SpaceRequest& request, Task task,
                           Report& report);

}  // namespace littoral
