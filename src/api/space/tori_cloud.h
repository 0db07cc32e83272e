#pragma once
// Fitted tori as a point cloud with numbers at its points: what files hold of them.

#include <vector>

#include "domain/mesh/polygon_soup.h"
#include "methods/tori/torus.h"

namespace littoral {

/// Points (points x 3) with the normals of their tori, and per point the scalars torus_qx, _qy,
/// _qz, torus_e1x, _e1y, _e1z, torus_k1, torus_k2, torus_rho and torus_weight.
PolygonSoup cloud_of_tori(const MatX3& points, const std::vector<Torus>& tori);

/// Does a cloud have all of these?
bool has_tori(const PolygonSoup& cloud);

/// The tori of such a cloud. Throws InputError naming the point if a number is not finite, a
/// direction has no length, a spacing is not positive or a weight is positive.
std::vector<Torus> tori_of_cloud(const PolygonSoup& cloud);

}  // namespace littoral
