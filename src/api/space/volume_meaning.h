#pragma once
// What the values of a volume stand for: they look alike in a file, and a mask taken for distance
// gives wrong numbers without a word.

#include <optional>

#include "api/space/csg.h"
#include "littoral/space.h"
#include "littoral/volume.h"

namespace littoral {

/// What `automatic` stands for: a mask where the values are 0 and one other number, signed distance
/// where they have both signs and a slope near 1, at their zero set and in at least a third of the
/// cells that are not flat. Throws InputError that says what was seen and what to choose from.
VolumeMeaning meaning_of(const Volume& volume);

/// The volume as a shape. Distance is taken as it is. A mask is bounded half way between the nodes
/// that are 0 and those that are not, and closed half a spacing beyond its box; density has larger
/// values than `threshold` inside (without one, half way between the smallest and the largest).
/// Both are then measured from anew. Throws InputError where there is no such surface.
Shape shape_of(Volume volume, VolumeMeaning meaning = VolumeMeaning::automatic,
               std::optional<double> threshold = {});

}  // namespace littoral
