// Any bytes as a source file for a small mesh: nodes on it, or an InputError. The first byte
// chooses the format and the index base.

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <optional>

#include "domain/mesh/surface_mesh.h"
#include "io/read.h"
#include "littoral/error.h"

namespace {

const littoral::SurfaceMesh& mesh() {
  static const littoral::SurfaceMesh result(littoral::io::read_surface_bytes(
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 2 2 0\nv 0 2 0\nv nan 0 0\n"
      "f 1 2 3\nf 2 4 3\nf 3 4 5 6\n",
      ".obj", "mesh.obj"));
  return result;
}

void check(const littoral::SurfacePoint& p) {
  const littoral::Vec3 x = mesh().position(p);
  const double sum = p.b[0] + p.b[1] + p.b[2];
  if (!x.allFinite() || !(std::abs(sum - 1) < 1e-12)) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  constexpr std::array<const char*, 4> formats{".txt", ".json", ".obj", ".ply"};
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  const int choice = data[0] / 4 % 3;
  const std::optional<int> base = choice < 2 ? std::optional<int>(choice) : std::nullopt;
  try {
    littoral::Report report;
    const littoral::Sources sources = littoral::io::read_sources_bytes(
        bytes, formats[data[0] % 4], "input", mesh(), base, report);
    if (sources.empty()) std::abort();
    for (const auto& curve : sources.curves) {
      if (curve.nodes.size() < 2) std::abort();
      for (const auto& node : curve.nodes) check(node);
    }
    for (const auto& node : sources.points) check(node);
    for (const auto& curve : sources.space_curves) {
      if (curve.points.rows() < 2 || !curve.points.allFinite()) std::abort();
    }
  } catch (const littoral::InputError&) {
    // The file is wrong, and says so.
  }
  return 0;
}
