// NumPy arrays of three dimensions.

#include <algorithm>
#include <charconv>
#include <limits>

#include "io/any_formats.h"
#include "io/binary.h"
#include "io/text_scan.h"
#include "io/volume/volume_formats.h"
#include "io/write_table.h"
#include "littoral/error.h"

namespace littoral::io {

namespace {

// What follows 'key': in the header's dictionary, without blanks before it.
std::string_view entry(std::string_view header, const std::string& key) {
  for (const char quote : {'\'', '"'}) {
    const std::string text = quote + key + quote;
    std::size_t at = header.find(text);
    if (at == std::string_view::npos) continue;
    at = header.find_first_not_of(' ', at + text.size());
    if (at == std::string_view::npos || header[at] != ':') continue;
    at = header.find_first_not_of(' ', at + 1);
    if (at != std::string_view::npos) return header.substr(at);
  }
  return {};
}

}  // namespace

std::optional<NpyHeader> parse_npy_header(std::string_view bytes) {
  if (bytes.size() < 10 || bytes.substr(0, 6) != "\x93NUMPY") return std::nullopt;
  const int version = bytes[6];
  const std::size_t start = version == 1 ? 10 : 12;
  if (version < 1 || version > 3 || bytes.size() < start) return std::nullopt;
  const std::size_t length = version == 1 ? load_little<std::uint16_t>(bytes.data() + 8)
                                          : load_little<std::uint32_t>(bytes.data() + 8);
  if (length > bytes.size() - start) return std::nullopt;
  const std::string_view header = bytes.substr(start, length);
  NpyHeader npy;
  npy.data = start + length;

  const std::string_view descr = entry(header, "descr"), order = entry(header, "fortran_order"),
                         shape = entry(header, "shape");
  if (descr.size() < 2 || (descr[0] != '\'' && descr[0] != '"')) return std::nullopt;
  const std::size_t end = descr.find(descr[0], 1);
  if (end == std::string_view::npos) return std::nullopt;
  npy.type = descr.substr(1, end - 1);
  npy.fortran = order.substr(0, 4) == "True";
  if (!npy.fortran && order.substr(0, 5) != "False") return std::nullopt;
  if (shape.empty() || shape[0] != '(') return std::nullopt;
  const char *at = shape.data() + 1, *last = shape.data() + shape.size();
  for (;;) {
    while (at < last && (*at == ' ' || *at == ',')) ++at;
    if (at == last) return std::nullopt;
    if (*at == ')') return npy;
    std::int64_t n = 0;
    const auto [stop, code] = std::from_chars(at, last, n);
    if (code != std::errc() || n < 0 || npy.shape.size() == 32) return std::nullopt;
    npy.shape.push_back(n);
    at = stop;
  }
}

NpyArray read_npy_array(std::string_view bytes, const std::string& name) {
  const auto header = parse_npy_header(bytes);
  if (!header) throw InputError(name + ": the header is not that of a NumPy array", "bad-file");
  const std::string& type = header->type;
  NumberKind kind;
  std::int64_t size = 0;
  if (type.size() == 3) {
    kind.family = type[1] == 'b' ? 'u' : type[1];
    size = type[2] - '0';
  }
  const bool known = (kind.family == 'f' && (size == 2 || size == 4 || size == 8)) ||
                     ((kind.family == 'i' || kind.family == 'u') &&
                      (size == 1 || size == 2 || size == 4 || size == 8));
  if (!known || (type[0] != '<' && type[0] != '>' && type[0] != '|'))
    throw UnsupportedError(name + ": numbers of type " + in_quotes(type) +
                               "; floating-point numbers and integers are read",
                           "unsupported-file");
  kind.size = static_cast<std::size_t>(size);
  const std::size_t most = (bytes.size() - header->data) / kind.size;
  std::uint64_t count = 1;
  for (const std::int64_t n : header->shape) {
    if (n > 0 && count > most / static_cast<std::uint64_t>(n))
      throw InputError(name + ": the shape has more numbers than the file holds", "bad-file");
    count *= static_cast<std::uint64_t>(n);
  }
  if (count > most)
    throw InputError(name + ": a number without its bytes", "bad-file");  // shape ()
  const std::endian order = type[0] == '>' ? std::endian::big : std::endian::little;
  return {header->shape, header->fortran,
          load_numbers(bytes.substr(header->data), kind, static_cast<std::size_t>(count), order)};
}

Volume npy_volume(const NpyArray& array, const std::string& name) {
  if (array.shape.size() != 3)
    throw InputError(name + ": the array has " + std::to_string(array.shape.size()) +
                         " dimensions, a volume has 3",
                     "bad-file");
  const std::array<std::int64_t, 3> n{array.shape[0], array.shape[1], array.shape[2]};
  checked_nodes(n, static_cast<std::size_t>(array.numbers.size()), name);
  Volume volume;
  for (int k = 0; k < 3; ++k) volume.grid.n[k] = static_cast<int>(n[k]);
  if (array.fortran) {
    volume.values = array.numbers;
    return volume;
  }
  volume.values.resize(array.numbers.size());
  Eigen::Index from = 0;
  for (int i = 0; i < volume.grid.n[0]; ++i)
    for (int j = 0; j < volume.grid.n[1]; ++j)
      for (int k = 0; k < volume.grid.n[2]; ++k)
        volume.values[static_cast<Eigen::Index>(volume.grid.node(i, j, k))] = array.numbers[from++];
  return volume;
}

namespace {

/// The numbers of an array of N rows.
Eigen::MatrixXd npy_rows(const NpyArray& array, const std::string& expected,
                         std::initializer_list<std::int64_t> columns, const std::string& name) {
  if (array.shape.size() != 2 || std::ranges::find(columns, array.shape[1]) == columns.end()) {
    std::string shape;
    for (const std::int64_t n : array.shape)
      shape += (shape.empty() ? "" : " x ") + std::to_string(n);
    throw InputError(
        name + ": " + expected + ", this one is " + (shape.empty() ? "a number" : shape),
        "bad-file");
  }
  const Eigen::Index rows = array.shape[0], n = array.shape[1];
  if (rows == 0) throw InputError(name + ": no points", "bad-file");
  if (rows > std::numeric_limits<int>::max())
    throw InputError(name + ": more than 2147483647 points", "bad-file");
  if (array.fortran) return Eigen::Map<const Eigen::MatrixXd>(array.numbers.data(), rows, n);
  return Eigen::Map<const Rows<double, Eigen::Dynamic>>(array.numbers.data(), rows, n);
}

}  // namespace

PolygonSoup npy_cloud(const NpyArray& array, const std::string& name) {
  const Eigen::MatrixXd rows =
      npy_rows(array, "points are an array of N x 3, or N x 6 with normals", {3, 6}, name);
  PolygonSoup cloud;
  cloud.points = rows.leftCols(3);
  if (rows.cols() == 6) cloud.normals = rows.rightCols(3);
  return cloud;
}

MatX3 npy_points(const NpyArray& array, const std::string& name) {
  return npy_rows(array, "points are an array of N x 3", {3}, name);
}

Volume read_npy_volume(std::string_view bytes, const std::string& name, const std::string&) {
  return npy_volume(read_npy_array(bytes, name), name);
}

PolygonSoup read_npy_cloud(std::string_view bytes, const std::string& name) {
  return npy_cloud(read_npy_array(bytes, name), name);
}

Content read_npy(std::string_view bytes, const std::string& name, const std::string&) {
  const NpyArray array = read_npy_array(bytes, name);
  if (array.shape.size() == 2) return npy_cloud(array, name);
  return npy_volume(array, name);
}

PointTable read_npy_points(std::string_view bytes, const std::string& name) {
  return {npy_points(read_npy_array(bytes, name), name), {}};
}

void write_npy_volume(std::ostream& out, const Volume& volume, const VolumeWriteOptions&) {
  const auto& n = volume.grid.n;
  write_npy_header(
      out, std::to_string(n[0]) + ", " + std::to_string(n[1]) + ", " + std::to_string(n[2]), true);
  store_numbers(out, volume.values);
}

}  // namespace littoral::io
