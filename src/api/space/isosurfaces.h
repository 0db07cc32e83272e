#pragma once
// Level sets of volumes, and what is made of them: offsets, opened and closed shapes.

#include <filesystem>
#include <string>
#include <vector>

#include "base/task.h"
#include "littoral/polygon_soup.h"
#include "littoral/report.h"
#include "littoral/space.h"
#include "littoral/volume.h"
#include "methods/implicit/pointwise.h"

namespace littoral {

/// One level set.
struct Isosurface {
  double level = 0;
  PolygonSoup surface;
};

/// The level sets of a volume's values, one for each level, as `isosurface` makes them. Levels that
/// are not met are warnings in the report; throws InputError if none is. `exact`: the function that
/// was sampled, if there is one; vertices lie where it takes the level.
std::vector<Isosurface> isosurfaces(const Volume& volume, const std::vector<double>& levels,
                                    bool close_at_box, Report& report, Task task,
                                    const PointwiseDistance* exact = nullptr);

/// Offsets of the shape {distance <= 0}: the surfaces at the given distances [length], positive
/// outside. With `exact`, the function that was sampled, vertices lie where that takes the
/// distances, not where the line between two nodes does. Opening and closing measure the distance
/// from the eroded or dilated surface anew, to its triangles, so their accuracy is that of the
/// grid; others have that of `exact`. Throws InputError for a negative radius, if nothing is left
/// of the shape, and as isosurfaces.
std::vector<Isosurface> offset_isosurfaces(const Volume& distance,
                                           const std::vector<double>& offsets,
                                           const Morphology& morphology, bool close_at_box,
                                           Report& report, Task task,
                                           const PointwiseDistance* exact = nullptr);

/// A closed wall about each of the offsets: the surface half the thickness farther out and,
/// reversed, the one half the thickness farther in, so that what lies between them is inside. Where
/// the inner one is not there the wall is solid, with a warning. Throws InputError for a thickness
/// that is not positive, and as above.
std::vector<Isosurface> wall_isosurfaces(const Volume& distance, const std::vector<double>& offsets,
                                         double thickness, const Morphology& morphology,
                                         bool close_at_box, Report& report, Task task,
                                         const PointwiseDistance* exact = nullptr);

/// All surfaces as one surface, with the scalar "level".
PolygonSoup join_isosurfaces(const std::vector<Isosurface>& surfaces);

/// Writes surfaces: all into one file, or each into its own where there are as many files as
/// levels. Throws InputError for another number of files.
void write_isosurfaces(const std::vector<std::string>& files,
                       const std::vector<Isosurface>& surfaces);

}  // namespace littoral
