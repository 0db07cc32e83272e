// Point Cloud Data (.pcd), the format of the Point Cloud Library.

#include <array>
#include <bit>
#include <limits>
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

struct Header {
  std::vector<Field> fields;
  std::int64_t points = -1;
  bool binary = false;
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
      if (data != "ascii" && data != "binary")
        scan.fail("DATA " + in_quotes(data) + " is not supported, only ascii and binary");
      header.binary = data == "binary";
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
  // Every value takes a byte in a binary file and two in a text.
  const std::uint64_t needed = static_cast<std::uint64_t>(header.points) *
                               static_cast<std::uint64_t>(header.binary ? stride : 2 * per_row - 1);
  if (needed > bytes.size() - body + 1)
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
  if (header.binary) {
    for (std::int64_t r = 0; r < header.points; ++r)
      for (int k = 0; k < n_wanted; ++k) {
        const auto i = static_cast<std::size_t>(where[static_cast<std::size_t>(k)]);
        const char* at = bytes.data() + body + r * stride + offset[i];
        put(r, k, load_field(at, header.fields[i], name));
      }
    return cloud;
  }
  LineScanner rows(bytes.substr(body), name, '#', false, header.body_line);
  std::vector<double> row(static_cast<std::size_t>(per_row));
  for (std::int64_t r = 0; r < header.points; ++r) {
    if (!rows.next())
      rows.fail("the file ends after " + std::to_string(r) + " of " +
                std::to_string(header.points) + " points");
    for (double& value : row) value = rows.number("a number");
    rows.expect_end();
    for (int k = 0; k < n_wanted; ++k) {
      const auto i = static_cast<std::size_t>(where[static_cast<std::size_t>(k)]);
      put(r, k, row[static_cast<std::size_t>(column[i])]);
    }
  }
  return cloud;
}

}  // namespace littoral::io
