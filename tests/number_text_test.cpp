// Numbers in sentences.

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "base/option_table.h"
#include "base/platform/memory.h"
#include "comma_locale.h"
#include "littoral/error.h"

namespace littoral {
namespace {

TEST(NumberText, MeasuredValuesAreRounded) {
  EXPECT_EQ(rounded_text(0), "0");
  EXPECT_EQ(rounded_text(1.0 / 3), "0.3333");
  EXPECT_EQ(rounded_text(-1.0 / 3, 2), "-0.33");
  EXPECT_EQ(rounded_text(123456), "123500");
  EXPECT_EQ(rounded_text(123456, 1), "1e+05");
  EXPECT_EQ(rounded_text(0.99996), "1");
  EXPECT_EQ(rounded_text(1.23456e-7, 3), "1.23e-07");
  EXPECT_EQ(rounded_text(std::numeric_limits<double>::infinity()), "inf");
}

TEST(NumberText, SharesArePercent) {
  EXPECT_EQ(percent_text(0), "0 %");
  EXPECT_EQ(percent_text(0.000123), "0.012 %");
  EXPECT_EQ(percent_text(0.025), "2.5 %");
  EXPECT_EQ(percent_text(0.0994), "9.9 %");
  EXPECT_EQ(percent_text(0.0996), "10 %");
  EXPECT_EQ(percent_text(0.567), "57 %");
  EXPECT_EQ(percent_text(1), "100 %");
}

TEST(NumberText, TheLocaleOfTheProgramChangesNone) {
  const test::CommaLocale comma;
  if (!test::CommaLocale::there()) GTEST_SKIP() << test::no_comma_locale;
  EXPECT_EQ(rounded_text(0.125), "0.125");
  EXPECT_EQ(percent_text(0.025), "2.5 %");
  try {
    check_memory(1.25e18, "this", "less");
    FAIL() << "there is not as much memory";
  } catch (const IoError& error) {
    EXPECT_EQ(std::string(error.what()).find(','), std::string(error.what()).find(", "));
    EXPECT_NE(std::string(error.what()).find("this needs about 1250000000 GB of memory, "),
              std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace littoral
