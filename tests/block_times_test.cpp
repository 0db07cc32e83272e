// A block times a vector against Eigen's, with every set of instructions that this processor has.

#include "solve/direct/block_times.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <string>

#include "littoral/types.h"

namespace littoral::dense {
namespace {

constexpr int between = 3;  // numbers from the end of a column to the next

template <class Scalar>
class BlockTimes : public testing::Test {
 public:
  using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
  using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;

  template <Into into>
  static Vector product(const Matrix& A, int m, const Vector& x, const Vector& y,
                        Instructions allowed) {
    Vector out = y;
    times<into>(m, int(x.size()), A.data(), int(A.rows()), x.data(), out.data(), allowed);
    return out;
  }
};
using BlockScalars = testing::Types<double, Complex>;
TYPED_TEST_SUITE(BlockTimes, BlockScalars);

TYPED_TEST(BlockTimes, ProductsAreEigensAndEndWhereTheyShould) {
  using Fixture = BlockTimes<TypeParam>;
  for (int m = 0; m <= 40; ++m)
    for (const int n : {0, 1, 2, 5, 24}) {
      SCOPED_TRACE(std::to_string(m) + " x " + std::to_string(n));
      const auto A = Fixture::Matrix::Random(m + between, n + 1).eval();
      const auto x = Fixture::Vector::Random(n).eval(), y = Fixture::Vector::Random(m + 9).eval();
      const auto Ax = (A.topLeftCorner(m, n) * x).eval();
      typename Fixture::Vector replaced = y, added = y, subtracted = y;
      replaced.head(m) = Ax;
      added.head(m) += Ax;
      subtracted.head(m) -= Ax;
      for (const Instructions allowed :
           {Instructions::plain, Instructions::avx2, Instructions::any}) {
        const auto far = [&](const auto& got, const auto& expected) {
          EXPECT_EQ(got.tail(9), y.tail(9));
          return (got - expected).cwiseAbs().maxCoeff();
        };
        constexpr double rounding = 1e-14;
        EXPECT_LE(far(Fixture::template product<Into::replaced>(A, m, x, y, allowed), replaced),
                  rounding);
        EXPECT_LE(far(Fixture::template product<Into::added>(A, m, x, y, allowed), added),
                  rounding);
        EXPECT_LE(far(Fixture::template product<Into::subtracted>(A, m, x, y, allowed), subtracted),
                  rounding);
      }
      EXPECT_EQ(Fixture::template product<Into::subtracted>(A, m, x, y, Instructions::avx2),
                Fixture::template product<Into::subtracted>(A, m, x, y, Instructions::any));
    }
}

TYPED_TEST(BlockTimes, AdjointsAreEigens) {
  using Fixture = BlockTimes<TypeParam>;
  for (int m = 0; m <= 40; ++m)
    for (int n = 1; n <= 4; ++n) {
      SCOPED_TRACE(std::to_string(m) + " x " + std::to_string(n));
      const auto A = Fixture::Matrix::Random(m + between, n).eval();
      const auto x = Fixture::Vector::Random(n + 1).eval(), y = Fixture::Vector::Random(m).eval();
      for (const Instructions allowed : {Instructions::plain, Instructions::any}) {
        auto got = x;
        subtract_adjoint(m, n, A.data(), int(A.rows()), y.data(), got.data(), allowed);
        EXPECT_LE((got.head(n) - (x.head(n) - A.topRows(m).adjoint() * y)).cwiseAbs().maxCoeff(),
                  1e-14);
        EXPECT_EQ(got[n], x[n]);
      }
    }
}

}  // namespace
}  // namespace littoral::dense
