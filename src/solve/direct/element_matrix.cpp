#include "solve/direct/element_matrix.h"

#include <algorithm>

namespace littoral {

template <int K>
ElementMatrix<K>::ElementMatrix(int n, std::vector<std::array<int, K>> elements, const Task& task)
    : n_(n), elements_(std::move(elements)) {
  std::vector<int> count(n + 1, 0);  // column -> entries, with repeats
  auto each = [&](auto&& visit) {
    for (const auto& e : elements_)
      for (int i = 0; i < K; ++i)
        for (int j = i; j < K; ++j) visit(std::max(e[i], e[j]), std::min(e[i], e[j]));
  };
  each([&](int, int column) { ++count[column + 1]; });
  for (int j = 0; j < n; ++j) count[j + 1] += count[j];
  std::vector<int> rows(count[n]), next(count.begin(), count.end() - 1);
  each([&](int row, int column) { rows[next[column]++] = row; });

  zero_.resize(n, n);
  std::vector<int> kept;
  kept.reserve(rows.size() / 2);
  int* start = zero_.outerIndexPtr();
  for (int j = 0; j < n; ++j) {
    start[j] = kept.size();
    std::sort(rows.begin() + count[j], rows.begin() + count[j + 1]);
    std::unique_copy(rows.begin() + count[j], rows.begin() + count[j + 1],
                     std::back_inserter(kept));
  }
  start[n] = kept.size();
  zero_.resizeNonZeros(kept.size());
  std::copy(kept.begin(), kept.end(), zero_.innerIndexPtr());
  zero_.coeffs().setZero();

  position_.resize(elements_.size());
  for (std::size_t f = 0; f < elements_.size(); ++f) {
    int at = 0;
    for (int i = 0; i < K; ++i)
      for (int j = i; j < K; ++j) {
        const int row = std::max(elements_[f][i], elements_[f][j]);
        const int column = std::min(elements_[f][i], elements_[f][j]);
        const int* first = zero_.innerIndexPtr() + start[column];
        const int* last = zero_.innerIndexPtr() + start[column + 1];
        position_[f][at++] = std::lower_bound(first, last, row) - zero_.innerIndexPtr();
      }
  }
  structure_ = std::make_shared<const Elimination>(zero_, dissection(zero_, task));
}

template <int K>
VecX ElementMatrix<K>::sum(const std::vector<Local>& local) const {
  VecX x = VecX::Zero(n_);
  for (std::size_t f = 0; f < elements_.size(); ++f)
    for (int i = 0; i < K; ++i) x[elements_[f][i]] += local[f][i];
  return x;
}

template <int K>
SpMat ElementMatrix<K>::sum(const std::vector<Block>& local) const {
  SpMat A = zero_;
  double* value = A.valuePtr();
  for (std::size_t f = 0; f < elements_.size(); ++f)
    for (int k = 0; k < entries; ++k) value[position_[f][k]] += local[f][k];
  return A;
}

template class ElementMatrix<6>;
template class ElementMatrix<10>;

}  // namespace littoral
