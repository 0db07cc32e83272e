// Any bytes as a surface file: a soup whose indices are in range, or an InputError.

#include <cstdint>
#include <cstdlib>

#include "domain/mesh/surface_mesh.h"
#include "io/read.h"
#include "littoral/error.h"
#include "program_format.h"

namespace {

void require(bool condition) {
  if (!condition) std::abort();
}

void check(const littoral::PolygonSoup& soup) {
  const int n = soup.n_vertices();
  require(n > 0);
  require(soup.normals.rows() == 0 || soup.normals.rows() == n);
  for (const auto& [name, values] : soup.scalars) require(values.size() == n);
  for (int f = 0; f < soup.n_faces(); ++f) require(soup.face(f).size() >= 3);
  for (int v : soup.corners) require(v >= 0 && v < n);
  for (const auto& line : soup.lines) {
    require(line.size() >= 2);
    for (int v : line) require(v >= 0 && v < n);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try {
    const littoral::PolygonSoup soup =
        littoral::io::read_surface_bytes(bytes, program_format(), "input");
    check(soup);
    const littoral::SurfaceMesh mesh(soup);
    require(mesh.n_edges() <= static_cast<int>(soup.corners.size()));
  } catch (const littoral::InputError&) {
    // The file is wrong, and says so.
  } catch (const littoral::UnsupportedError&) {
    // Right, but of a kind that is not read.
  }
  return 0;
}
