#include "solve/direct/hermitian_rows.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <utility>

#include "base/groups.h"
#include "base/now_and_then.h"

namespace littoral {

namespace {

template <class Scalar>
class RowsOfLower : public HermitianRows<Scalar> {
 public:
  using Matrix = Eigen::SparseMatrix<Scalar>;

  RowsOfLower(std::shared_ptr<const Matrix> lower, int block)
      : A_(std::move(lower)), block_(block) {}

  int size() const override { return static_cast<int>(A_->cols()) / block_; }
  int block() const override { return block_; }

  void neighbours(int i, std::vector<int>& out) const override {
    const auto others = beside().at(i);
    out.assign(others.begin(), others.end());
  }

  void row(int i, BlockRow<Scalar>& out) const override {
    out.blocks.assign(1, i);
    const auto others = beside().at(i);
    out.blocks.insert(out.blocks.end(), others.begin(), others.end());
    out.values.clear();
    for (const int j : out.blocks)
      for (int r = i * block_; r < (i + 1) * block_; ++r)
        for (int c = j * block_; c < (j + 1) * block_; ++c)
          out.values.push_back(r >= c ? at(r, c) : Eigen::numext::conj(at(c, r)));
  }

 private:
  Scalar at(int row, int column) const {
    const int* end = A_->innerIndexPtr() + A_->outerIndexPtr()[column + 1];
    const int* found =
        std::lower_bound(A_->innerIndexPtr() + A_->outerIndexPtr()[column], end, row);
    return found != end && *found == row ? A_->valuePtr()[found - A_->innerIndexPtr()] : Scalar(0);
  }

  /// Made by who first asks for a row: where there is a factor nobody does.
  const Groups<int>& beside() const {
    std::call_once(made_, [&] {
      beside_ = groups_of<int>(std::size_t(size()), [&](const auto& put) {
        for (int j = 0; j < A_->cols(); j += block_)  // a block's first column names all of them
          for (typename Matrix::InnerIterator it(*A_, j); it; ++it) {
            const int row = it.row() / block_, column = j / block_;
            if (it.row() % block_ != 0 || row == column) continue;
            put(row, column);
            put(column, row);
          }
      });
    });
    return beside_;
  }

  const std::shared_ptr<const Matrix> A_;
  const int block_;
  mutable std::once_flag made_;
  mutable Groups<int> beside_;
};

}  // namespace

template <class Scalar>
void HermitianRows<Scalar>::couplings(int i, std::vector<Coupled>& out) const {
  BlockRow<Scalar> own;
  row(i, own);
  const std::size_t of_block = std::size_t(block()) * block();
  out.clear();
  for (std::size_t s = 1; s < own.blocks.size(); ++s) {
    double squares = 0;
    for (std::size_t k = s * of_block; k < (s + 1) * of_block; ++k)
      squares += Eigen::numext::abs2(own.values[k]);
    out.push_back({own.blocks[s], std::sqrt(squares / block())});
  }
}

template <class Scalar>
std::shared_ptr<const HermitianRows<Scalar>> rows_of(
    std::shared_ptr<const Eigen::SparseMatrix<Scalar>> lower, int block) {
  return std::make_shared<const RowsOfLower<Scalar>>(std::move(lower), block);
}

template <class Scalar>
Eigen::SparseMatrix<Scalar> lower_triangle(const HermitianRows<Scalar>& A, const Task& task) {
  const int block = A.block();
  std::vector<Eigen::Triplet<Scalar>> entries;
  BlockRow<Scalar> row;
  for (int i = 0; i < A.size(); ++i) {
    stop_now_and_then(i, task);
    A.row(i, row);
    const Scalar* value = row.values.data();
    for (const int j : row.blocks)
      for (int r = i * block; r < (i + 1) * block; ++r)
        for (int c = j * block; c < (j + 1) * block; ++c, ++value)
          if (r >= c) entries.emplace_back(r, c, *value);
  }
  const Eigen::Index n = Eigen::Index{A.size()} * block;
  Eigen::SparseMatrix<Scalar> lower(n, n);
  lower.setFromTriplets(entries.begin(), entries.end());
  return lower;
}

template class HermitianRows<double>;
template class HermitianRows<Complex>;
template std::shared_ptr<const HermitianRows<double>> rows_of(std::shared_ptr<const SpMat>, int);
template std::shared_ptr<const HermitianRows<Complex>> rows_of(std::shared_ptr<const SpMatC>, int);
template SpMat lower_triangle(const HermitianRows<double>&, const Task&);
template SpMatC lower_triangle(const HermitianRows<Complex>&, const Task&);

}  // namespace littoral
