// Any bytes as a volume file: values for every node of a sound grid, or an InputError.

#include <cstdint>
#include <cstdlib>

#include "io/volume/volume.h"
#include "littoral/error.h"
#include "program_format.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try {
    const littoral::Volume field =
        littoral::io::read_volume_bytes(bytes, program_format(), "input");
    const littoral::Grid& grid = field.grid;
    const bool sound = static_cast<std::size_t>(field.values.size()) == grid.n_nodes() &&
                       field.values.size() > 0 && grid.spacing.minCoeff() > 0 &&
                       grid.origin.allFinite();
    if (!sound) std::abort();
  } catch (const littoral::InputError&) {
    // The file is wrong, and says so.
  } catch (const littoral::UnsupportedError&) {
    // Right, but of a kind that is not read.
  }
  return 0;
}
