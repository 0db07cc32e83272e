#pragma once
// (M + t L) x = b for small t without one big factorization: window by window, outward from b.

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/task.h"
#include "littoral/report.h"
#include "solve/direct/hermitian_rows.h"
#include "solve/direct/ordering.h"
#include "solve/heat/outward_march.h"
#include "solve/heat/scaled_field.h"

namespace littoral {

/// A matrix whose inverse decays exponentially along its graph; immutable.
template <class Scalar>
class HeatWindows {
 public:
  using Rows = HermitianRows<Scalar>;
  using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;

  /// M: blocks; must outlive this. order: of elimination, of the blocks.
  HeatWindows(std::shared_ptr<const Rows> A, const VecX& M, const Ordering& order);
  HeatWindows(std::shared_ptr<const Rows> A, const VecX&& M, const Ordering& order) = delete;

  /// Solves on the blocks up to some distance from the support of b, keeps all but the farthest,
  /// whose values lack what lies beyond, and goes on from the kept ones, scaled to 1. Time and
  /// memory grow like the number of unknowns. Each connected piece of b should have largest entry
  /// 1. Where neighbouring windows do not fit together to round-off, as heat decays otherwise than
  /// OutwardMarch says, they overlap by more; nothing if that does not help.
  std::optional<ScaledField<Scalar>> solve(const HeatSource<Scalar>& b,
                                           const std::vector<int>& piece, const Task& task,
                                           Report& report) const;

  /// The b, zero where nothing is prescribed, for which A x = b has x = values on the blocks where
  /// that is not zero: found next to these, as x decays away from them.
  Vector source_prescribing(const Vector& values, const Task& task) const;

  Ordering order() const;  // of elimination, of the blocks

 private:
  /// The connected parts of a region, each of which is a problem of its own, in the order of
  /// elimination. local: per block -1, which it is again afterwards.
  std::vector<std::vector<int>> parts(std::span<const int> blocks, std::vector<int>& local) const;
  std::optional<ScaledField<Scalar>> solve(const HeatSource<Scalar>& b, OutwardMarch<Scalar>& march,
                                           int overlap, const Task& task) const;
  double misfit(const ScaledField<Scalar>& field, const HeatSource<Scalar>& b,
                const Task& task) const;

  std::shared_ptr<const Rows> A_;
  int block_;
  const VecX& M_;
  std::vector<int> position_;  // blocks: place in the order of elimination
};

extern template class HeatWindows<double>;
extern template class HeatWindows<Complex>;

}  // namespace littoral
