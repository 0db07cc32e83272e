#pragma once
// Numbers in files of either byte order.

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <ostream>
#include <span>
#include <vector>

#include "base/parallel.h"

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

/// Stores a number at `to` with its lowest byte first; returns where the next one goes.
template <class T>
char* put_little(char* to, T value) {
  auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if (std::endian::native != std::endian::little) std::reverse(bytes.begin(), bytes.end());
  std::memcpy(to, bytes.data(), sizeof(T));
  return to + sizeof(T);
}

/// Writes a number the same way.
template <class T>
void store_little(std::ostream& out, T value) {
  std::array<char, sizeof(T)> bytes;
  put_little(bytes.data(), value);
  out.write(bytes.data(), sizeof(T));
}

/// The same for all numbers of a vector, matrix or span, as they lie in memory.
template <class Numbers>
void store_all_little(std::ostream& out, const Numbers& numbers) {
  const std::span values(numbers.data(), std::size_t(numbers.size()));
  if (std::endian::native == std::endian::little)
    out.write(reinterpret_cast<const char*>(values.data()), std::streamsize(values.size_bytes()));
  else
    for (const auto value : values) store_little(out, value);
}

/// Writes n records one after another, many of them at once. begin_of(i): how many bytes are before
/// the i-th, and begin_of(n) all of them; put(i, to) stores it at `to`.
template <class BeginOf, class Put>
void store_records(std::ostream& out, std::size_t n, const BeginOf& begin_of, const Put& put) {
  constexpr std::size_t at_once = 1 << 15, grain = 1 << 12;
  std::vector<char> bytes;
  for (std::size_t first = 0; first < n; first += at_once) {
    const std::size_t past = std::min(n, first + at_once), before = begin_of(first);
    bytes.resize(begin_of(past) - before);
    parallel_for(past - first, grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = first + begin; i < first + end; ++i)
        put(i, bytes.data() + (begin_of(i) - before));
    });
    out.write(bytes.data(), std::streamsize(bytes.size()));
  }
}

}  // namespace littoral::io
