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
/// Throws InputError where what is inside fills the border of a mask as the outside does: more than
/// nine tenths of it, or more than half and a tenth more than of all nodes.
void check_side_of_mask(const Volume& mask, bool flip);

/// The volume as a shape. Distance is taken as it is. A mask is bounded half way between the nodes
/// that are 0 and those that are not, which are inside (outside with `flip`), and closed half a
/// spacing beyond its box; density has larger values than `threshold` inside (without one, half way
/// between the smallest and the largest). Both are then measured from anew. Of a mask
/// `flip` is done; otherwise it is part of the request. Throws InputError where there is no such
/// surface, and for a mask nobody called one whose inside fills its border.
Shape shape_of(Volume volume, VolumeMeaning meaning = VolumeMeaning::automatic,
               std::optional<double> threshold = {}, bool flip = false);

}  // namespace littoral
