#pragma once
// Repair that leaves the input's triangles where they are.

#include <optional>

#include "base/task.h"
#include "littoral/polygon_soup.h"
#include "littoral/report.h"

namespace littoral {

/// A closed surface that is made of an input's triangles.
struct KeptSurface {
  PolygonSoup surface;  // triangles, outward
  double turned = 0;    // share of the input's triangles that lie the other way round here
  double dropped = 0;   // share of its area that lies within the rest, or in nothing
};

/// The input with coincident corners merged, doubled faces made one, faces turned outward and parts
/// within other parts left out; nothing unless that is closed, manifold and free of crossings.
///
/// Inside is what `auto` says it is (methods/implicit/settled_sides.h), at two places beside a
/// triangle of each part: a part bounds where they differ. The report gets what that says of the
/// input. Throws Cancelled.
std::optional<KeptSurface> kept_surface(const PolygonSoup& input, Task task, Report& report);

}  // namespace littoral
