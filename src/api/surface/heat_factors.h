#pragma once
// The factorizations of the heat methods on one discretization, made when first needed and kept:
// sources of another kind need another diffusion, and bad meshes a longer one.

#include <memory>
#include <tuple>

#include "base/lazy.h"
#include "methods/heat/heat_strips.h"
#include "methods/heat/signed_heat.h"
#include "methods/heat/unsigned_heat.h"

namespace littoral {

/// Of the signed heat method; may be used by several threads.
class SignedHeatFactors {
 public:
  SignedHeatFactors(std::shared_ptr<const Operators> ops, SolveHint hint)
      : ops_(std::move(ops)), hint_(hint) {}

  std::shared_ptr<const SignedHeatSolver> at(double scale, Diffusions needed, Task task) const {
    return solvers_.get({scale, needed.vectors, needed.scalars}, [&] {
      const auto poisson = poisson_.get([&] {
        return SignedHeatSolver(ops_, scale, task.stage(0.4, "factoring"), {false, false}, hint_);
      });
      return poisson->with(scale, needed, task.stage(0.6, "factoring"));
    });
  }
  /// For points by scalar heat; null where there is nothing to gain.
  std::shared_ptr<const HeatStrips> strips(double scale, const Task& task) const {
    const auto solver = at(scale, {.vectors = false, .scalars = true}, task);
    const auto parts = *parts_.get([&] { return solver->strip_parts(); });
    if (!parts) return nullptr;
    return strips_.get(scale, [&] { return solver->strips(parts); });
  }

 private:
  std::shared_ptr<const Operators> ops_;
  SolveHint hint_;
  Kept<SignedHeatSolver> poisson_;  // without any diffusion
  KeptByKey<std::tuple<double, bool, bool>, SignedHeatSolver> solvers_;
  Kept<std::shared_ptr<const StripParts>> parts_;
  KeptByKey<double, HeatStrips> strips_;
};

/// Of the unsigned one.
class UnsignedHeatFactors {
 public:
  UnsignedHeatFactors(std::shared_ptr<const Operators> ops, UnsignedHeat options, SolveHint hint)
      : ops_(std::move(ops)), options_(options), hint_(hint) {}

  std::shared_ptr<const UnsignedHeatSolver> first(const Task& task) const {
    return first_.get([&] { return UnsignedHeatSolver(ops_, options_, task, hint_); });
  }
  std::shared_ptr<const UnsignedHeatSolver> longer(double scale, const Task& task) const {
    return solvers_.get(scale, [&] { return first(task)->with_time_scale(scale, task); });
  }
  /// Null where there is nothing to gain.
  std::shared_ptr<const HeatStrips> strips(double scale, const Task& task) const {
    const auto parts = *parts_.get([&] { return first(task)->strip_parts(); });
    if (!parts) return nullptr;
    return strips_.get(scale, [&] {
      const auto solver = scale == options_.time_scale ? first(task) : longer(scale, task);
      return solver->strips(parts);
    });
  }

 private:
  std::shared_ptr<const Operators> ops_;
  UnsignedHeat options_;
  SolveHint hint_;
  Kept<UnsignedHeatSolver> first_;
  Kept<std::shared_ptr<const StripParts>> parts_;
  KeptByKey<double, HeatStrips> strips_;
  KeptByKey<double, UnsignedHeatSolver> solvers_;
};

}  // namespace littoral
