#pragma once
// Fitted tori as a point cloud with numbers at its points: what files hold of them.

#include <memory>
#include <vector>

#include "api/space/space_input.h"
#include "base/option_table.h"
#include "littoral/options.h"
#include "littoral/polygon_soup.h"
#include "methods/tori/tori.h"

namespace littoral {

/// Points (points x 3) with the normals of their tori, and per point the scalars torus_qx, _qy,
/// _qz, torus_e1x, _e1y, _e1z, torus_k1, torus_k2, torus_rho and torus_weight.
PolygonSoup cloud_of_tori(const MatX3& points, const std::vector<Torus>& tori);

/// Does a cloud have all of these?
bool has_tori(const PolygonSoup& cloud);

/// The tori of such a cloud. Throws InputError naming the point if a number is not finite, a
/// direction has no length, a spacing is not positive or a weight is positive.
std::vector<Torus> tori_of_cloud(const PolygonSoup& cloud);

/// What method tori makes of an input: the tori it holds, or fitted ones.
std::unique_ptr<const ToriDistance> fit_tori(const SpaceInput& input, const Tori& options,
                                             const Task& task, Report& report);

/// Names, ranges, defaults and one sentence for each option of method tori.
const OptionTable<Tori>& tori_options();

}  // namespace littoral
