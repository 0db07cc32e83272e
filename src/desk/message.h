#pragma once
// What crosses between the library and JavaScript, in a worker or over HTTP: JSON, and arrays of
// numbers beside it.

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace littoral::desk {

/// In the JSON an array is {"$f64": [at, count]}, with its first byte in `arrays`; likewise $i32,
/// $u32 and $u8. A number that is not finite is {"$number": "NaN"}, "Infinity" or "-Infinity".
struct Message {
  nlohmann::json head;
  std::string arrays;
};

/// The length of the JSON and a word to know it by, four bytes each with the low one first; the
/// JSON, filled with spaces, and the arrays, each at a multiple of eight bytes.
std::string packed(const Message& message);
/// Throws InputError.
Message unpacked(std::string_view bytes);

}  // namespace littoral::desk
