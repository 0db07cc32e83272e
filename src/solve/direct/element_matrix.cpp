#include "solve/direct/element_matrix.h"

#include <algorithm>

#include "base/index.h"
#include "base/parallel.h"

namespace littoral {

namespace {

constexpr std::size_t grain = 1 << 12;  // of loops

}  // namespace

template <std::size_t M>
TermsByTarget::TermsByTarget(const std::vector<std::array<int, M>>& targets, std::size_t n)
    : begin_(n + 1, 0), from_(M * targets.size()) {
  for (const auto& target : targets)
    for (int t : target) ++begin_[t + 1];
  for (std::size_t i = 0; i < n; ++i) begin_[i + 1] += begin_[i];
  std::vector<int> at(begin_.begin(), begin_.end() - 1);
  int from = 0;
  for (const auto& target : targets)
    for (int t : target) from_[at[t]++] = from++;
}

void TermsByTarget::add_up(const double* value, double* out) const {
  parallel_for(begin_.size() - 1, grain, [&](std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i) {
      double sum = 0;
      for (int k = begin_[i]; k < begin_[i + 1]; ++k) sum += value[from_[k]];
      out[i] = sum;
    }
  });
}

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

  pattern_.resize(n, n);
  std::vector<int> kept;
  kept.reserve(rows.size() / 2);
  int* start = pattern_.outerIndexPtr();
  for (int j = 0; j < n; ++j) {
    start[j] = kept.size();
    std::sort(rows.begin() + count[j], rows.begin() + count[j + 1]);
    std::unique_copy(rows.begin() + count[j], rows.begin() + count[j + 1],
                     std::back_inserter(kept));
  }
  start[n] = kept.size();
  pattern_.resizeNonZeros(kept.size());
  std::copy(kept.begin(), kept.end(), pattern_.innerIndexPtr());
  pattern_.coeffs().setZero();

  std::vector<std::array<int, entries>> place(elements_.size());
  parallel_for(place.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      int at = 0;
      for (int i = 0; i < K; ++i)
        for (int j = i; j < K; ++j) {
          const int row = std::max(elements_[f][i], elements_[f][j]);
          const int column = std::min(elements_[f][i], elements_[f][j]);
          const int* first = pattern_.innerIndexPtr() + start[column];
          const int* last = pattern_.innerIndexPtr() + start[column + 1];
          place[f][at++] = std::lower_bound(first, last, row) - pattern_.innerIndexPtr();
        }
    }
  });
  of_vector_ = TermsByTarget(elements_, n);
  of_values_ = TermsByTarget(place, pattern_.nonZeros());
  structure_ = std::make_shared<const Elimination>(pattern_, dissection(pattern_, task));
}

template <int K>
VecX ElementMatrix<K>::sum(const std::vector<Local>& local) const {
  VecX x(n_);
  of_vector_.add_up(local.data()->data(), x.data());
  return x;
}

template <int K>
void ElementMatrix<K>::sum(const std::vector<Block>& local, double* values) const {
  of_values_.add_up(local.data()->data(), values);
}

template class ElementMatrix<6>;
template class ElementMatrix<10>;

}  // namespace littoral
