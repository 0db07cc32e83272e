#pragma once
// Symmetric matrices assembled from element matrices, always with the same pattern.

#include <array>
#include <memory>
#include <vector>

#include "base/task.h"
#include "littoral/types.h"
#include "solve/direct/elimination.h"

namespace littoral {

/// Which of many values are added up to which sums, so that several threads can: each sum is added
/// up by one of them, in the order of the values.
class TermsByTarget {
 public:
  TermsByTarget() = default;
  /// n sums; the targets of each M values in a row.
  template <std::size_t M>
  TermsByTarget(const std::vector<std::array<int, M>>& targets, std::size_t n);

  void add_up(const double* values, double* sums) const;

 private:
  std::vector<int> begin_, from_;  // sum i: of the values from_[begin_[i]] .. from_[begin_[i + 1]]
};

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
  const SpMat& pattern() const { return pattern_; }                              // lower triangle
  const std::shared_ptr<const Elimination>& structure() const { return structure_; }

  Local gather(const VecX& x, int element) const {
    Local local;
    for (int i = 0; i < K; ++i) local[i] = x[elements_[element][i]];
    return local;
  }
  /// Sum of the elements' vectors.
  VecX sum(const std::vector<Local>& local) const;
  /// Sum of the elements' matrices: the pattern's values.
  void sum(const std::vector<Block>& local, double* values) const;

 private:
  int n_;
  std::vector<std::array<int, K>> elements_;
  SpMat pattern_;  // lower triangle
  TermsByTarget of_vector_, of_values_;
  std::shared_ptr<const Elimination> structure_;
};

extern template class ElementMatrix<6>;
extern template class ElementMatrix<10>;

}  // namespace littoral
