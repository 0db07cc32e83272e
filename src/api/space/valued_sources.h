#pragma once
// Distance in space that is counted from values of the input's faces or points.

#include <vector>

#include "api/space/space_domain.h"

namespace littoral {

/// One number for all of an input, or one for each face of a surface or each point of a cloud
/// [length]. Throws InputError where there are others, and for numbers that are not finite.
void check_values(const PolygonSoup& input, const std::vector<double>& values);

/// How far an input with values reaches beyond itself: where distance counted from them is 0
/// [length], >= 0.
double reach_of_values(const std::vector<double>& values);

/// Solves by a method, from any domain. One value of all the input is added to any method's answer.
/// Where values differ, methods that can be asked at points tell sides, and the distance is the
/// least of c + d on positive sides and the greatest of c - d on negative ones, exactly; signed
/// heat holds the values itself; of all others UnsupportedError. A cloud without normals has no
/// sides: with values, those methods that measure to the input count up from its points everywhere.
/// Values that others reach sooner are warned of.
SpaceAnswer solve_from_values(const AnyMethod& method, const SpaceDomain& domain,
                              const SpaceSources& sources, Task task, Report& report);

}  // namespace littoral
