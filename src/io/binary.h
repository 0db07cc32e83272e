#pragma once
// Numbers in files of either byte order.

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <ostream>
#include <span>

namespace littoral::io {

static_assert(std::endian::native == std::endian::little ||
              std::endian::native == std::endian::big);

/// The number stored at `from` in the byte order `order`; `from` need not be aligned.
template <class T>
T load(const char* from, std::endian order) {
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), from, sizeof(T));
  if (order != std::endian::native) std::reverse(bytes.begin(), bytes.end());
  return std::bit_cast<T>(bytes);
}

template <class T>
T load_little(const char* from) {
  return load<T>(from, std::endian::little);
}

/// Writes a number with its lowest byte first.
template <class T>
void store_little(std::ostream& out, T value) {
  auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if (std::endian::native != std::endian::little) std::reverse(bytes.begin(), bytes.end());
  out.write(bytes.data(), sizeof(T));
}

/// The same for all numbers of a vector or matrix, as they lie in memory.
template <class Numbers>
void store_all_little(std::ostream& out, const Numbers& numbers) {
  const std::span values(numbers.data(), std::size_t(numbers.size()));
  if (std::endian::native == std::endian::little)
    out.write(reinterpret_cast<const char*>(values.data()), std::streamsize(values.size_bytes()));
  else
    for (const auto value : values) store_little(out, value);
}

}  // namespace littoral::io
