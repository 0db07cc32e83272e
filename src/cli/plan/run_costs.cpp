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
    {"distance", "auto", 0.171, 1.00, 1.43e+03},
    {"distance", "signed-heat", 0.188, 1.03, 5.98e+03},
    {"distance", "unsigned-heat", 0.153, 1.00, 4.29e+03},
    {"distance", "exact", 0.138, 1.19, 741},
    {"distance", "fast-marching", 0.0444, 1.23, 1.06e+03},
    {"distance", "quadratic", 6.73, 1.46, 1.21e+04},
    {"distance", "regularized", 0.221, 1.00, 2.59e+03},
    {"distance", "belyaev-fayolle", 0.299, 1.00, 2.59e+03},
    {"winding", "", 0.133, 1.04, 3.02e+03},
    {"pairs", "exact", 551, 2.03, 14.6},
    {"pairs", "signed-heat", 256, 2.44, 17.1},
    {"pairs", "unsigned-heat", 95.1, 2.01, 17.1},
    {"pairs", "regularized", 1.37e+03, 2.09, 16.3},
    {"pairs", "fast-marching", 128, 1.85, 13.7},
    {"sdf", "auto", 0.00611, 1.00, 13},
    {"sdf", "winding", 0.0061, 1.00, 14.2},
    {"sdf", "closest-point", 0.0062, 1.00, 13},
    {"sdf", "tori", 0.0296, 1.00, 54.5},
    {"sdf", "signed-heat", 0.0439, 1.00, 35.6},
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
