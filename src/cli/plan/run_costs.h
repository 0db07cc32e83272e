#pragma once
// What runs cost, roughly: measured constants.

#include <optional>
#include <string>

namespace littoral::cli {

struct RunCost {
  double seconds = 0;  // of one processor
  double bytes = 0;
};
/// Of a verb with a method on so many elements: vertices of a surface, nodes of a grid or points of
/// a query. None where nothing was measured.
std::optional<RunCost> run_cost(const std::string& verb, const std::string& method,
                                double elements);

}  // namespace littoral::cli
