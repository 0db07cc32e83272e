// What volume formats share: stored numbers, sizes, packed data.

#include <zlib.h>

#include <array>
#include <cmath>
#include <limits>

#include "base/index.h"
#include "io/binary.h"
#include "io/volume/volume_formats.h"
#include "littoral/error.h"

namespace littoral::io {

namespace {

template <class T>
void load_all(std::string_view bytes, std::endian order, VecX& values) {
  for (Eigen::Index i = 0; i < values.size(); ++i)
    values[i] = static_cast<double>(load<T>(bytes.data() + sizeof(T) * std::size_t(i), order));
}

}  // namespace

namespace {

/// IEEE 754 in two bytes: sign, five bits of exponent, ten of the mantissa.
double half_precision(int bits) {
  const int exponent = bits >> 10 & 31, mantissa = bits & 1023;
  double value =
      exponent == 0 ? std::ldexp(mantissa, -24) : std::ldexp(1024 + mantissa, exponent - 25);
  if (exponent == 31) value = mantissa == 0 ? infinity : std::numeric_limits<double>::quiet_NaN();
  return bits >> 15 ? -value : value;
}

}  // namespace

VecX load_numbers(std::string_view bytes, NumberKind kind, std::size_t count, std::endian order) {
  VecX values(index(count));
  const auto is = [&](char family, std::size_t size) {
    return kind.family == family && kind.size == size;
  };
  if (is('f', 8)) load_all<double>(bytes, order, values);
  if (is('f', 4)) load_all<float>(bytes, order, values);
  if (is('f', 2)) {
    load_all<std::uint16_t>(bytes, order, values);
    for (double& value : values) value = half_precision(static_cast<int>(value));
  }
  if (is('i', 1)) load_all<std::int8_t>(bytes, order, values);
  if (is('u', 1)) load_all<std::uint8_t>(bytes, order, values);
  if (is('i', 2)) load_all<std::int16_t>(bytes, order, values);
  if (is('u', 2)) load_all<std::uint16_t>(bytes, order, values);
  if (is('i', 4)) load_all<std::int32_t>(bytes, order, values);
  if (is('u', 4)) load_all<std::uint32_t>(bytes, order, values);
  if (is('i', 8)) load_all<std::int64_t>(bytes, order, values);
  if (is('u', 8)) load_all<std::uint64_t>(bytes, order, values);
  return values;
}

void store_numbers(std::ostream& out, const VecX& values) { store_all_little(out, values); }

std::size_t load_size(std::string_view bytes, std::endian order) {
  if (bytes.size() == 4) return load<std::uint32_t>(bytes.data(), order);
  return std::size_t(std::min<std::uint64_t>(load<std::uint64_t>(bytes.data(), order),
                                             std::numeric_limits<std::size_t>::max()));
}

std::size_t checked_nodes(const std::array<std::int64_t, 3>& n, std::uint64_t most,
                          const std::string& name) {
  most = std::min<std::uint64_t>(most, std::numeric_limits<std::ptrdiff_t>::max());
  std::size_t nodes = 1;
  for (const std::int64_t k : n) {
    if (k < 1) throw InputError(name + ": the grid has no nodes", "bad-file");
    if (k > std::numeric_limits<int>::max() || nodes > most / static_cast<std::uint64_t>(k))
      throw InputError(name + ": " + std::to_string(n[0]) + " x " + std::to_string(n[1]) + " x " +
                           std::to_string(n[2]) + " nodes are more than the file holds",
                       "bad-file");
    nodes *= std::size_t(k);
  }
  return nodes;
}

void check_box(const Grid& grid, const std::string& name) {
  const Vec3 far = grid.point(grid.n[0] - 1, grid.n[1] - 1, grid.n[2] - 1);
  if (!(grid.spacing.minCoeff() > 0) || !grid.spacing.allFinite())
    throw InputError(name + ": the spacing of the grid must be positive", "option-value");
  if (!grid.origin.allFinite() || !far.allFinite())
    throw InputError(name + ": the box of the grid is not finite", "bad-file");
}

std::optional<std::string> decode_base64(std::string_view text, std::size_t& used) {
  std::string bytes;
  std::uint32_t bits = 0;
  int held = 0, padding = 0;
  for (used = 0; used < text.size(); ++used) {
    const char c = text[used];
    int digit = -1;
    if (c >= 'A' && c <= 'Z') digit = c - 'A';
    if (c >= 'a' && c <= 'z') digit = c - 'a' + 26;
    if (c >= '0' && c <= '9') digit = c - '0' + 52;
    if (c == '+') digit = 62;
    if (c == '/') digit = 63;
    if (c == ' ' || c == '\n' || c == '\r' || c == '\t') continue;
    if (c == '=') {
      ++padding;
      digit = 0;
    } else if (padding > 0) {
      break;  // another text begins
    }
    if (digit < 0) return std::nullopt;
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    if (++held < 4) continue;
    if (padding > 2) return std::nullopt;
    for (int k = 2; k >= padding; --k) bytes += static_cast<char>(bits >> 8 * k & 255);
    bits = 0;
    held = 0;
    if (padding > 0) {
      ++used;
      break;
    }
  }
  if (held != 0) return std::nullopt;
  return bytes;
}

namespace {

/// What a stream unpacks to, `most` bytes at most, and whether that is all of it.
struct Unpacked {
  std::string bytes;
  bool ended = false;
};

Unpacked unpack_up_to(std::string_view packed, std::size_t most, Packing packing) {
  Unpacked out;
  z_stream stream{};
  const int window = packing == Packing::raw_deflate ? -15 : 15 + 32;
  if (inflateInit2(&stream, window) != Z_OK) return out;
  out.bytes.resize(most);
  // zlib counts in 32 bits: feed it pieces.
  constexpr std::size_t piece = std::size_t{1} << 30;
  std::size_t in = 0, made = 0;
  int status = Z_OK;
  while (status == Z_OK) {
    const std::size_t give = std::min(piece, packed.size() - in);
    const std::size_t room = std::min(piece, most - made);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data() + in));
    stream.avail_in = static_cast<uInt>(give);
    stream.next_out = reinterpret_cast<Bytef*>(out.bytes.data() + made);
    stream.avail_out = static_cast<uInt>(room);
    status = inflate(&stream, Z_NO_FLUSH);
    const std::size_t taken = give - stream.avail_in, more = room - stream.avail_out;
    in += taken;
    made += more;
    if (taken == 0 && more == 0 && status == Z_OK) break;
  }
  inflateEnd(&stream);
  out.bytes.resize(made);
  out.ended = status == Z_STREAM_END;
  return out;
}

}  // namespace

std::optional<std::string> unpack(std::string_view packed, std::size_t size, Packing packing) {
  constexpr std::size_t best_ratio = 1032;  // of the format
  if (size / best_ratio > packed.size() + 1) return std::nullopt;
  Unpacked all = unpack_up_to(packed, size, packing);
  if (!all.ended || all.bytes.size() != size) return std::nullopt;
  return std::move(all.bytes);
}

std::string unpacked_beginning(std::string_view packed, std::size_t most) {
  return unpack_up_to(packed, most, Packing::zlib_or_gzip).bytes;
}

}  // namespace littoral::io
