#pragma once
// What must be so of an answer.

#include <string>
#include <vector>

#include "method_case.h"

namespace littoral::fuzz {

/// Calls the method and returns what is wrong with the answer. Throws what the call throws, and
/// Cancelled where it exceeds its budget.
std::vector<std::string> checked(const MethodCase& given, Choices& choose, double seconds);

}  // namespace littoral::fuzz
