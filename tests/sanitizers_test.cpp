// That the build with sanitizers catches faults, in headers that cmake/sanitizers.ignore names as
// well.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <array>
#include <climits>
#include <vector>

#ifdef __has_feature
#if __has_feature(address_sanitizer)
#define LITTORAL_TESTS_SANITIZED
#endif
#endif

namespace littoral {
namespace {

// A value that the compiler does not know.
template <class T>
T hidden_value(T value) {
  volatile T hidden = value;
  return hidden;
}

TEST(SanitizersDeathTest, FaultsEndTheProgram) {
#ifndef LITTORAL_TESTS_SANITIZED
  GTEST_SKIP() << "built without sanitizers";
#else
  const int ten = hidden_value(10);
  std::vector<double> five(5, 1.0);
  five.shrink_to_fit();
  const Eigen::Map<Eigen::VectorXd> too_long(five.data(), ten);
  EXPECT_DEATH(hidden_value<double>(too_long.sum()), "AddressSanitizer: heap-");
  const Eigen::VectorXd three = Eigen::VectorXd::Zero(3);
  EXPECT_DEATH(hidden_value<double>(three.coeff(ten)), "AddressSanitizer: heap-");
  EXPECT_DEATH(hidden_value<double>(three[ten]), "Assertion");
  EXPECT_DEATH(hidden_value<double>(five[ten]), "Assertion");
  EXPECT_DEATH(hidden_value<double>(five.data()[ten]), "AddressSanitizer: heap-");
  EXPECT_DEATH(hidden_value<double>(INT_MAX - 2 + ten), "signed integer overflow");
  EXPECT_DEATH(hidden_value<double>(static_cast<int>(1e30 * ten)), "outside the range");
  std::array<char, 16> bytes{};
  const int* const odd =
      reinterpret_cast<const int*>(bytes.data() + hidden_value(1) + hidden_value(1) + 1);
  EXPECT_DEATH(hidden_value<double>(*odd), "misaligned");
  const int* const nowhere = hidden_value<int*>(nullptr);
  EXPECT_DEATH(hidden_value<double>(*nowhere), "null pointer");
#endif
}

}  // namespace
}  // namespace littoral
