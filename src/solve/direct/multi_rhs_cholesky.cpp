#include "solve/direct/multi_rhs_cholesky.h"

#include <cmath>
#include <string>

#include "littoral/error.h"

namespace littoral {

namespace {

using Row = Eigen::Array<double, 1, strip_width, Eigen::RowMajor>;
using RowMap = Eigen::Map<Row>;

}  // namespace

MultiRhsCholesky::MultiRhsCholesky(const SpMat& lower, const Elimination& E) {
  const std::size_t n = E.n;
  begin_.assign(n + 1, 0);
  for (int s = 0; s < E.n_super; ++s)
    for (int k = E.first[s]; k < E.first[s + 1]; ++k) {
      for (int i = k + 1; i < E.first[s + 1]; ++i) row_.push_back(i);
      row_.insert(row_.end(), E.rows.begin() + E.rows_begin[s],
                  E.rows.begin() + E.rows_begin[s + 1]);
      begin_[k + 1] = row_.size();
    }
  value_.assign(row_.size(), 0);
  inverse_.assign(n, 0);
  // Left-looking: column k waits in `first_of` for the earlier columns whose next row is k.
  std::vector<double> column(n, 0);
  std::vector<int> first_of(n, -1), next_of(n, -1);
  std::vector<std::size_t> at(n, 0);
  const auto wait = [&](int j) {
    const std::size_t c = j;
    if (at[c] == begin_[c + 1]) return;
    const std::size_t row = row_[at[c]];
    next_of[c] = first_of[row];
    first_of[row] = j;
  };
  for (int k = 0; k < E.n; ++k) {
    const std::size_t c = k;
    const int s = E.super_of[c], columns = E.columns(s);
    for (int e = E.entry_begin[c]; e < E.entry_begin[c + 1]; ++e) {
      const int from = E.entry_from[e], place = E.entry_row[e];
      const int row =
          place < columns ? E.first[s] + place : E.rows[E.rows_begin[s] + place - columns];
      column[row] += lower.valuePtr()[from >= 0 ? from : ~from];
    }
    for (int j = first_of[c]; j >= 0;) {
      const std::size_t d = j;
      const int following = next_of[d];
      const double f = value_[at[d]];
      for (std::size_t e = at[d]; e < begin_[d + 1]; ++e) column[row_[e]] -= f * value_[e];
      ++at[d];
      wait(j);
      j = following;
    }
    if (!(column[c] > 0))
      throw SolveError("the matrix is not positive definite (near unknown " +
                       std::to_string(E.old_of[c]) + ")");
    inverse_[c] = 1 / std::sqrt(column[c]);
    column[c] = 0;
    for (std::size_t e = begin_[c]; e < begin_[c + 1]; ++e) {
      double& from = column[row_[e]];
      value_[e] = from * inverse_[c];
      from = 0;
    }
    at[c] = begin_[c];
    wait(k);
  }
  pivot_ = E.old_of;
  for (int& row : row_) row = E.old_of[row];
}

void MultiRhsCholesky::solve(Strip& x) const {
  double* const base = x.data();
  const auto row = [base](int i) { return RowMap(base + strip_width * i); };
  for (std::size_t k = 0; k < pivot_.size(); ++k) {
    const Row pivot = row(pivot_[k]) * inverse_[k];
    row(pivot_[k]) = pivot;
    for (std::size_t e = begin_[k]; e < begin_[k + 1]; ++e) row(row_[e]) -= value_[e] * pivot;
  }
  for (std::size_t k = pivot_.size(); k-- > 0;) {
    Row pivot = row(pivot_[k]);
    for (std::size_t e = begin_[k]; e < begin_[k + 1]; ++e) pivot -= value_[e] * row(row_[e]);
    row(pivot_[k]) = pivot * inverse_[k];
  }
}

}  // namespace littoral
