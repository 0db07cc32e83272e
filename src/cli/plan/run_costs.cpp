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
constexpr std::array rows = std::to_array<Row>({ @ROWS @ });

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
