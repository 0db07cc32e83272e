#pragma once
// Rows of three numbers that are the same but for their order.

#include <vector>

#include "littoral/types.h"

namespace littoral {

/// Of some rows, ascending, those that hold the same three numbers, in any order, as an earlier one
/// of them.
struct RepeatedRow {
  int row, first;
};
std::vector<RepeatedRow> repeated_rows(const MatX3i& rows, const std::vector<int>& some);

}  // namespace littoral
