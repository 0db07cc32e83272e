#pragma once
// Points of a cloud that its other points do not bear out.

#include "base/task.h"
#include "littoral/report.h"
#include "sources/space/oriented_points.h"

namespace littoral {

/// The cloud without points that hardly any neighbour agrees with, and a warning that says how many
/// they were. Two points agree if each lies near the other's plane and their normals are alike, as
/// on a surface; a point needs a third of its twelve neighbours, so that points at edges and
/// corners stay. Repeated until none is left out, at most four times. Points must be distinct and
/// finite, normals unit; a cloud that hardly anything would be left of stays as it is.
OrientedPoints without_outliers(const OrientedPoints& cloud, const Task& task, Report& report);

}  // namespace littoral
