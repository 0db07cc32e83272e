#include "solve/direct/strip_solve.h"

#include <utility>

#include "base/index.h"
#include "base/now_and_then.h"
#include "base/platform/floating_point.h"

namespace littoral {

StripSolve::StripSolve(Cholesky<double> factor, const std::vector<int>& row_of)
    : factor_(std::move(factor)) {
  const std::vector<int>& new_of = factor_.structure()->new_of;
  if (new_of == row_of) return;
  place_.resize(row_of.size());
  for (std::size_t i = 0; i < row_of.size(); ++i) place_[row_of[i]] = new_of[i];
}

void StripSolve::operator()(Strip& x, std::span<const int> given, Strip& spare,
                            const Task& task) const {
  if (place_.empty()) return eliminate(x, given, task);
  spare.resize(x.rows(), strip_width);
  for (std::size_t i = 0; i < place_.size(); ++i) spare.row(place_[i]) = x.row(index(i));
  std::vector<int> there(given.begin(), given.end());
  for (int& i : there) i = place_[i];
  eliminate(spare, there, task);
  for (std::size_t i = 0; i < place_.size(); ++i) x.row(index(i)) = spare.row(place_[i]);
}

void StripSolve::eliminate(Strip& x, std::span<const int> given, const Task& task) const {
  const FlushSubnormals flush;
  const Elimination& E = *factor_.structure();
  // What is not zero flows up the tree from where x is not.
  std::vector<char> reached(E.n_super, given.empty());
  for (const int i : given)
    for (int s = E.super_of[i]; s >= 0 && !reached[s]; s = E.parent[s]) reached[s] = 1;
  double* const strip = x.data();
  const auto own = [&](int s) { return strip + strip_width * E.first[s]; };
  const auto rows = [&](int s) { return E.rows.data() + E.rows_begin[s]; };
  for (int s = 0; s < E.n_super; ++s) {
    if (!reached[s]) continue;
    stop_if_cancelled(task);
    dense::forward_strip(E.columns(s), E.height(s), factor_.block(s), own(s), strip, rows(s));
  }
  for (int s = E.n_super; s-- > 0;) {
    stop_if_cancelled(task);
    dense::backward_strip(E.columns(s), E.height(s), factor_.block(s), own(s), strip, rows(s));
  }
}

}  // namespace littoral
