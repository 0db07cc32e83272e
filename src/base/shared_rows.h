#pragma once
// Rows of numbers that several objects hold in one place.

#include <memory>
#include <utility>

#include "littoral/types.h"

namespace littoral {

/// n x cols numbers, row by row; copies are the same ones.
template <class T, int cols>
class SharedRows {
 public:
  SharedRows() = default;
  explicit SharedRows(Rows<T, cols> own) : n_(own.rows()) {
    const auto kept = std::make_shared<const Rows<T, cols>>(std::move(own));
    first_ = {kept, kept->data()};
  }
  /// first: where they begin, and what keeps them.
  SharedRows(std::shared_ptr<const T> first, Eigen::Index n) : first_(std::move(first)), n_(n) {}

  Eigen::Index rows() const { return n_; }
  T operator()(Eigen::Index i, int k) const { return first_.get()[cols * i + k]; }
  auto row(Eigen::Index i) const { return matrix().row(i); }
  Eigen::Map<const Rows<T, cols>> matrix() const { return {first_.get(), n_, cols}; }

 private:
  std::shared_ptr<const T> first_;
  Eigen::Index n_ = 0;
};

}  // namespace littoral
