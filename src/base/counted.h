#pragma once
// Numbers of things in sentences.

#include <string>

namespace littoral {

/// "1 face", "2 faces": the number, and the words after it for one and for any other number.
template <class Integer>
std::string counted(Integer n, const std::string& one, const std::string& many) {
  return std::to_string(n) + " " + (n == 1 ? one : many);
}

}  // namespace littoral
