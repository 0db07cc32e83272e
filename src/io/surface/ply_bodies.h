#pragma once
// The values in the body of a PLY file, one behind the other.

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "base/parallel.h"
#include "io/binary.h"
#include "io/surface/ply_header.h"
#include "io/text_scan.h"
#include "littoral/error.h"

namespace littoral::io {

// Values of a text body: a row of an element is a line.
class TextBody {
 public:
  static constexpr bool has_sizes = false;

  TextBody(std::string_view bytes, const std::string& name, const PlyHeader& header)
      : scan_(bytes.substr(header.body), name, '\0', false, header.body_line) {}

  void begin_row(const PlyElement& element, std::uint64_t row) {
    if (scan_.next()) return;
    fail("the file ends after " + std::to_string(row) + " of " + std::to_string(element.count) +
         " of element " + in_quotes(element.name));
  }
  double value(PlyType) { return scan_.number("a number"); }
  void values(PlyType, std::uint64_t n, double* out) {
    for (std::uint64_t i = 0; i < n; ++i) out[i] = scan_.number("a number");
  }
  std::uint64_t most_left(PlyType) const { return scan_.line_bytes_left(); }
  /// Some programs write more values behind the corners of a face than their header has.
  void end_row(bool may_have_more) {
    if (!may_have_more) scan_.expect_end();
  }
  std::size_t bytes_left() const { return scan_.line_bytes_left(); }
  [[noreturn]] void fail(const std::string& text) const { scan_.fail(text); }

 private:
  LineScanner scan_;
};

// Values of a binary body.
class BinaryBody {
 public:
  static constexpr bool has_sizes = true;  // of values, whatever they are

  BinaryBody(std::string_view bytes, const std::string& name, const PlyHeader& header)
      : bytes_(bytes),
        name_(name),
        order_(header.format == PlyFormat::big_endian ? std::endian::big : std::endian::little),
        at_(header.body) {}

  void begin_row(const PlyElement& element, std::uint64_t row) {
    element_ = &element;
    row_ = row;
  }
  double value(PlyType type) {
    double out = 0;
    values(type, 1, &out);
    return out;
  }
  /// The next n of one type.
  void values(PlyType type, std::uint64_t n, double* out) {
    switch (type) {
      case PlyType::int8:
        return take<std::int8_t>(n, out);
      case PlyType::uint8:
        return take<std::uint8_t>(n, out);
      case PlyType::int16:
        return take<std::int16_t>(n, out);
      case PlyType::uint16:
        return take<std::uint16_t>(n, out);
      case PlyType::int32:
        return take<std::int32_t>(n, out);
      case PlyType::uint32:
        return take<std::uint32_t>(n, out);
      case PlyType::float32:
        return take<float>(n, out);
      case PlyType::float64:
        return take<double>(n, out);
    }
  }
  std::uint64_t most_left(PlyType type) const { return bytes_left() / byte_size(type); }
  void end_row(bool) {}
  std::size_t bytes_left() const { return bytes_.size() - at_; }
  void pass(std::size_t bytes) { at_ += std::min(bytes, bytes_left()); }
  /// Takes the first rows of an element of faces as long as they are triangles of the n vertices,
  /// side by side, and returns how many; none where rows have more than a list of the usual type.
  std::uint64_t take_triangles(const PlyElement& element, std::uint64_t n,
                               std::vector<int>& corners);
  [[noreturn]] void fail(const std::string& text) const {
    throw InputError(name_ + ": byte " + std::to_string(at_) + ": " + text, "bad-file");
  }

 private:
  template <class T>
  void take(std::uint64_t n, double* out) {
    const std::uint64_t there = bytes_left() / sizeof(T);
    const char* from = bytes_.data() + at_;
    at_ += std::min(n, there) * sizeof(T);
    if (there < n) {
      fail("the file ends after " + std::to_string(row_) + " of " +
           std::to_string(element_->count) + " of element " + in_quotes(element_->name));
    }
    for (std::uint64_t i = 0; i < n; ++i) out[i] = load<T>(from + i * sizeof(T), order_);
  }

  std::string_view bytes_;
  const std::string& name_;
  std::endian order_;
  std::size_t at_;
  const PlyElement* element_ = nullptr;
  std::uint64_t row_ = 0;
};

inline std::uint64_t BinaryBody::take_triangles(const PlyElement& element, std::uint64_t n,
                                                std::vector<int>& corners) {
  const PlyProperty& list = element.properties.front();
  const bool usual = element.properties.size() == 1 && byte_size(list.count_type) == 1 &&
                     (list.type == PlyType::int32 || list.type == PlyType::uint32);
  if (!usual) return 0;
  constexpr std::size_t row_bytes = 1 + 3 * sizeof(std::uint32_t), grain = 1 << 14;
  const std::size_t most = std::min<std::size_t>(
      {std::size_t(element.count), bytes_left() / row_bytes, std::numeric_limits<int>::max() / 3});
  corners.resize(3 * most);
  std::vector<std::size_t> taken((most + grain - 1) / grain);  // of each piece
  parallel_for(most, grain, [&](std::size_t begin, std::size_t end) {
    std::size_t r = begin;
    for (; r < end; ++r) {
      const char* const row = bytes_.data() + at_ + r * row_bytes;
      std::array<std::uint32_t, 3> v;  // a negative number is a large one here
      for (std::size_t k = 0; k < 3; ++k)
        v[k] = load<std::uint32_t>(row + 1 + k * sizeof(std::uint32_t), order_);
      if (*row != 3 || std::max({v[0], v[1], v[2]}) >= n) break;
      for (std::size_t k = 0; k < 3; ++k) corners[3 * r + k] = static_cast<int>(v[k]);
    }
    taken[begin / grain] = r - begin;
  });
  std::size_t all = 0;
  for (std::size_t piece = 0; piece < taken.size() && all == piece * grain; ++piece)
    all += taken[piece];
  corners.resize(3 * all);
  pass(all * row_bytes);
  return all;
}

}  // namespace littoral::io
