#pragma once
// Surface files given as text in the tests themselves.

#include <string>

#include "io/read.h"
#include "littoral/error.h"

namespace littoral::test {

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
