#pragma once
// Sparse Cholesky factorization of symmetric (Hermitian) positive definite matrices.

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "base/platform/large_pages.h"
#include "base/task.h"
#include "littoral/types.h"
#include "solve/direct/elimination.h"
#include "solve/direct/sparse_rows.h"

namespace littoral {

/// A factorization A = L L^* of a matrix given by its lower triangle: multifrontal, subtrees of the
/// elimination tree side by side, with the same bits for any number of threads. Immutable; copies
/// share the factor; `solve` may be called from several threads.
template <class Scalar>
class Cholesky {
 public:
  using Matrix = Eigen::SparseMatrix<Scalar>;
  using Dense = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;

  /// Factors, in the given order of elimination (empty: dissection(lower)). Throws SolveError if
  /// the matrix is not positive definite to working precision or memory runs out, Cancelled within
  /// 0.2 s of a request.
  Cholesky(const Matrix& lower, const Task& task, const Ordering& order = {});

  /// The same for a matrix with the pattern that `structure` was made from. A factor that is to be
  /// patched remembers what each supernode passed on, which takes about as much memory again.
  Cholesky(const Matrix& lower, std::shared_ptr<const Elimination> structure, const Task& task,
           bool to_be_patched = false);

  /// The factor of a matrix that differs in some rows and columns only (old numbers): refactors
  /// what depends on these and shares the rest. This factor must be one `to_be_patched`.
  Cholesky patched(const Matrix& lower, const std::vector<int>& changed, const Task& task) const;

  /// Solves A x = b for each column of b. Parts of the factor that only zeros of b would pass
  /// through are left out; so are those that only unwanted unknowns need (wanted: per unknown;
  /// empty: all), whose values are of no meaning.
  Dense solve(const Dense& b, const std::vector<char>& wanted = {}) const;

  /// The same where b has yet to be corrected at the unknowns `at`: in each round `correct` is
  /// given x there and returns what to add to b there. A round goes through what these depend on,
  /// twice; the rest of the factor is gone through once each way.
  using Correction = std::function<Dense(const Dense& x_at)>;
  Dense solve_corrected(const Dense& b, const std::vector<int>& at, int rounds,
                        const Correction& correct) const;

  double nonzeros() const { return static_cast<double>(structure_->values()); }  // of the factor
  const std::shared_ptr<const Elimination>& structure() const { return structure_; }
  /// Rows and columns of a supernode (height x columns), lower.
  const Scalar* block(int supernode) const { return supernodes_[supernode].block.get(); }

 private:
  struct Supernode {
    std::shared_ptr<Scalar[]> block;   // height x columns, lower
    std::shared_ptr<Scalar[]> update;  // below x below, lower: what is left of the front
  };

  void factor(const Matrix& lower, const std::vector<char>& stale, const Task& task);
  void factor_supernode(const Matrix& lower, int s, const Task& task);
  void mark_up(int supernode, std::vector<char>& marked) const;
  std::vector<char> in_order(const Dense& b, Dense& x) const;
  Dense out_of_order(const Dense& x) const;
  void forward(const std::vector<char>& active, Dense& x) const;
  void backward(const std::vector<char>& active, Dense& x) const;
  void forward(int task, const std::vector<char>& active, Dense& x,
               std::vector<Dense>& passed_on) const;
  void backward(int task, const std::vector<char>& active, Dense& x) const;

  std::shared_ptr<const Elimination> structure_;
  std::vector<Supernode> supernodes_;
  bool to_be_patched_ = false;
};

extern template class Cholesky<double>;
extern template class Cholesky<Complex>;

/// The factor of a matrix that is positive definite but for round-off, as thin triangles leave it,
/// and by what share its diagonal had to be raised for that: the smallest of 0, 1e-14, 1e-12, 1e-10
/// and 1e-8 that helps. Throws SolveError where none does, Cancelled.
template <class Scalar>
struct RaisedCholesky {
  Cholesky<Scalar> factor;
  double raised = 0;
};
template <class Scalar>
RaisedCholesky<Scalar> raised_cholesky(const Eigen::SparseMatrix<Scalar>& lower,
                                       const std::shared_ptr<const Elimination>& structure,
                                       const Task& task, bool to_be_patched = false);
extern template RaisedCholesky<double> raised_cholesky(const SpMat&,
                                                       const std::shared_ptr<const Elimination>&,
                                                       const Task&, bool);
extern template RaisedCholesky<Complex> raised_cholesky(const SpMatC&,
                                                        const std::shared_ptr<const Elimination>&,
                                                        const Task&, bool);

/// For matrices that are positive definite but for round-off, as in the last steps of an
/// interior-point method: the diagonal is raised, by as little as possible, where a pivot fails,
/// and solutions are refined with the matrix itself.
class RefinedCholesky {
 public:
  /// pattern: a lower triangle with all of the diagonal, that `structure` was made from.
  RefinedCholesky(const SpMat& pattern, std::shared_ptr<const Elimination> structure);

  /// The matrix's, in the order of the pattern's: to be written before each factorization.
  double* values() { return lower_.valuePtr(); }
  /// False if raising the diagonal by 1e-7 of itself does not help.
  bool factor(const Task& task);
  /// Refines until |rhs - A x| <= allowed, or as long as that helps, five times at most.
  VecX solve(const VecX& rhs, double allowed, const Task& task) const;

 private:
  SpMat lower_;
  SymmetricRows rows_;
  std::shared_ptr<const Elimination> structure_;
  KeepLargePages keep_pages_;  // each factor goes where the one before was
  std::optional<Cholesky<double>> factor_;
};

}  // namespace littoral
