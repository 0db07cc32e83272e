#pragma once
// Steps I and II: one backward Euler step of vector diffusion, then directions at the cells.

#include <memory>
#include <vector>

#include "base/task.h"
#include "littoral/report.h"
#include "methods/heat/cell_field.h"
#include "operators/calculus.h"
#include "solve/heat/heat_system.h"

namespace littoral {

/// (M + t L) X = X0 (eq. 12); immutable.
class VectorHeat {
 public:
  /// nodes: the order of elimination of the nodes between which the dofs lie. A matrix that is too
  /// large to be factored is made for each solve and given up: it takes more memory than time.
  VectorHeat(const VectorDiffusion& V, double t, SolveHint hint,
             std::shared_ptr<const Ordering> nodes, const Task& task);

  /// Diffused vectors averaged to cells. Cells on pieces without a source are 0.
  CellField diffuse(const VectorDiffusion& V, VecX X0, const Task& task, Report& report) const;

  /// The same with X prescribed as `values` (2 dofs) wherever that is not zero.
  CellField diffuse_prescribed(const VectorDiffusion& V, const VecX& values, const Task& task,
                               Report& report) const;

  double nonzeros() const;

 private:
  struct System {  // one of the two
    std::shared_ptr<const HeatSystem<Complex>> complex;
    std::shared_ptr<const HeatSystem<double>> real;
  };
  System system(const VectorDiffusion& V, const Task& task) const;
  ScaledField<double> solve(const VectorDiffusion& V, VecX X0, const Task& task,
                            Report& report) const;

  double t_;
  SolveHint hint_;
  std::shared_ptr<const Ordering> nodes_;
  std::shared_ptr<const System> kept_;
};

}  // namespace littoral
