// Any bytes as a file of tets: indices in range, as many values as vertices, or an error.

#include <cstdint>
#include <cstdlib>

#include "io/tet/tets.h"
#include "littoral/error.h"
#include "program_format.h"

namespace {

void require(bool condition) {
  if (!condition) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try {
    const littoral::io::TetFile file =
        littoral::io::read_tets_bytes(bytes, program_format(), "input");
    const int n = file.mesh.n_vertices();
    require(file.mesh.n_tets() > 0);
    for (const int v : file.mesh.tets.reshaped()) require(v >= 0 && v < n);
    for (const int v : file.triangles.reshaped()) require(v >= 0 && v < n);
    for (const auto& [name, values] : file.scalars) require(values.size() == n);
  } catch (const littoral::InputError&) {
    // The file is wrong, and says so.
  } catch (const littoral::UnsupportedError&) {
    // Right, but of a kind that is not read.
  }
  return 0;
}
