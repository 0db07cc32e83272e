#pragma once
// Distance to the nearest point of a surface in space, with a sign from elsewhere: what everybody
// uses on perfect geometry, and the baseline on broken geometry (thesis chapters 2 and 7).

#include <memory>

#include "methods/implicit/pointwise.h"
#include "sources/space/oriented_points.h"

namespace littoral {

/// Where the sign comes from. winding: the generalized winding number, negative where it exceeds
/// 1/2. pseudonormal: the angle-weighted normal at the nearest point (Baerentzen and Aanaes 2005),
/// exact on closed, consistently oriented meshes; on clouds the normal of the nearest point.
enum class SignRule { winding, pseudonormal };

/// To triangles. points: n x 3; faces: m x 3, rows index points, finite.
std::unique_ptr<const PointwiseDistance> closest_point_distance(const MatX3& points,
                                                                const MatX3i& faces, SignRule rule);

/// To the points of a cloud.
std::unique_ptr<const PointwiseDistance> closest_point_distance(const OrientedPoints& samples,
                                                                SignRule rule);

}  // namespace littoral
