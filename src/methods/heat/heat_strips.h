#pragma once
// The heat method from many single points at once: sixteen of them share every pass through the
// factors and over the cells.

#include <array>
#include <memory>
#include <mutex>
#include <vector>

#include "base/task.h"
#include "methods/heat/scalar_heat.h"
#include "methods/heat/strip_cells.h"
#include "solve/heat/heat_strip.h"
#include "solve/poisson/poisson_strip.h"
#include "sources/systems/source_system.h"

namespace littoral {

/// What strips need of a domain, whatever the time of diffusion; immutable.
struct StripParts {
  std::shared_ptr<const Operators> ops;
  std::vector<int> row_of;     // nodes: rows of strips, in the order of elimination
  std::vector<int> component;  // rows
  StripCells cells;
  std::vector<int> cells_begin, cells_at;  // rows: the cells that they are corners of
  StripPoisson poisson;

  StripParts(std::shared_ptr<const Operators> operators, const ScalarHeat& heat,
             const Poisson& poisson);
};

/// Distance from one of the points, and what UnsignedHeatSolver and SignedHeatSolver report of it.
struct StripDistance {
  bool found = false;     // else it needs a solve of its own, and nothing below is of meaning
  VecX values;            // nodes [length of the input], +inf on components without the point
  double passes = 0;      // of heat
  double residual = 0;    // of the Poisson equation
  double misaligned = 0;  // misaligned_area_fraction
  double off_unit = 0;    // off_unit_area_fraction
};

/// Steps of both heat methods for sources that are single points whose directions come from scalar
/// heat; with the numbers of the solves one by one to rounding. Immutable to its users, who may be
/// several threads.
class HeatStrips {
 public:
  /// Null where heat or the Poisson equation is not solved by an exact factor.
  static std::shared_ptr<const StripParts> parts(std::shared_ptr<const Operators> ops,
                                                 const ScalarHeat& heat, const Poisson& poisson);

  HeatStrips(std::shared_ptr<const StripParts> parts, const ScalarHeat& heat);
  ~HeatStrips();

  /// Is it the system of a single point, from which distance is counted from 0?
  static bool takes(const SourceSystem& system);

  enum class Values { not_negative, any };

  /// A distance for each of up to strip_width systems, 0 at the point. It is not found where heat
  /// does not reach all of a component and where there are no directions. Throws Cancelled.
  std::vector<StripDistance> solve(const std::vector<const SourceSystem*>& systems, Values values,
                                   const Task& task) const;

  /// What one call of solve takes, its answers among it, for so many nodes [bytes].
  static double bytes(Eigen::Index nodes) { return 8.0 * 8 * strip_width * double(nodes); }

 private:
  struct Work;        // strips, kept for the next call
  struct NearPoints;  // what is known next to the points of a call

  std::unique_ptr<Work> taken_work() const;
  void diffuse(const std::vector<const SourceSystem*>& systems, Work& work, const Task& task) const;
  void find_near(const std::vector<const SourceSystem*>& systems, NearPoints& near,
                 Work& work) const;
  Vec2 direction(const ScaledStrip& u, int cell, int column) const;
  void add_flow(NearPoints& near, Work& work) const;
  void add_shares(const NearPoints& near, Work& work) const;
  void write_values(const std::vector<const SourceSystem*>& systems, Values kind,
                    const NearPoints& near, const Work& work,
                    std::vector<StripDistance>& out) const;

  std::shared_ptr<const StripParts> parts_;
  StripHeat neumann_;
  std::unique_ptr<const StripHeat> dirichlet_;  // null without boundary
  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<Work>> idle_;
};

}  // namespace littoral
