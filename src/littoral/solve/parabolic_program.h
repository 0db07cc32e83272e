#pragma once
// Conic programs whose constraints are paraboloids over elements:
//
//   maximise c^T x   subject to   q_p^T x >= |G_p x|^2 / 4  for each sample p,
//                                 q_b^T x <= bound_b        for each cap b,
//
// each row touching only the unknowns of one element.

#include <functional>
#include <memory>
#include <vector>

#include "littoral/base/report.h"
#include "littoral/base/task.h"
#include "littoral/base/types.h"
#include "littoral/solve/element_matrix.h"

namespace littoral {

/// K unknowns per element, gradients of D components.
template <int K, int D>
struct ParabolicProgram {
  using Row = Eigen::Matrix<double, K, 1>;

  struct Sample {
    int element = 0;
    double tau = 1;  // size of x expected here, > 0; only conditioning depends on it
    Row q;
    std::array<Row, D> g;
  };
  struct Cap {
    int element = 0;
    double bound = 0;
    Row q;
  };

  VecX c;                       // unknowns
  std::vector<Sample> samples;  // ascending elements
  std::vector<Cap> caps;        // ascending elements
};

struct ParabolicOptions {
  double tolerance = 1e-6;  // of the duality gap, relative to the objective
  int max_iterations = 100;
};

struct ParabolicResult {
  VecX x;
  bool converged = false;
  int iterations = 0;
  double objective = 0;  // c^T x
  double gap = 0;        // (s^T z + |r^T x|) / objective, r the residual of the dual constraints
  double primal_residual = 0;  // largest violation of a constraint's equation, relative to tau
  std::size_t samples = 0;     // in the end, with those that were inserted
};

/// Mehrotra's predictor-corrector method with Nesterov-Todd scaling and Gondzio's correctors. One
/// symbolic factorization serves every program on the same elements; immutable, `solve` may be
/// called from several threads. Deterministic for any number of threads.
template <int K, int D>
class ParabolicSolver {
 public:
  using Program = ParabolicProgram<K, D>;
  /// Samples to insert (ascending elements) where x violates the constraints between samples.
  using Inserter = std::function<std::vector<typename Program::Sample>(const VecX& x)>;

  ParabolicSolver(int n, std::vector<std::array<int, K>> elements, const Task& task);

  /// Starts from x0 (need not be feasible), whose size is about that of the solution. Samples are
  /// inserted inside the run. Without convergence the result is the best iterate and says so.
  ParabolicResult solve(const Program& program, const VecX& x0, const ParabolicOptions& options,
                        const Inserter& insert, const Task& task) const;

  double nonzeros() const { return matrix_->nonzeros(); }

 private:
  std::shared_ptr<const ElementMatrix<K>> matrix_;
};

extern template class ParabolicSolver<6, 2>;
extern template class ParabolicSolver<10, 3>;

}  // namespace littoral
