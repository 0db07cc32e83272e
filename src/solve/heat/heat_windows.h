#pragma once
// (M + t L) x = b for small t without one big factorization: window by window, outward from b.

#include <algorithm>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/task.h"
#include "littoral/report.h"
#include "solve/direct/hermitian_rows.h"
#include "solve/direct/ordering.h"
#include "solve/heat/scaled_field.h"

namespace littoral {

/// sqrt(M / t): the extent of the place a mass stands for, in units of the length over which heat
/// decays in time t.
VecX decay_lengths(const VecX& M, double t);

/// Blocks by the decay lengths to them, rounded down, and in ascending order where these are equal.
struct Outward {
  std::vector<int> blocks;
  std::vector<std::size_t> begin{0};  // of those k lengths away; and one more

  std::size_t nearer_than(int lengths) const {
    return begin[std::min(std::size_t(lengths), begin.size() - 1)];
  }
};

/// A matrix whose inverse decays exponentially along its graph; immutable.
template <class Scalar>
class HeatWindows {
 public:
  using Rows = HermitianRows<Scalar>;
  using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;

  /// size: blocks; extent of a block in decay lengths, sqrt(M / t): what a step between two blocks
  /// is taken to be long. order: of elimination, of the blocks.
  HeatWindows(std::shared_ptr<const Rows> A, VecX size, const Ordering& order);

  /// Solves on the blocks up to some distance from the support of b, keeps all but the farthest,
  /// whose values lack what lies beyond, and goes on from the kept ones, scaled to 1. Time and
  /// memory grow like the number of unknowns. Each connected piece of b should have largest entry
  /// 1. Where neighbouring windows do not fit together to round-off, as `size` misjudges how heat
  /// decays, they overlap by more; nothing if that does not help.
  std::optional<ScaledField<Scalar>> solve(const HeatSource<Scalar>& b,
                                           const std::vector<int>& piece, const Task& task,
                                           Report& report) const;

  /// The b, zero where nothing is prescribed, for which A x = b has x = values on the blocks where
  /// that is not zero: found next to these, as x decays away from them.
  Vector source_prescribing(const Vector& values, const Task& task) const;

  Ordering order() const;  // of elimination, of the blocks

 private:
  std::vector<double> distances(const std::vector<int>& from, double limit, const Task& task) const;
  /// The connected parts of a region, which are solved one by one; each in the order of
  /// elimination.
  std::vector<std::vector<int>> parts(std::span<const int> blocks) const;
  std::optional<ScaledField<Scalar>> solve(const HeatSource<Scalar>& b, const Outward& outward,
                                           int overlap, const Task& task) const;
  double misfit(const ScaledField<Scalar>& field, const HeatSource<Scalar>& b,
                const Task& task) const;

  std::shared_ptr<const Rows> A_;
  int block_;
  VecX size_;
  std::vector<int> position_;  // blocks: place in the order of elimination
};

extern template class HeatWindows<double>;
extern template class HeatWindows<Complex>;

}  // namespace littoral
