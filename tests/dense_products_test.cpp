// Products of dense blocks and solves with triangles against Eigen's, with every set of
// instructions that this processor has.

#include "solve/direct/dense_products.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <string>

#include "solve/direct/supernode_kernels.h"

namespace littoral::dense {
namespace {

template <class Scalar>
using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;

template <class Scalar>
class DenseProducts : public testing::Test {};
using Scalars = testing::Types<double, Complex>;
TYPED_TEST_SUITE(DenseProducts, Scalars);

struct Size {
  int m, n, k;
};
constexpr Size sizes[] = {{1, 1, 1},      {3, 2, 5},     {16, 12, 7},   {17, 13, 24},
                          {64, 100, 1},   {200, 31, 60}, {97, 97, 300}, {5, 1100, 3},
                          {400, 7, 8},    {33, 65, 530}, {1, 40, 9},    {193, 193, 65},
                          {300, 300, 193}};
constexpr Instructions all_instructions[] = {Instructions::plain, Instructions::avx2,
                                             Instructions::any};

template <class Scalar>
Operand<Scalar> whole(const Matrix<Scalar>& A) {
  return {A.data(), 1, A.rows()};
}
template <class Scalar>
Operand<Scalar> adjoint(const Matrix<Scalar>& A) {
  return {A.data(), A.rows(), 1, true};
}

TYPED_TEST(DenseProducts, AreEigensForBlocksAndAdjoints) {
  using Dense = Matrix<TypeParam>;
  for (const auto& [m, n, k] : sizes) {
    SCOPED_TRACE(std::to_string(m) + " x " + std::to_string(n) + ", " + std::to_string(k));
    const Dense A = Dense::Random(m, k), B = Dense::Random(k, n), C = Dense::Random(m + 3, n);
    const Dense A_adjoint = A.adjoint(), B_adjoint = B.adjoint();
    Dense expected = C;
    expected.topRows(m) -= A * B;
    for (const bool turned : {false, true})
      for (const Instructions allowed : all_instructions) {
        Dense got = C;
        subtract_product<TypeParam>(m, n, k,
                                    turned ? adjoint<TypeParam>(A_adjoint) : whole<TypeParam>(A),
                                    turned ? adjoint<TypeParam>(B_adjoint) : whole<TypeParam>(B),
                                    got.data(), m + 3, {.allowed = allowed});
        EXPECT_LE((got - expected).cwiseAbs().maxCoeff(), 1e-14 * (k + 10));
        EXPECT_EQ(got.bottomRows(3), C.bottomRows(3));  // what lies between columns
      }
  }
}

TYPED_TEST(DenseProducts, LowerPartIsAllThatIsTouchedAndMayStartFromZero) {
  using Dense = Matrix<TypeParam>;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const auto& [n, extra, k] : sizes) {
    const int m = n + extra;
    SCOPED_TRACE(std::to_string(m) + " x " + std::to_string(n) + ", " + std::to_string(k));
    const Dense A = Dense::Random(m, k), C = Dense::Random(m, n);
    const Dense product = A * A.topRows(n).adjoint();
    for (const bool from_zero : {false, true})
      for (const Instructions allowed : all_instructions) {
        Dense got = from_zero ? Dense::Constant(m, n, TypeParam(nan)) : C;
        const Dense before = got;
        subtract_product<TypeParam>(m, n, k, whole<TypeParam>(A), adjoint<TypeParam>(A), got.data(),
                                    m, {.lower = true, .from_zero = from_zero, .allowed = allowed});
        double worst = 0, imaginary = 0;
        bool above_kept = true;
        for (int j = 0; j < n; ++j) {
          imaginary = std::max(imaginary, std::abs(std::imag(got(j, j))));
          for (int i = 0; i < m; ++i) {
            const TypeParam start = from_zero ? TypeParam(0) : C(i, j);
            TypeParam expected = start - product(i, j);
            if (i == j) expected = std::real(expected);
            if (i >= j)
              worst = std::max(worst, std::abs(got(i, j) - expected));
            else
              above_kept &= std::isnan(std::real(before(i, j))) ? std::isnan(std::real(got(i, j)))
                                                                : got(i, j) == before(i, j);
          }
        }
        EXPECT_LE(worst, 1e-14 * (k + 10));
        EXPECT_EQ(imaginary, 0);
        EXPECT_TRUE(above_kept);
      }
  }
}

TYPED_TEST(DenseProducts, FromZeroWithNothingToMultiplyIsZero) {
  using Dense = Matrix<TypeParam>;
  Dense C = Dense::Random(20, 9);
  const Dense A(20, 0), B(0, 9);
  subtract_product<TypeParam>(20, 9, 0, {A.data(), 1, 20}, {B.data(), 1, 1}, C.data(), 20,
                              {.from_zero = true});
  EXPECT_EQ(C, Dense::Zero(20, 9));
}

TYPED_TEST(DenseProducts, BitsAreThoseOfHalfTheWidth) {
  using Dense = Matrix<TypeParam>;
  for (const auto& [m, n, k] : sizes) {
    const Dense A = Dense::Random(m, k), B = Dense::Random(k, n);
    Dense half = Dense::Random(m, n), full = half;
    subtract_product<TypeParam>(m, n, k, whole<TypeParam>(A), whole<TypeParam>(B), half.data(), m,
                                {.allowed = Instructions::avx2});
    subtract_product<TypeParam>(m, n, k, whole<TypeParam>(A), whole<TypeParam>(B), full.data(), m);
    EXPECT_EQ(half, full);
    Dense L = Dense::Random(n, n), x = Dense::Random(m, n), y = x;
    for (int i = 0; i < n; ++i) L(i, i) = 3 + 0.1 * i;
    solve_right<TypeParam>(m, n, L.data(), n, x.data(), m, Instructions::avx2);
    solve_right<TypeParam>(m, n, L.data(), n, y.data(), m);
    EXPECT_EQ(x, y);
  }
}

TYPED_TEST(DenseProducts, ErrorsAreThoseOfTheModuliThatAnEntrySums) {
  using Dense = Matrix<TypeParam>;
  const int m = 70, n = 45, k = 300;
  Dense A = Dense::Random(m, k), B = Dense::Random(k, n);
  for (int i = 0; i < m; ++i) A.row(i) *= std::pow(10.0, -2 * i);  // to 1e-138
  for (int j = 0; j < n; ++j) B.col(j) *= std::pow(10.0, 3 * j - 60);
  const MatX moduli = A.cwiseAbs() * B.cwiseAbs();
  const Dense expected = -A * B;
  for (const Instructions allowed : all_instructions) {
    Dense got(m, n);
    subtract_product<TypeParam>(m, n, k, whole<TypeParam>(A), whole<TypeParam>(B), got.data(), m,
                                {.from_zero = true, .allowed = allowed});
    EXPECT_LE(((got - expected).cwiseAbs().array() / moduli.array()).maxCoeff(), 1e-15);
  }
}

TEST(ComplexProducts, OfRealNumbersAreThose) {
  using Dense = Matrix<Complex>;
  const MatX A = MatX::Random(50, 200), B = MatX::Random(200, 33);
  const Dense a = A.cast<Complex>(), b = B.cast<Complex>();
  for (const Instructions allowed : all_instructions) {
    MatX real(50, 33);
    Dense complex(50, 33);
    subtract_product<double>(50, 33, 200, whole<double>(A), whole<double>(B), real.data(), 50,
                             {.from_zero = true, .allowed = allowed});
    subtract_product<Complex>(50, 33, 200, whole<Complex>(a), whole<Complex>(b), complex.data(), 50,
                              {.from_zero = true, .allowed = allowed});
    EXPECT_EQ(complex.imag(), MatX::Zero(50, 33));
    EXPECT_LE((complex.real() - real).cwiseAbs().maxCoeff(), 1e-13);  // in other parts
  }
}

TYPED_TEST(DenseProducts, TrianglesAreSolvedFromTheRight) {
  using Dense = Matrix<TypeParam>;
  for (const int n : {1, 2, 7, 31, 32, 33, 64, 130})
    for (const int m : {1, 5, 32, 100, 257}) {
      SCOPED_TRACE(std::to_string(m) + " rows, " + std::to_string(n) + " columns");
      Dense L = Dense::Random(n, n) / n;
      for (int i = 0; i < n; ++i) L(i, i) = 1 + 0.01 * i;
      const Dense lower = L.template triangularView<Eigen::Lower>();
      const Dense X = Dense::Random(m, n), B = X * lower.adjoint();
      for (const Instructions allowed : all_instructions) {
        Dense got = B;
        solve_right<TypeParam>(m, n, L.data(), n, got.data(), m, allowed);
        EXPECT_LE((got - X).cwiseAbs().maxCoeff(), 1e-13);
      }
    }
}

TYPED_TEST(DenseProducts, CholeskyGivesTheMatrixBack) {
  using Dense = Matrix<TypeParam>;
  for (const int n : {1, 5, 23, 24, 25, 48, 97, 128}) {
    const Dense R = Dense::Random(n, n);
    const Dense F = R * R.adjoint() + Dense::Identity(n, n);
    Dense L = F;
    ASSERT_TRUE(cholesky<TypeParam>(n, L.data(), n));
    const Dense lower = L.template triangularView<Eigen::Lower>();
    EXPECT_LE((lower * lower.adjoint() - F).cwiseAbs().maxCoeff(),
              1e-14 * n * F.cwiseAbs().maxCoeff());
    L = F;
    L(n - 1, n - 1) = -1;
    EXPECT_FALSE(cholesky<TypeParam>(n, L.data(), n));
  }
}

TYPED_TEST(DenseProducts, RightHandSidesPassSupernodesAsTheyPassTriangles) {
  using Dense = Matrix<TypeParam>;
  for (const int n : {1, 3, 24, 25, 60, 100})
    for (const int below : {0, 1, 37, 90})
      for (const int k : {1, 4, 5, 17}) {
        SCOPED_TRACE(std::to_string(n) + " columns, " + std::to_string(below) + " rows below, " +
                     std::to_string(k) + " right-hand sides");
        const int height = n + below;
        Dense block = Dense::Random(height, n) / n;
        for (int i = 0; i < n; ++i) block(i, i) = 1 + 0.01 * i;
        const Dense L = block.topRows(n).template triangularView<Eigen::Lower>();
        const Dense A = block.bottomRows(below), X = Dense::Random(n, k),
                    Y = Dense::Random(below, k);
        Dense x = L * X, y = Dense::Constant(below + 2, k, TypeParam(7));
        forward<TypeParam>(n, height, k, block.data(), x.data(), n, y.data(), below + 2);
        EXPECT_LE((x - X).cwiseAbs().maxCoeff(), 1e-13);
        if (below > 0) {
          EXPECT_LE((y.topRows(below) - A * X).cwiseAbs().maxCoeff(), 1e-12);
        }
        EXPECT_EQ(y.bottomRows(2), Dense::Constant(2, k, TypeParam(7)));
        Dense v(height, k);
        v << L.adjoint() * X + A.adjoint() * Y, Y;
        backward<TypeParam>(n, height, k, block.data(), v.data(), height);
        EXPECT_LE((v.topRows(n) - X).cwiseAbs().maxCoeff(), 1e-12);
        if (below > 0) {
          EXPECT_EQ(v.bottomRows(below), Y);
        }
      }
}

}  // namespace
}  // namespace littoral::dense
