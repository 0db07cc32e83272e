#pragma once
// What tests read in reports.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "littoral/report.h"

namespace littoral::test {

/// A size that the report has.
inline double size_named(const Report& report, const std::string& name) {
  for (const auto& [each, value] : report.sizes)
    if (each == name) return value;
  ADD_FAILURE() << "no size " << name;
  return NAN;
}

}  // namespace littoral::test
