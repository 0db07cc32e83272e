// Point Cloud Data (.pcd), the format of the Point Cloud Library.

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "io/binary.h"
#include "io/surface/surface_formats.h"
#include "io/text_scan.h"
#include "littoral/error.h"

namespace littoral::io {
namespace {

// One value of a row: SIZE bytes of TYPE F (float), I (signed), U (unsigned).
struct Field {
  std::string name;
  std::int64_t size = 4, count = 1;
  char type = 'F';
};

enum class PcdData { ascii, binary, compressed };

struct Header {
  std::vector<Field> fields;
  std::int64_t points = -1;
  PcdData data = PcdData::ascii;
  std::size_t body_line = 1;
};

std::vector<std::string> words(LineScanner& scan) {
  std::vector<std::string> out;
  for (std::string_view word; !(word = scan.word()).empty();) out.emplace_back(word);
  return out;
}

Header read_header(LineScanner& scan) {
  Header header;
  std::int64_t width = -1, height = 1;
  while (scan.next()) {
    const std::string key(scan.word());
    const auto each_field = [&](const auto& set) {
      const std::vector<std::string> row = words(scan);
      if (row.size() != header.fields.size())
        scan.fail(key + " has " + std::to_string(row.size()) + " entries, FIELDS has " +
                  std::to_string(header.fields.size()));
      for (std::size_t i = 0; i < row.size(); ++i) set(header.fields[i], row[i]);
    };
    const auto integer = [&](const std::string& word, std::int64_t low, std::int64_t high) {
      const auto value = parse_integer(word);
      if (!value || *value < low || *value > high)
        scan.fail(key + ": " + in_quotes(word) + " is not possible");
      return *value;
    };
    if (key == "FIELDS" || key == "COLUMNS") {
      header.fields.clear();
      for (std::string& word : words(scan)) header.fields.emplace_back().name = std::move(word);
    } else if (key == "SIZE") {
      each_field([&](Field& f, const std::string& word) { f.size = integer(word, 1, 8); });
    } else if (key == "TYPE") {
      each_field([&](Field& f, const std::string& word) { f.type = word[0]; });
    } else if (key == "COUNT") {
      each_field([&](Field& f, const std::string& word) { f.count = integer(word, 0, 1 << 16); });
    } else if (key == "WIDTH") {
      width = integer(std::string(scan.word()), 0, std::numeric_limits<int>::max());
    } else if (key == "HEIGHT") {
      height = integer(std::string(scan.word()), 0, std::numeric_limits<int>::max());
    } else if (key == "POINTS") {
      header.points = integer(std::string(scan.word()), 0, std::numeric_limits<int>::max());
    } else if (key == "DATA") {
      const std::string_view data = scan.word();
      constexpr std::array<std::string_view, 3> known{"ascii", "binary", "binary_compressed"};
      const auto found = std::ranges::find(known, data);
      if (found == known.end())
        scan.fail("DATA " + in_quotes(data) +
                  " is not known; ascii, binary, binary_compressed are");
      header.data = static_cast<PcdData>(found - known.begin());
      if (header.fields.empty()) scan.fail("no FIELDS before DATA");
      if (header.points < 0) header.points = width < 0 ? -1 : width * height;
      if (header.points < 0) scan.fail("neither POINTS nor WIDTH before DATA");
      header.body_line = scan.line() + 1;
      return header;
    } else if (key != "VERSION" && key != "VIEWPOINT") {
      scan.fail("unknown header entry " + in_quotes(key));
    }
  }
  scan.fail("the file ends before DATA");
}

double load_field(const char* from, const Field& f, const std::string& name) {
  constexpr auto little = std::endian::little;
  const auto is = [&](char type, int size) { return f.type == type && f.size == size; };
  if (is('F', 4)) return load<float>(from, little);
  if (is('F', 8)) return load<double>(from, little);
  throw InputError(name + ": field " + in_quotes(f.name) + " is not of type F and size 4 or 8",
                   "bad-file");
}

/// What a packed run of bytes holds (LZF): pieces as they are, of up to 32 bytes, and copies of
/// what came up to 8192 bytes before. Nothing where that is not `size` bytes.
std::optional<std::string> unpack_lzf(std::string_view packed, std::size_t size) {
  constexpr std::size_t most_per_byte = 88;  // three bytes say at most 264
  if (size / most_per_byte > packed.size()) return std::nullopt;
  std::string out;
  out.reserve(size);
  std::size_t at = 0;
  const auto byte = [&] { return static_cast<unsigned char>(packed[at++]); };
  while (at < packed.size()) {
    const unsigned control = byte();
    if (control < 32) {
      if (control + 1 > std::min(packed.size() - at, size - out.size())) return std::nullopt;
      out.append(packed.substr(at, control + 1));
      at += control + 1;
      continue;
    }
    std::size_t length = (control >> 5) + 2;
    if (packed.size() - at < (length == 9 ? 2u : 1u)) return std::nullopt;
    if (length == 9) length += byte();
    const std::size_t back = ((control & 31u) << 8 | byte()) + 1;
    if (back > out.size() || length > size - out.size()) return std::nullopt;
    for (std::size_t k = 0; k < length; ++k) out.push_back(out[out.size() - back]);
  }
  if (out.size() != size) return std::nullopt;
  return out;
}

/// The values of a compressed body, one field of all points after the other.
std::string compressed_fields(std::string_view body, std::uint64_t size, const std::string& name) {
  const auto fail = [&](const std::string& what) {
    throw InputError(name + ": " + what, "bad-file");
  };
  if (body.size() < 8) fail("the file ends before the sizes of its compressed data");
  const auto packed = load<std::uint32_t>(body.data(), std::endian::little);
  const auto unpacked = load<std::uint32_t>(body.data() + 4, std::endian::little);
  if (unpacked != size)
    fail("the compressed data promise " + std::to_string(unpacked) + " bytes, the points take " +
         std::to_string(size));
  if (packed > body.size() - 8)
    fail("the file ends within " + std::to_string(packed) + " bytes of compressed data");
  const std::optional<std::string> out = unpack_lzf(body.substr(8, packed), size);
  if (!out) fail("the compressed data are damaged");
  return *out;
}

/// First byte after the line that starts with DATA.
std::size_t body_start(std::string_view bytes) {
  for (std::size_t line = 0; line < bytes.size();) {
    const std::size_t end = std::min(bytes.find('\n', line), bytes.size() - 1);
    if (bytes.substr(line).starts_with("DATA")) return end + 1;
    line = end + 1;
  }
  return bytes.size();
}

}  // namespace

PolygonSoup read_pcd(std::string_view bytes, const std::string& name) {
  const std::size_t body = body_start(bytes);
  LineScanner scan(bytes.substr(0, body), name, '#');
  const Header header = read_header(scan);
  std::array<int, 6> where{-1, -1, -1, -1, -1, -1};  // x y z and the normal: which field
  constexpr std::array<const char*, 6> wanted{"x", "y", "z", "normal_x", "normal_y", "normal_z"};
  std::int64_t stride = 0, per_row = 0;
  std::vector<std::int64_t> offset, column;
  for (std::size_t i = 0; i < header.fields.size(); ++i) {
    const Field& f = header.fields[i];
    for (std::size_t k = 0; k < wanted.size(); ++k)
      if (f.name == wanted[k] && f.count == 1) where[k] = static_cast<int>(i);
    offset.push_back(stride);
    column.push_back(per_row);
    stride += f.size * f.count;
    per_row += f.count;
  }
  if (where[0] < 0 || where[1] < 0 || where[2] < 0)
    throw InputError(name + ": FIELDS has no x, y and z", "bad-file");
  const bool normals = where[3] >= 0 && where[4] >= 0 && where[5] >= 0;
  const auto points = static_cast<std::uint64_t>(header.points);
  std::string unpacked;
  if (header.data == PcdData::compressed)
    unpacked =
        compressed_fields(bytes.substr(body), points * static_cast<std::uint64_t>(stride), name);
  // Every value takes a byte in a binary file and two in a text.
  const bool text = header.data == PcdData::ascii;
  const std::uint64_t needed = points * static_cast<std::uint64_t>(text ? 2 * per_row - 1 : stride);
  if (needed > std::max(bytes.size() - body + 1, unpacked.size()))
    throw InputError(name + ": the header promises " + std::to_string(header.points) +
                         " points, the file has " + std::to_string(bytes.size()) + " bytes",
                     "bad-file");
  if (header.points == 0) throw InputError(name + ": no points", "bad-file");
  PolygonSoup cloud;
  cloud.points.resize(header.points, 3);
  if (normals) cloud.normals.resize(header.points, 3);
  const int n_wanted = normals ? 6 : 3;
  const auto put = [&](std::int64_t r, int k, double value) {
    (k < 3 ? cloud.points(r, k) : cloud.normals(r, k - 3)) = value;
  };
  if (!text) {
    for (std::int64_t r = 0; r < header.points; ++r)
      for (int k = 0; k < n_wanted; ++k) {
        const auto i = std::size_t(where[k]);
        const Field& field = header.fields[i];
        const char* at = header.data == PcdData::binary
                             ? bytes.data() + body + r * stride + offset[i]
                             : unpacked.data() + header.points * offset[i] + r * field.size;
        put(r, k, load_field(at, field, name));
      }
    return cloud;
  }
  LineScanner rows(bytes.substr(body), name, '#', false, header.body_line);
  std::vector<double> row(per_row);
  for (std::int64_t r = 0; r < header.points; ++r) {
    if (!rows.next())
      rows.fail("the file ends after " + std::to_string(r) + " of " +
                std::to_string(header.points) + " points");
    for (double& value : row) value = rows.number("a number");
    rows.expect_end();
    for (int k = 0; k < n_wanted; ++k) {
      const auto i = std::size_t(where[k]);
      put(r, k, row[column[i]]);
    }
  }
  return cloud;
}

}  // namespace littoral::io
