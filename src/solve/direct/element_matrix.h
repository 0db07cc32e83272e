#pragma once
// Symmetric matrices assembled from element matrices, always with the same pattern.

#include <array>
#include <memory>
#include <vector>

#include "base/task.h"
#include "littoral/types.h"
#include "solve/direct/elimination.h"

namespace littoral {

/// Elements of K unknowns, the pattern of the matrices they add up to, and its analysis; immutable.
template <int K>
class ElementMatrix {
 public:
  using Local = Eigen::Matrix<double, K, 1>;
  static constexpr int entries = K * (K + 1) / 2;         // of an element's upper triangle, by rows
  using Block = Eigen::Matrix<double, K*(K + 1) / 2, 1>;  // in that order

  /// Every unknown must be in an element.
  ElementMatrix(int n, std::vector<std::array<int, K>> elements, const Task& task);

  int n() const { return n_; }
  int n_elements() const { return elements_.size(); }
  double nonzeros() const { return static_cast<double>(structure_->values()); }  // of a factor
  const std::shared_ptr<const Elimination>& structure() const { return structure_; }

  Local gather(const VecX& x, int element) const {
    Local local;
    for (int i = 0; i < K; ++i) local[i] = x[elements_[element][i]];
    return local;
  }
  /// Sum of the elements' vectors.
  VecX sum(const std::vector<Local>& local) const;
  /// Sum of the elements' matrices; lower triangle.
  SpMat sum(const std::vector<Block>& local) const;

 private:
  int n_;
  std::vector<std::array<int, K>> elements_;
  SpMat zero_;                                      // lower triangle
  std::vector<std::array<int, entries>> position_;  // in zero_'s values
  std::shared_ptr<const Elimination> structure_;
};

extern template class ElementMatrix<6>;
extern template class ElementMatrix<10>;

}  // namespace littoral
