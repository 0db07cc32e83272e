#include "cli/plan/run_costs.h"

#include <array>
#include <cmath>
#include <limits>
#include <string_view>

namespace littoral::cli {

namespace {

constexpr double unit = 1e4;          // elements
constexpr double program = 13 << 20;  // bytes without any
constexpr double start = 0.007;       // seconds

/// Memory beyond so many elements.
struct Beyond {
  double elements = std::numeric_limits<double>::infinity();
  double fixed = 0, bytes = 0;  // altogether, and for each element
};

/// seconds (elements / unit)^power of one processor, and bytes for each element, of pairs for each
/// pair; and of each cell that holds a part of the surface, where nodes near it cost more.
struct Row {
  std::string_view verb, method;  // method empty: whichever it is
  double seconds, power, bytes, cell_seconds = 0, cell_bytes = 0;
  bool patches = false;  // looks for patches where the surface has free edges
  Beyond beyond{};
};

constexpr double face_seconds = 2.3e-6, face_bytes = 900;  // of distance in space: each face

// Of bench/studies/run_costs.py too: what is done where the surface has free edges: it orients
// faces and looks for patches.
constexpr double patch_start = 0.045;    // seconds
constexpr double patch_seconds = 3e-5;   // for each side of a cell along a free edge
constexpr double orient_seconds = 1e-4;  // for each face
constexpr double beside_patches = 1.5;   // times as long for each node or point
constexpr double patch_bytes = 200;      // for each cell that holds a part of the surface

// Of large meshes heat is solved window by window and the Poisson step iterates
// (src/solve/heat/heat_system.cpp, src/solve/poisson/poisson.cpp): tori of 1 to 10 million faces,
// for unsigned-heat of 1 million.
constexpr double largest_whole = 4e5;  // vertices
constexpr Beyond signed_windows = {largest_whole, 0.6e9, 0.9e3};
constexpr Beyond unsigned_windows = {largest_whole, 0.6e9, 1.24e3};

// Of two runs each by bench/studies/run_costs.py, `sdf` by cells: of a sphere with bumps on grids
// of 48 to 512 nodes a side. Where work depends on more than the size (auto, exact, quadratic,
// regularized and signed heat), through runs of 5,000 to 5 million vertices and of grids to 256
// nodes a side, among them those of bench/studies/estimates.py. Pairs by `auto` are walked as by
// `exact`; by heat, of 8,066 and 18,242 vertices, from many of which at once.
constexpr std::array rows = std::to_array<Row>({
    {"distance", "auto", 0.075, 1.30, 1.32e+03},
    {"distance", "signed-heat", 0.185, 1.06, 6.09e+03, 0, 0, false, signed_windows},
    {"distance", "unsigned-heat", 0.128, 1.02, 4.4e+03, 0, 0, false, unsigned_windows},
    {"distance", "exact", 0.075, 1.30, 794},
    {"distance", "fast-marching", 0.0207, 1.01, 1.16e+03},
    {"distance", "quadratic", 2.6, 1.22, 1.22e+04},
    {"distance", "regularized", 0.3, 1.08, 2.7e+03},
    {"distance", "belyaev-fayolle", 0.192, 1.22, 2.7e+03},
    {"winding", "", 0.0654, 1.05, 3.12e+03},
    {"pairs", "auto", 456, 2.19, 16.3},
    {"pairs", "exact", 456, 2.19, 16.3},
    {"pairs", "signed-heat", 14.6, 2.10, 18.9},
    {"pairs", "unsigned-heat", 12.4, 2.10, 18.9},
    {"pairs", "regularized", 962, 2.15, 18},
    {"pairs", "fast-marching", 211, 2.34, 15.4},
    {"sdf", "auto", 0.00127, 1.00, 8, 1.6e-5, 250, true},
    {"sdf", "winding", 0.0015, 1.00, 17.5, 1.6e-5, 250},
    {"sdf", "closest-point", 0.00127, 1.00, 17.5, 1.6e-5, 250},
    {"sdf", "tori", 0.0213, 1.00, 65.2},
    {"sdf", "signed-heat", 0.0065, 1.30, 39.1},
    {"query", "auto", 0.0209, 1.00, 424, 0, 0, true},
    {"query", "winding", 0.0208, 1.00, 477},
    {"query", "closest-point", 0.0187, 1.00, 424},
    {"query", "tori", 0.11, 1.00, 2.28e+03},
    {"query", "hopf-cole", 0.637, 1.00, 794},
    {"query", "planar", 0.343, 1.00, 794},
    {"query", "log-sum-exp", 0.317, 1.00, 1.8e+03},
    {"repair", "auto", 0.011, 1.00, 46.2, 0, 0, true},
    {"repair", "", 0.011, 1.00, 46.2},
});

}  // namespace

std::optional<RunCost> run_cost(const std::string& verb, const std::string& method, double elements,
                                const SurfaceWork& work) {
  for (const Row& row : rows) {
    if (row.verb != verb || (!row.method.empty() && row.method != method)) continue;
    const double held = verb == "pairs" ? elements * elements : elements;
    const bool patched = row.patches && work.free_length > 0;
    const double each =
        row.seconds * std::pow(elements / unit, row.power) + row.cell_seconds * work.cells;
    const double faces = face_seconds * work.faces;
    const double patches =
        patch_start + patch_seconds * work.free_length + orient_seconds * work.open_faces;
    const double memory = elements > row.beyond.elements
                              ? row.beyond.fixed + row.beyond.bytes * elements
                              : row.bytes * held;
    return RunCost{start + faces + (patched ? beside_patches * each + patches : each),
                   program + memory + face_bytes * work.faces +
                       (row.cell_bytes + (patched ? patch_bytes : 0)) * work.cells};
  }
  return {};
}

}  // namespace littoral::cli
