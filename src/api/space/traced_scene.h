#pragma once
// Scenes whose surface is traced by rays through a field, without being meshed.

#include <optional>

#include "api/space/csg.h"
#include "io/render/scene.h"

namespace littoral {

struct TracedView {
  double level = 0;                  // [length] of the surface: an offset
  int axis = 2;                      // of the slice
  std::optional<double> position{};  // of the slice [length]; without it there is none
  bool for_page =
      false;  // the scene is for a page: with a slice always, if need be at the box' end
};

/// The level set of the shapes' field inside the box of a grid, and maybe a slice with its values
/// on the nodes of the grid, before which the surface is cut away as in volume scenes. The grid
/// also frames the picture. Pages trace the tori of up to eight clouds; throws UnsupportedError for
/// pages of anything else or of more than 200000 points, InputError if the level is not met in the
/// box, and as pointwise_distance.
io::Scene traced_scene(const CsgShapes& shapes, const Grid& grid, const TracedView& view, Task task,
                       Report& report);

}  // namespace littoral
