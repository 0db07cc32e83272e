#pragma once
// How far offset surfaces really are from what they were made around.

#include "api/space/isosurfaces.h"

namespace littoral {

/// Measures a surface at a distance from the input and its completion, to their triangles, and
/// reports least, median (by area) and greatest distance, the share of the area that is nearest to
/// the completion, whether the surface is closed, and the three over what was asked, over the
/// completion and elsewhere. Warns where the median is more than 2 % off, a tenth of the area more
/// than a tenth, or a vertex more than 15 %, naming that. input, completion: with faces; the
/// latter may be empty.
void measure_offset(const Isosurface& offset, const PolygonSoup& input,
                    const PolygonSoup& completion, Report& report, const Task& task);

}  // namespace littoral
