#include "solve/direct/dense_kernels.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <mutex>

#include "base/index.h"
#include "base/platform/shared_library.h"

#if LITTORAL_BLAS
extern "C" {
#define LITTORAL_BLAS_DECLARE(S, p, herk)                                                         \
  void p##gemm_(const char*, const char*, const int*, const int*, const int*, const S*, const S*, \
                const int*, const S*, const int*, const S*, S*, const int*);                      \
  void p##herk(const char*, const char*, const int*, const int*, const double*, const S*,         \
               const int*, const double*, S*, const int*);                                        \
  void p##trsm_(const char*, const char*, const char*, const char*, const int*, const int*,       \
                const S*, const S*, const int*, S*, const int*);                                  \
  void p##gemv_(const char*, const int*, const int*, const S*, const S*, const int*, const S*,    \
                const int*, const S*, S*, const int*);                                            \
  void p##trsv_(const char*, const char*, const char*, const int*, const S*, const int*, S*,      \
                const int*);
LITTORAL_BLAS_DECLARE(double, d, syrk_)
LITTORAL_BLAS_DECLARE(littoral::Complex, z, herk_)
#undef LITTORAL_BLAS_DECLARE
}
#endif

namespace littoral::dense {

namespace {

template <class Scalar>
using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
template <class Scalar>
using View = Eigen::Map<Matrix<Scalar>, 0, Eigen::OuterStride<>>;
template <class Scalar>
using ConstView = Eigen::Map<const Matrix<Scalar>, 0, Eigen::OuterStride<>>;

template <class Scalar>
View<Scalar> view(Scalar* A, int m, int n, int lda) {
  return {A, m, n, Eigen::OuterStride<>(lda)};
}
template <class Scalar>
ConstView<Scalar> view(const Scalar* A, int m, int n, int lda) {
  return {A, m, n, Eigen::OuterStride<>(lda)};
}

#if LITTORAL_BLAS
template <class Scalar>
struct Blas;
template <>
struct Blas<double> {
  static constexpr auto gemm = dgemm_;
  static constexpr auto herk = dsyrk_;
  static constexpr auto trsm = dtrsm_;
  static constexpr auto gemv = dgemv_;
  static constexpr auto trsv = dtrsv_;
};
template <>
struct Blas<Complex> {
  static constexpr auto gemm = zgemm_;
  static constexpr auto herk = zherk_;
  static constexpr auto trsm = ztrsm_;
  static constexpr auto gemv = zgemv_;
  static constexpr auto trsv = ztrsv_;
};
constexpr int step = 1;
/// Most supernodes are so small that calling BLAS costs more than the work.
bool small(int m, int n) { return m * n <= 1024; }
template <class Scalar>
constexpr Scalar one = Scalar(1);
template <class Scalar>
constexpr Scalar minus = Scalar(-1);
template <class Scalar>
constexpr Scalar zero = Scalar(0);

template <class Scalar>
using Column = Eigen::Map<Eigen::Matrix<Scalar, Eigen::Dynamic, 1>>;
template <class Scalar>
using ConstColumn = Eigen::Map<const Eigen::Matrix<Scalar, Eigen::Dynamic, 1>>;

template <class Scalar>
void forward_small(int n, const Scalar* L, int ldl, Scalar* x) {
  for (int j = 0; j < n; ++j, L += ldl) {
    x[j] /= std::real(L[j]);
    Column<Scalar>(x + j + 1, n - j - 1) -= x[j] * ConstColumn<Scalar>(L + j + 1, n - j - 1);
  }
}

template <class Scalar>
void backward_small(int n, const Scalar* L, int ldl, Scalar* x) {
  for (int j = n; j-- > 0;) {
    const Scalar* l = L + index(j) * ldl;
    x[j] -= ConstColumn<Scalar>(l + j + 1, n - j - 1).dot(Column<Scalar>(x + j + 1, n - j - 1));
    x[j] /= std::real(l[j]);
  }
}

template <class Scalar>
void times_small(int m, int n, const Scalar* A, int lda, const Scalar* x, Scalar* y) {
  Column<Scalar> out(y, m);
  out.setZero();
  for (int j = 0; j < n; ++j, A += lda) out += x[j] * ConstColumn<Scalar>(A, m);
}

template <class Scalar>
void subtract_adjoint_small(int m, int n, const Scalar* A, int lda, const Scalar* y, Scalar* x) {
  const ConstColumn<Scalar> in(y, m);
  for (int j = 0; j < n; ++j, A += lda) x[j] -= ConstColumn<Scalar>(A, m).dot(in);
}
#endif

}  // namespace

void use_one_thread() {
#if LITTORAL_BLAS
  static std::once_flag once;
  std::call_once(once, [] {
    using Setter = void (*)(int);
    if (void* symbol = loaded_symbol("openblas_set_num_threads"))
      reinterpret_cast<Setter>(symbol)(1);
  });
#endif
}

void end_blas_threads() {
  use_one_thread();  // first: it would start them again
#if LITTORAL_BLAS
  using Ending = int (*)();
  if (void* symbol = loaded_symbol("blas_thread_shutdown_")) reinterpret_cast<Ending>(symbol)();
#endif
}

double bytes_of_a_thread() {
  double bytes = 8 << 20;
#if LITTORAL_BLAS
  bytes += 136 << 20;
#endif
  return bytes;
}

template <class Scalar>
bool cholesky(int n, Scalar* A, int lda) {
  constexpr int panel = 48;
  for (int j = 0; j < n; j += panel) {
    const int w = std::min(panel, n - j);
    Scalar* D = A + j + index(j) * lda;
    auto block = view(D, w, w, lda);
    for (int k = 0; k < w; ++k) {
      const double pivot = std::real(block(k, k));
      if (!(pivot > 0) || !std::isfinite(pivot)) return false;
      block.col(k).tail(w - k) *= 1 / std::sqrt(pivot);
      for (int l = k + 1; l < w; ++l)
        block.col(l).tail(w - l) -= block.col(k).tail(w - l) * Eigen::numext::conj(block(l, k));
    }
    const int below = n - j - w;
    if (below == 0) break;
    solve_right(below, w, D, lda, D + w, lda);
    subtract_square(below, w, D + w, lda, D + w + index(w) * lda, lda);
  }
  return true;
}

template <class Scalar>
void solve_right(int m, int n, const Scalar* L, int ldl, Scalar* B, int ldb) {
  if (m == 0 || n == 0) return;
#if LITTORAL_BLAS
  use_one_thread();
  Blas<Scalar>::trsm("R", "L", "C", "N", &m, &n, &one<Scalar>, L, &ldl, B, &ldb);
#else
  view(L, n, n, ldl)
      .template triangularView<Eigen::Lower>()
      .adjoint()
      .template solveInPlace<Eigen::OnTheRight>(view(B, m, n, ldb));
#endif
}

template <class Scalar>
void subtract_square(int n, int k, const Scalar* A, int lda, Scalar* C, int ldc) {
  if (n == 0 || k == 0) return;
#if LITTORAL_BLAS
  use_one_thread();
  const double a = -1, b = 1;
  Blas<Scalar>::herk("L", "N", &n, &k, &a, A, &lda, &b, C, &ldc);
#else
  view(C, n, n, ldc).template selfadjointView<Eigen::Lower>().rankUpdate(view(A, n, k, lda), -1.0);
#endif
}

template <class Scalar>
void subtract_product(int m, int n, int k, const Scalar* A, int lda, const Scalar* B, int ldb,
                      Scalar* C, int ldc) {
  if (m == 0 || n == 0 || k == 0) return;
#if LITTORAL_BLAS
  use_one_thread();
  Blas<Scalar>::gemm("N", "C", &m, &n, &k, &minus<Scalar>, A, &lda, B, &ldb, &one<Scalar>, C, &ldc);
#else
  view(C, m, n, ldc).noalias() -= view(A, m, k, lda) * view(B, n, k, ldb).adjoint();
#endif
}

template <class Scalar>
void forward(int n, int k, const Scalar* L, int ldl, Scalar* x, int ldx) {
#if LITTORAL_BLAS
  use_one_thread();
  if (k == 1 && small(n, n))
    forward_small(n, L, ldl, x);
  else if (k == 1)
    Blas<Scalar>::trsv("L", "N", "N", &n, L, &ldl, x, &step);
  else
    Blas<Scalar>::trsm("L", "L", "N", "N", &n, &k, &one<Scalar>, L, &ldl, x, &ldx);
#else
  view(L, n, n, ldl).template triangularView<Eigen::Lower>().solveInPlace(view(x, n, k, ldx));
#endif
}

template <class Scalar>
void backward(int n, int k, const Scalar* L, int ldl, Scalar* x, int ldx) {
#if LITTORAL_BLAS
  use_one_thread();
  if (k == 1 && small(n, n))
    backward_small(n, L, ldl, x);
  else if (k == 1)
    Blas<Scalar>::trsv("L", "C", "N", &n, L, &ldl, x, &step);
  else
    Blas<Scalar>::trsm("L", "L", "C", "N", &n, &k, &one<Scalar>, L, &ldl, x, &ldx);
#else
  view(L, n, n, ldl)
      .template triangularView<Eigen::Lower>()
      .adjoint()
      .solveInPlace(view(x, n, k, ldx));
#endif
}

template <class Scalar>
void times(int m, int n, int k, const Scalar* A, int lda, const Scalar* x, int ldx, Scalar* y,
           int ldy) {
  if (m == 0) return;
#if LITTORAL_BLAS
  use_one_thread();
  if (k == 1 && small(m, n))
    times_small(m, n, A, lda, x, y);
  else if (k == 1)
    Blas<Scalar>::gemv("N", &m, &n, &one<Scalar>, A, &lda, x, &step, &zero<Scalar>, y, &step);
  else
    Blas<Scalar>::gemm("N", "N", &m, &k, &n, &one<Scalar>, A, &lda, x, &ldx, &zero<Scalar>, y,
                       &ldy);
#else
  view(y, m, k, ldy).noalias() = view(A, m, n, lda) * view(x, n, k, ldx);
#endif
}

template <class Scalar>
void subtract_adjoint(int m, int n, int k, const Scalar* A, int lda, const Scalar* y, int ldy,
                      Scalar* x, int ldx) {
  if (m == 0) return;
#if LITTORAL_BLAS
  use_one_thread();
  if (k == 1 && small(m, n))
    subtract_adjoint_small(m, n, A, lda, y, x);
  else if (k == 1)
    Blas<Scalar>::gemv("C", &m, &n, &minus<Scalar>, A, &lda, y, &step, &one<Scalar>, x, &step);
  else
    Blas<Scalar>::gemm("C", "N", &n, &k, &m, &minus<Scalar>, A, &lda, y, &ldy, &one<Scalar>, x,
                       &ldx);
#else
  view(x, n, k, ldx).noalias() -= view(A, m, n, lda).adjoint() * view(y, m, k, ldy);
#endif
}

#define LITTORAL_DENSE(S)                                                               \
  template bool cholesky(int, S*, int);                                                 \
  template void solve_right(int, int, const S*, int, S*, int);                          \
  template void subtract_square(int, int, const S*, int, S*, int);                      \
  template void subtract_product(int, int, int, const S*, int, const S*, int, S*, int); \
  template void forward(int, int, const S*, int, S*, int);                              \
  template void backward(int, int, const S*, int, S*, int);                             \
  template void times(int, int, int, const S*, int, const S*, int, S*, int);            \
  template void subtract_adjoint(int, int, int, const S*, int, const S*, int, S*, int);
LITTORAL_DENSE(double)
LITTORAL_DENSE(Complex)
#undef LITTORAL_DENSE

}  // namespace littoral::dense
