#pragma once
// Surface files that the tests themselves make up.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <string>

#include "io/read.h"
#include "littoral/error.h"

namespace littoral::test {

/// Appends a number in either byte order.
template <class T>
void put(std::string& bytes, T value, bool big) {
  auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if (big == (std::endian::native == std::endian::little)) std::reverse(raw.begin(), raw.end());
  bytes.append(raw.data(), raw.size());
}

/// The text with the first `from` in it replaced.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

inline PolygonSoup read(const std::string& bytes, const std::string& extension) {
  return io::read_surface_bytes(bytes, extension, "a" + extension);
}

/// The message with which the bytes are refused, or "no error".
inline std::string error_of(const std::string& bytes, const std::string& extension) {
  try {
    read(bytes, extension);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace littoral::test
