#pragma once
// Quadratic-order geodesics (Ruan et al.): the squared distance as a piecewise quadratic function.

#include <memory>
#include <mutex>
#include <vector>

#include "base/option_table.h"
#include "base/task.h"
#include "littoral/options.h"
#include "littoral/report.h"
#include "operators/p2.h"
#include "solve/optimization/paraboloid_program.h"
#include "sources/surface/p2_sources.h"

namespace littoral {

const OptionTable<Quadratic>& quadratic_options();
/// Those that there are through tets.
const OptionTable<TetQuadratic>& tet_quadratic_options();

/// The squared distance u and d = sqrt(u) anywhere.
template <int D>
struct QuadraticField {
  std::shared_ptr<const P2Elements<D>> elements;
  VecX u;     // nodes; squares of the component's unit, +inf where no source reaches
  VecX unit;  // components [length]

  /// Distance at a point of an element [length], +inf where no source reaches.
  double distance(int element, const typename P2Shape<D>::Point& b) const;
  /// Distance at the vertices (vertices).
  VecX at_vertices() const;
};

/// One domain's elements and, once a source has been solved for, one symbolic factorization for
/// each component; `solve` may be called from several threads.
template <int D>
class QuadraticSolver {
 public:
  explicit QuadraticSolver(std::shared_ptr<const P2Elements<D>> elements);
  ~QuadraticSolver();

  /// u = argmax of the integral of u, u >= |grad u|^2 / 4, u(b) = 0 at the sources (section 4),
  /// for each component by itself: +inf on those without a source. Reports gap, residuals and
  /// iterations, also of each component, and samples; "not converged" with the best iterate where
  /// a solve stalls.
  QuadraticField<D> solve(const std::vector<P2Source<D>>& sources, const Quadratic& options,
                          Task task, Report& report) const;

 private:
  struct Part;
  std::shared_ptr<const P2Elements<D>> elements_;
  std::vector<std::unique_ptr<Part>> parts_;  // components
};

extern template class QuadraticSolver<2>;
extern template class QuadraticSolver<3>;
extern template struct QuadraticField<2>;
extern template struct QuadraticField<3>;

}  // namespace littoral
