#pragma once
// Many functions or right-hand sides side by side, sixteen of them: every number of a matrix,
// factor or mesh is read once for all of them, and goes to vectors as wide as registers.

#include "littoral/types.h"

namespace littoral {

constexpr Eigen::Index strip_width = 16;

/// A strip of sixteen, row by row.
template <class Number>
using StripOf = Eigen::Matrix<Number, Eigen::Dynamic, strip_width, Eigen::RowMajor>;
using Strip = StripOf<double>;

}  // namespace littoral
