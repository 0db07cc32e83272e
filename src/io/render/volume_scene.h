#pragma once
// What pages and pictures show of a volume: a slice with isolines and an isosurface before it.

#include <optional>

#include "io/render/scene.h"
#include "littoral/volume.h"

namespace littoral::io {

struct VolumeView {
  int axis = 2;                      // the slice is orthogonal to x, y or z
  std::optional<double> position{};  // along the axis [length]; default: the middle of the box
  std::optional<double> level{};  // of the isosurface; default: 0, or half way where 0 is not met
  bool isosurface = true;
};

/// A scene with the slice through the nodes nearest to the position, and the part of the isosurface
/// at larger coordinates along the axis, on the side of the eye: the slice would hide the rest.
/// Where values are not all finite there is no isosurface. Pages also get the volume itself, at
/// most 256 nodes along an axis, to move through. Throws InputError for a grid of fewer than two
/// nodes along an axis, a position outside the box, or a level that is not finite.
Scene make_volume_scene(const Volume& volume, const VolumeView& view = {});

}  // namespace littoral::io
