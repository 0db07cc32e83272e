#pragma once
// Normals for point clouds that have none.

#include "base/task.h"
#include "littoral/types.h"

namespace littoral {

/// Throws InputError for fewer than three different places or a point that is not finite.
void check_cloud(const MatX3& points);

/// Unit normals of a cloud (points x 3): the direction in which the nearest points vary least,
/// signs agreeing along a tree that prefers neighbours with parallel normals (Hoppe et al.,
/// "Surface reconstruction from unorganized points", 1992); the highest point of each connected
/// part of the neighbourhood graph looks up. Throws InputError as check_cloud, and Cancelled.
MatX3 estimate_normals(const MatX3& points, const Task& task);

}  // namespace littoral
