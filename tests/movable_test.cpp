// Sparse matrices that hand over what they hold.

#include "base/movable.h"

#include <gtest/gtest.h>

#include <utility>

#include "littoral/types.h"

namespace littoral {
namespace {

SpMat diagonal(int n) {
  SpMat A(n, n);
  A.setIdentity();
  A *= 3;
  return A;
}

TEST(Movable, HandsOverItsNumbersAndCopiesWhereAsked) {
  SpMat given = diagonal(5);
  const double* const numbers = given.valuePtr();
  Movable<SpMat> first = std::move(given);
  EXPECT_EQ(first.valuePtr(), numbers);
  Movable<SpMat> second = std::move(first);
  EXPECT_EQ(second.valuePtr(), numbers);
  const Movable<SpMat> copy = second;
  EXPECT_NE(copy.valuePtr(), numbers);
  EXPECT_EQ(copy.coeff(4, 4), 3);
  Movable<SpMat> third;
  third = std::move(second);
  EXPECT_EQ(third.valuePtr(), numbers);
  third = diagonal(2);
  EXPECT_EQ(third.rows(), 2);
  third = copy * 2.0;
  EXPECT_EQ(third.coeff(4, 4), 6);
  EXPECT_EQ(SpMat(third).nonZeros(), 5);
}

}  // namespace
}  // namespace littoral
