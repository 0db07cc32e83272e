#include "methods/heat/heat_matrix.h"

#include <utility>
#include <vector>

namespace littoral {

template <class Scalar>
std::shared_ptr<const Eigen::SparseMatrix<Scalar>> heat_matrix(
    const std::function<Eigen::SparseMatrix<Scalar>(const Task&)>& L, const VecX& M, double t,
    const Task& task) {
  const std::shared_ptr<Eigen::SparseMatrix<Scalar>> made(new Eigen::SparseMatrix<Scalar>(L(task)));
  Eigen::SparseMatrix<Scalar>& A = *made;
  const Eigen::Index block = A.rows() / M.size();
  A.makeCompressed();
  A.coeffs() *= t;
  std::vector<int> missing;
  for (Eigen::Index i = 0; i < A.cols(); ++i) {
    const int first = A.outerIndexPtr()[i];  // the diagonal, in a lower triangle, if there is one
    if (first < A.outerIndexPtr()[i + 1] && A.innerIndexPtr()[first] == i)
      A.valuePtr()[first] += M[i / block] > 0 ? M[i / block] : 1.0;
    else
      missing.push_back(i);
  }
  for (int i : missing) A.coeffRef(i, i) = M[i / block] > 0 ? M[i / block] : 1.0;
  A.makeCompressed();
  return made;
}

namespace {

class HeatRows : public HermitianRows<Complex> {
 public:
  HeatRows(std::shared_ptr<const HermitianRows<Complex>> L, const VecX& M, double t)
      : L_(std::move(L)), M_(M), t_(t) {}

  int size() const override { return L_->size(); }
  void neighbours(int i, std::vector<int>& out) const override { L_->neighbours(i, out); }
  void row(int i, BlockRow<Complex>& out) const override {
    L_->row(i, out);
    for (Complex& z : out.values) z *= t_;
    out.values[0] += M_[i] > 0 ? M_[i] : 1.0;
  }
  void fetch(int i) const override { L_->fetch(i); }
  void couplings(int i, std::vector<Coupled>& out) const override {
    L_->couplings(i, out);
    for (Coupled& other : out) other.w *= t_;
  }

 private:
  std::shared_ptr<const HermitianRows<Complex>> L_;
  const VecX& M_;
  double t_;
};

}  // namespace

std::shared_ptr<const HermitianRows<Complex>> heat_rows(
    std::shared_ptr<const HermitianRows<Complex>> L, const VecX& M, double t) {
  return std::make_shared<const HeatRows>(std::move(L), M, t);
}

template std::shared_ptr<const SpMat> heat_matrix(const std::function<SpMat(const Task&)>&,
                                                  const VecX&, double, const Task&);
template std::shared_ptr<const SpMatC> heat_matrix(const std::function<SpMatC(const Task&)>&,
                                                   const VecX&, double, const Task&);

}  // namespace littoral
