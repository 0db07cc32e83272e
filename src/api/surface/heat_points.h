#pragma once
// Distances from many single points by the heat methods, at once.

#include <functional>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "api/surface/heat_surface.h"
#include "methods/heat/heat_strips.h"

namespace littoral {

/// What both heat methods do for single points on operators that solves share; other sources get no
/// answer.
class FromPoints {
 public:
  using Answers = Solver<SurfaceDomain>::Answers;
  using StripsAt = std::function<std::shared_ptr<const HeatStrips>(
      const std::shared_ptr<const Operators>& ops, double scale)>;

  /// strips_at: null where there are none. The surface must outlive this.
  FromPoints(const HeatSurface& surface, HeatStrips::Values values, StripsAt strips_at)
      : surface_(surface), values_(values), strips_at_(std::move(strips_at)) {}

  /// The answers found with this time scale or, if it was not `given` and may rise, with longer
  /// ones, as by solve_raising; `scales` are those that were used. Throws Cancelled.
  Answers solve(std::span<const Sources> sources, double scale, bool given,
                std::span<double> scales, const Task& task, std::span<Report> reports) const;

 private:
  struct Point;
  std::vector<Point> placed(std::span<const Sources> sources, const Task& task,
                            std::span<Report> reports) const;
  bool diffuse(std::vector<Point>& points, double scale, bool rises, const Task& task) const;

  const HeatSurface& surface_;
  HeatStrips::Values values_;
  StripsAt strips_at_;
};

}  // namespace littoral
