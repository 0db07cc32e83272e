#pragma once
// (M + t L) x = b for strips of right-hand sides, right however fast x decays.

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/task.h"
#include "solve/direct/strip_solve.h"
#include "solve/heat/heat_system.h"

namespace littoral {

/// A strip of decaying solutions, each a ScaledField of its own.
struct ScaledStrip {
  Strip x;
  std::vector<std::int16_t> layer;  // strip_width for each row; empty: 0 wherever heat arrives
  std::array<std::vector<double>, strip_width> scale;  // layers
  std::array<int, strip_width> passes{};
  std::array<Eigen::Index, strip_width> missed{};  // unknowns that heat should reach and does not

  int layer_at(Eigen::Index row, int column) const {
    return layer.empty() ? 0 : layer[std::size_t(row * strip_width + column)];
  }
};

/// A HeatSystem of real unknowns for strips; immutable.
class StripHeat {
 public:
  /// system: one that has a factor. row_of: where the strips have each unknown. component: of the
  /// rows; -1: no heat belongs there.
  StripHeat(std::shared_ptr<const HeatSystem<double>> system, const std::vector<int>& row_of,
            std::vector<int> component, int n_components);

  /// field.x is b and becomes x, for each column as HeatSystem::solve finds it: by renormalised
  /// passes, each component of b scaled to largest entry 1. given: the rows of b that are not zero.
  /// first_layer: no more than that is wanted. Throws Cancelled.
  void solve(ScaledStrip& field, std::span<const int> given, bool first_layer, Strip& spare,
             const Task& task) const;

 private:
  void scale_components(ScaledStrip& field, std::span<const int> given,
                        std::vector<double>& unreached) const;
  void solve_in_passes(ScaledStrip& field, Strip& spare, const Task& task) const;

  std::shared_ptr<const HeatSystem<double>> system_;
  std::vector<int> row_of_, component_;
  std::vector<Eigen::Index> size_;  // components
  StripSolve solve_;
};

}  // namespace littoral
