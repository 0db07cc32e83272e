#pragma once
// Concave programs whose constraints are paraboloids over elements:
//
//   maximise c^T x   subject to   g_p(x) = q_p^T x - |T_e G_p x|^2 / 4 >= 0  for each sample p,
//                                 bound_b - q_b^T x >= 0                     for each cap b,
//
// each row touching only the unknowns of one element e. Solved by an interior-point method.

#include <functional>
#include <memory>
#include <vector>

#include "base/index.h"
#include "base/task.h"
#include "littoral/report.h"
#include "littoral/types.h"
#include "solve/direct/element_matrix.h"

namespace littoral {

/// K unknowns per element, gradients of D components.
template <int K, int D>
struct ParaboloidProgram {
  using Row = Eigen::Matrix<double, K, 1>;
  using Transform = Eigen::Matrix<double, D, D>;

  /// The rows of a sample on the reference element, shared by many elements.
  struct Point {
    Row q;
    std::array<Row, D> g;
  };
  struct Sample {
    int element = 0;
    int point = 0;   // of points
    double tau = 1;  // size of x expected here, > 0; only conditioning depends on it
  };
  struct Cap {
    int element = 0;
    double bound = 0;
    Row q;
  };
  /// A sample with a point of its own.
  struct Inserted {
    int element = 0;
    Point point;
    double tau = 1;
  };

  VecX c;                            // unknowns
  std::vector<Transform> transform;  // elements; from reference to actual gradients
  std::vector<double> weight;        // elements, > 0; share in the objective, of any scale
  std::vector<Point> points;
  std::vector<Sample> samples;  // ascending elements
  std::vector<Cap> caps;
};

struct ParaboloidOptions {
  double tolerance = 1e-6;  // of the duality gap, relative to the objective
  int max_iterations = 100;
};

struct ParaboloidResult {
  VecX x;
  bool converged = false;
  int iterations = 0;
  double objective = 0;  // c^T x
  // s^T z / objective: a bound of what is missing where both residuals are 0.
  double gap = infinity;
  double primal_residual = gap;  // largest |s - g(x)|, relative to tau
  double dual_residual = gap;    // |r^T x| / objective, r what the dual constraints lack
  std::size_t samples = 0;       // in the end, with those that were inserted
  std::size_t missing = 0;       // that would be inserted after the last round: not converged
};

/// Primal-dual interior-point method with Mehrotra's predictor and corrector. One symbolic
/// factorization serves every program on the same elements; immutable, `solve` may be called from
/// several threads. Deterministic for any number of threads.
template <int K, int D>
class ParaboloidSolver {
 public:
  using Program = ParaboloidProgram<K, D>;
  /// Samples to insert (ascending elements) where x violates the constraints between samples by
  /// more than a share of what is allowed.
  using Inserter =
      std::function<std::vector<typename Program::Inserted>(const VecX& x, double share)>;

  ParaboloidSolver(int n, std::vector<std::array<int, K>> elements, const Task& task);

  /// Starts from x0 (need not be feasible), whose size is about that of the solution. Samples are
  /// inserted inside the run. Without convergence the result is the best iterate and says so.
  ParaboloidResult solve(const Program& program, const VecX& x0, const ParaboloidOptions& options,
                         const Inserter& insert, const Task& task) const;

  double nonzeros() const { return matrix_->nonzeros(); }

 private:
  std::shared_ptr<const ElementMatrix<K>> matrix_;
};

extern template class ParaboloidSolver<6, 2>;
extern template class ParaboloidSolver<10, 3>;

}  // namespace littoral
