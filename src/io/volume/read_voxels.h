#pragma once
// Sets of voxels in files.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "littoral/volume.h"

namespace littoral::io {

/// Voxels centred at the grid's nodes; not 0 is inside.
struct VoxelMask {
  Grid grid;
  std::vector<unsigned char> inside;  // x fastest
};

/// Reads a mask: .vol (versions 2 and 3, one byte a voxel; spacing 1, origin 0), or any volume of
/// read_volume whose values are not 0 inside. Throws InputError naming the file and what is wrong
/// (values of both signs are a field of distance and no mask), IoError.
VoxelMask read_voxels(const std::filesystem::path& path);

/// A .vol file from memory. Never allocates more than about a thousand times bytes.size().
VoxelMask read_vol_bytes(std::string_view bytes, const std::string& name);

}  // namespace littoral::io
