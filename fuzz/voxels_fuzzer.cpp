// Any bytes as a .vol file: as many voxels as the grid has nodes, or an InputError.

#include <cstdint>
#include <cstdlib>

#include "io/volume/read_voxels.h"
#include "littoral/error.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try {
    const littoral::io::VoxelMask mask = littoral::io::read_vol_bytes(bytes, "input");
    if (mask.inside.empty() || mask.inside.size() != mask.grid.n_nodes()) std::abort();
  } catch (const littoral::InputError&) {
    // The file is wrong, and says so.
  } catch (const littoral::UnsupportedError&) {
    // Right, but of a kind that is not read.
  }
  return 0;
}
