#include "cli/plan/run_costs.h"

#include <array>
#include <cmath>
#include <string_view>

namespace littoral::cli {

namespace {

constexpr double unit = 1e4;          // elements
constexpr double program = 13 << 20;  // bytes without any
constexpr double start = 0.007;       // seconds

/// seconds (elements / unit)^power of one processor, and bytes for each element, of pairs for each
/// pair.
struct Row {
  std::string_view verb, method;  // method empty: whichever it is
  double seconds, power, bytes;
};

// Of two runs each by bench/studies/run_costs.py.
constexpr std::array rows = std::to_array<Row>({
    {"distance", "auto", 0.0562, 1.09, 1.32e+03},
    {"distance", "signed-heat", 0.109, 1.07, 6.09e+03},
    {"distance", "unsigned-heat", 0.0885, 1.03, 4.4e+03},
    {"distance", "exact", 0.0497, 1.11, 794},
    {"distance", "fast-marching", 0.0207, 1.01, 1.16e+03},
    {"distance", "quadratic", 4.63, 1.52, 1.22e+04},
    {"distance", "regularized", 0.134, 1.15, 2.7e+03},
    {"distance", "belyaev-fayolle", 0.192, 1.22, 2.7e+03},
    {"winding", "", 0.0654, 1.05, 3.12e+03},
    {"pairs", "exact", 456, 2.19, 16.3},
    {"pairs", "signed-heat", 111, 2.31, 18.9},
    {"pairs", "unsigned-heat", 101, 2.28, 18.9},
    {"pairs", "regularized", 962, 2.15, 18},
    {"pairs", "fast-marching", 211, 2.34, 15.4},
    {"sdf", "auto", 0.0034, 1.00, 16.6},
    {"sdf", "winding", 0.00374, 1.00, 18.1},
    {"sdf", "closest-point", 0.0035, 1.00, 16.6},
    {"sdf", "tori", 0.0213, 1.00, 65.2},
    {"sdf", "signed-heat", 0.0186, 1.00, 39.1},
    {"query", "auto", 0.0209, 1.00, 424},
    {"query", "winding", 0.0208, 1.00, 477},
    {"query", "closest-point", 0.0187, 1.00, 424},
    {"query", "tori", 0.11, 1.00, 2.28e+03},
    {"query", "hopf-cole", 0.637, 1.00, 794},
    {"query", "planar", 0.343, 1.00, 794},
    {"query", "log-sum-exp", 0.317, 1.00, 1.8e+03},
    {"repair", "", 0.011, 1.00, 46.2},
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
