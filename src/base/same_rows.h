#pragma once
// Triples of numbers that are there more than once; none is negative.

#include <array>
#include <vector>

#include "littoral/types.h"

namespace littoral {

/// Places of the first of each key, ascending.
std::vector<int> first_of_each(const std::vector<std::array<int, 3>>& keys);

/// Of some rows, ascending, those that hold the same three numbers, in any order, as an earlier one
/// of them.
struct RepeatedRow {
  int row, first;
};
std::vector<RepeatedRow> repeated_rows(const Eigen::Ref<const MatX3i>& rows,
                                       const std::vector<int>& some);

}  // namespace littoral
