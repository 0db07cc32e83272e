#pragma once
// Arrays of Python as matrices, without copies, and matrices kept by an object as read-only arrays.

#include <littoral/types.h>
#include <nanobind/ndarray.h>

#include <iterator>
#include <vector>

namespace littoral::python {

namespace nb = nanobind;

// The package hands over contiguous arrays of these types.
using Points = Eigen::Map<const MatX3>;
using Corners = Eigen::Map<const Rows<int, Eigen::Dynamic>>;
using Integers = Eigen::Map<const VecXi>;
using Numbers = Eigen::Map<const VecX>;

/// A matrix that `owner` keeps, as an array n x columns that keeps the owner.
template <class T, int columns>
auto view(const Rows<T, columns>& matrix, nb::handle owner) {
  return nb::ndarray<nb::numpy, const T>(
      matrix.data(), {static_cast<std::size_t>(matrix.rows()), std::size_t{columns}}, owner);
}
inline auto view(const VecX& values, nb::handle owner) {
  return nb::ndarray<nb::numpy, const double>(values.data(),
                                              {static_cast<std::size_t>(values.size())}, owner);
}
inline auto view(const VecXi& values, nb::handle owner) {
  return nb::ndarray<nb::numpy, const int>(values.data(), {static_cast<std::size_t>(values.size())},
                                           owner);
}
inline auto view(const std::vector<int>& values, nb::handle owner) {
  return nb::ndarray<nb::numpy, const int>(values.data(), {values.size()}, owner);
}

}  // namespace littoral::python
