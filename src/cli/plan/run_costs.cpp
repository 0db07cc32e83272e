#include "cli/plan/run_costs.h"

#include <array>
#include <cmath>
#include <string_view>

namespace littoral::cli {

namespace {

constexpr double unit = 1e4;          // elements
constexpr double program = 25 << 20;  // bytes without any
constexpr double start = 0.02;        // seconds

/// seconds (elements / unit)^power of one processor, and bytes for each element.
struct Row {
  std::string_view verb, method;  // method empty: whichever it is
  double seconds, power, bytes;
};

// Printed by bench/studies/run_costs.py.
constexpr std::array rows = std::to_array<Row>({
    {"distance", "auto", 0.0922, 1.51, 909},
    {"distance", "signed-heat", 0.118, 1.23, 4668},
    {"distance", "unsigned-heat", 0.0846, 1.33, 3080},
    {"distance", "exact", 0.0841, 1.52, 273},
    {"distance", "fast-marching", 0.045, 1.0, 538},
    {"distance", "quadratic", 6.78, 1.48, 11605},
    {"distance", "regularized", 0.166, 1.24, 2126},
    {"distance", "belyaev-fayolle", 0.273, 1.16, 2126},
    {"winding", "", 0.0798, 1.42, 2497},
    {"pairs", "exact", 1.14e+03, 2.3, 7735},
    {"pairs", "signed-heat", 282, 2.42, 10579},
    {"pairs", "unsigned-heat", 257, 2.39, 10579},
    {"pairs", "regularized", 1.91e+03, 2.2, 8683},
    {"pairs", "fast-marching", 313, 2.26, 6786},
    {"sdf", "auto", 0.0179, 1.0, 0},
    {"sdf", "winding", 0.0186, 1.0, 0},
    {"sdf", "closest-point", 0.0183, 1.0, 0},
    {"sdf", "tori", 0.0258, 1.03, 27},
    {"sdf", "signed-heat", 0.0455, 1.01, 0},
});

}  // namespace

std::optional<RunCost> run_cost(const std::string& verb, const std::string& method,
                                double elements) {
  const std::string_view like = verb == "offset" ? "sdf" : std::string_view(verb);
  for (const Row& row : rows) {
    if (row.verb != like || (!row.method.empty() && row.method != method)) continue;
    return RunCost{start + row.seconds * std::pow(elements / unit, row.power),
                   program + row.bytes * elements};
  }
  return {};
}

}  // namespace littoral::cli
