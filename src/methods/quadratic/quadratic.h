#pragma once
// Quadratic-order geodesics (Ruan et al.): the squared distance as a piecewise quadratic function.

#include <memory>
#include <mutex>
#include <vector>

#include "base/option_table.h"
#include "base/report.h"
#include "base/task.h"
#include "operators/p2.h"
#include "solve/optimization/parabolic_program.h"
#include "sources/p2_sources.h"

namespace littoral {

struct QuadraticOptions {
  double tolerance = 1e-5;      // of the duality gap, relative to the integral of u
  double max_iterations = 100;  // of the interior-point method, for each component
  double source_radius = 1e-4;  // d at a source may be this many mean edge lengths
  double spacing = 0;           // of samples on curves, in mean edge lengths; 0: none, distances
  bool insert_samples = true;   // hold u >= |grad u|^2 / 4 between the seven points too
  bool is_signed = false;       // sign and zero set from the signed heat method
  double subdivide = 1;         // parts of each side in the mesh written for viewing
};

const OptionTable<QuadraticOptions>& quadratic_options();

/// The squared distance u and d = sqrt(u) anywhere.
template <int D>
struct QuadraticField {
  std::shared_ptr<const P2Elements<D>> elements;
  VecX u;  // nodes; squares of the input's length, +inf where no source reaches

  /// Distance at a point of an element [length], +inf where no source reaches.
  double distance(int element, const typename P2Shape<D>::Point& b) const;
  /// Distance at the vertices (vertices).
  VecX at_vertices() const;
};

/// One domain's elements and, once a source has been solved for, one symbolic factorization for
/// each component; `solve` may be called from several threads.
template <int D>
class Quadratic {
 public:
  explicit Quadratic(std::shared_ptr<const P2Elements<D>> elements);
  ~Quadratic();

  /// u = argmax of the integral of u, u >= |grad u|^2 / 4, u(b) = 0 at the sources (section 4),
  /// for each component by itself: +inf on those without a source. Reports gap, residual,
  /// iterations and samples; "not converged" with the best iterate where a solve stalls.
  QuadraticField<D> solve(const std::vector<P2Source<D>>& sources, const QuadraticOptions& options,
                          Task task, Report& report) const;

 private:
  struct Part;
  std::shared_ptr<const P2Elements<D>> elements_;
  std::vector<std::unique_ptr<Part>> parts_;  // components
};

extern template class Quadratic<2>;
extern template class Quadratic<3>;
extern template struct QuadraticField<2>;
extern template struct QuadraticField<3>;

}  // namespace littoral
