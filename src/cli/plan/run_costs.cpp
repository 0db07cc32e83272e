#include "cli/plan/run_costs.h"

#include <array>
#include <cmath>
#include <string_view>

namespace littoral::cli {

namespace {

constexpr double unit = 1e4;          // elements
constexpr double program = 15 << 20;  // bytes without any
constexpr double start = 0.02;        // seconds

/// seconds (elements / unit)^power of one processor, and bytes for each element, of pairs for each
/// pair.
struct Row {
  std::string_view verb, method;  // method empty: whichever it is
  double seconds, power, bytes;
};

// Of two runs each by bench/studies/run_costs.py.
constexpr std::array rows = std::to_array<Row>({
    {"distance", "auto", 0.0922, 1.51, 1378},
    {"distance", "signed-heat", 0.118, 1.23, 5137},
    {"distance", "unsigned-heat", 0.0846, 1.33, 3549},
    {"distance", "exact", 0.0841, 1.52, 742},
    {"distance", "fast-marching", 0.045, 1.0, 1007},
    {"distance", "quadratic", 6.78, 1.48, 12074},
    {"distance", "regularized", 0.166, 1.24, 2595},
    {"distance", "belyaev-fayolle", 0.273, 1.16, 2595},
    {"winding", "", 0.0798, 1.42, 2966},
    {"pairs", "exact", 1.14e+03, 2.3, 14.6},
    {"pairs", "signed-heat", 282, 2.42, 17.2},
    {"pairs", "unsigned-heat", 257, 2.39, 17.2},
    {"pairs", "regularized", 1.91e+03, 2.2, 15.4},
    {"pairs", "fast-marching", 313, 2.26, 13.7},
    {"sdf", "auto", 0.0168, 1.00, 14},
    {"sdf", "winding", 0.0172, 1.00, 23},
    {"sdf", "closest-point", 0.0169, 1.00, 21},
    {"sdf", "tori", 0.0265, 1.03, 56},
    {"sdf", "signed-heat", 0.0448, 1.00, 33},
    {"query", "auto", 0.0297, 1.00, 318},
    {"query", "winding", 0.0291, 1.00, 318},
    {"query", "closest-point", 0.0265, 1.00, 318},
    {"query", "tori", 0.166, 1.00, 2118},
    {"query", "hopf-cole", 0.983, 1.00, 635},
    {"query", "planar", 0.495, 1.00, 688},
    {"query", "log-sum-exp", 0.515, 1.00, 1642},
    {"repair", "", 0.0312, 1.00, 69},
});

}  // namespace

std::optional<RunCost> run_cost(const std::string& verb, const std::string& method,
                                double elements) {
  for (const Row& row : rows) {
    if (row.verb != verb || (!row.method.empty() && row.method != method)) continue;
    const double held = verb == "pairs" ? elements * elements : elements;
    return RunCost{start + row.seconds * std::pow(elements / unit, row.power),
                   program + row.bytes * held};
  }
  return {};
}

}  // namespace littoral::cli
