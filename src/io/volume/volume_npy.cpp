// NumPy arrays of three dimensions.

#include <algorithm>
#include <charconv>
#include <limits>

#include "base/index.h"
#include "io/any_formats.h"
#include "io/binary.h"
#include "io/surface/surface_formats.h"
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

/// What stands between quotes at the beginning of a text.
std::optional<std::string> quoted(std::string_view text) {
  if (text.size() < 2 || (text[0] != '\'' && text[0] != '"')) return std::nullopt;
  const std::size_t end = text.find(text[0], 1);
  if (end == std::string_view::npos) return std::nullopt;
  return std::string(text.substr(1, end - 1));
}

void skip(std::string_view& text, std::string_view marks) {
  text.remove_prefix(std::min(text.find_first_not_of(marks), text.size()));
}

/// The number of bytes of "<f8", "|S5" or "<U5"; 0 for what is none of these.
std::size_t bytes_of_type(const std::string& type) {
  std::size_t size = 0;
  if (type.size() < 3 || type.size() > 9) return 0;
  const auto [end, code] = std::from_chars(type.data() + 2, type.data() + type.size(), size);
  if (code != std::errc() || end != type.data() + type.size()) return 0;
  return type[1] == 'U' ? 4 * size : size;
}

/// Records: [('x', '<f8'), ('normal', '<f4', (3,))].
bool read_fields(std::string_view descr, NpyHeader& npy) {
  constexpr std::int64_t most_numbers = 1'000'000;       // of a field
  constexpr std::size_t largest_record = 1'000'000'000;  // bytes
  descr.remove_prefix(1);
  while (true) {
    skip(descr, " ,");
    if (descr.starts_with(']')) return !npy.fields.empty();
    if (!descr.starts_with('(')) return false;
    descr.remove_prefix(1);
    NpyField field;
    for (std::string* part : {&field.name, &field.type}) {
      skip(descr, " ,");
      const auto text = quoted(descr);
      if (!text) return false;
      *part = *text;
      descr.remove_prefix(text->size() + 2);
    }
    skip(descr, " ,");
    if (descr.starts_with('(')) {
      for (skip(descr, "( ,"); !descr.starts_with(')'); skip(descr, " ,")) {
        std::int64_t n = 0;
        const auto [stop, code] = std::from_chars(descr.data(), descr.data() + descr.size(), n);
        if (code != std::errc() || n < 1 || n > most_numbers / field.count) return false;
        field.count *= n;
        descr.remove_prefix(std::size_t(stop - descr.data()));
      }
      descr.remove_prefix(1);
      skip(descr, " ,");
    }
    if (!descr.starts_with(')')) return false;
    descr.remove_prefix(1);
    const std::size_t size = bytes_of_type(field.type);
    if (size == 0) return false;
    field.at = npy.record;
    npy.record += size * std::size_t(field.count);
    if (npy.record > largest_record) return false;
    npy.fields.push_back(std::move(field));
  }
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
  if (descr.starts_with('[')) {
    if (!read_fields(descr, npy)) return std::nullopt;
  } else if (const auto type = quoted(descr)) {
    npy.type = *type;
  } else {
    return std::nullopt;
  }
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

namespace {

NumberKind number_kind(const std::string& type, const std::string& name) {
  NumberKind kind;
  kind.family = type.size() != 3 ? '?' : type[1] == 'b' ? 'u' : type[1];
  kind.size = type.size() != 3 ? 0 : std::size_t(type[2] - '0');
  const bool real = kind.family == 'f', whole = kind.family == 'i' || kind.family == 'u';
  const bool known =
      (real && (kind.size == 2 || kind.size == 4 || kind.size == 8)) ||
      (whole && (kind.size == 1 || kind.size == 2 || kind.size == 4 || kind.size == 8));
  if (!known || (type[0] != '<' && type[0] != '>' && type[0] != '|'))
    throw UnsupportedError(name + ": numbers of type " + in_quotes(type) +
                               "; floating-point numbers and integers are read",
                           "unsupported-file");
  return kind;
}

std::endian order_of(const std::string& type) {
  return type[0] == '>' ? std::endian::big : std::endian::little;
}

/// How many items of this size the shape asks for; no more than the file holds.
std::size_t checked_count(const NpyHeader& header, std::size_t held, std::size_t size,
                          const std::string& name) {
  const std::size_t most = held / size;
  std::uint64_t count = 1;
  for (const std::int64_t n : header.shape) {
    if (n > 0 && count > most / static_cast<std::uint64_t>(n))
      throw InputError(name + ": the shape has more numbers than the file holds", "bad-file");
    count *= static_cast<std::uint64_t>(n);
  }
  if (count > most)
    throw InputError(name + ": a number without its bytes", "bad-file");  // shape ()
  return count;
}

/// The fields with these names, or the one of three numbers; none where one is missing.
std::vector<NpyField> named_fields(const NpyHeader& header, const std::vector<std::string>& names,
                                   const std::vector<std::string>& whole) {
  std::vector<NpyField> found;
  for (const std::string& name : names)
    for (const NpyField& field : header.fields)
      if (field.count == 1 && lower_case(field.name) == name) found.push_back(field);
  if (found.size() == 3) return found;
  for (const NpyField& field : header.fields)
    if (field.count == 3 && std::ranges::find(whole, lower_case(field.name)) != whole.end()) {
      found.assign(3, field);
      for (std::size_t d = 0; d < 3; ++d) found[d].at += d * bytes_of_type(field.type);
      return found;
    }
  return {};
}

/// The fields of a row of points; none unless there is one axis of them.
std::vector<NpyField> point_fields(const NpyHeader& header) {
  if (header.shape.size() != 1) return {};
  return named_fields(header, {"x", "y", "z"}, {"xyz", "point", "points", "position", "positions"});
}

/// Points of records, N x 3 or, with normals, N x 6.
NpyArray points_of_records(const NpyHeader& header, std::string_view bytes,
                           const std::string& name) {
  std::vector<NpyField> fields = point_fields(header);
  if (fields.empty()) {
    std::string names;
    for (const NpyField& field : header.fields) names += (names.empty() ? "" : ", ") + field.name;
    throw UnsupportedError(name + ": records with the fields " + names +
                               "; of records, one axis with the fields x, y, z is read as points",
                           "unsupported-file");
  }
  for (NpyField& field : named_fields(header, {"nx", "ny", "nz"}, {"normal", "normals"}))
    fields.push_back(std::move(field));
  const std::size_t rows = checked_count(header, bytes.size(), header.record, name);
  NpyArray points;
  points.of_records = true;
  const auto columns = static_cast<std::int64_t>(fields.size());
  points.shape = {static_cast<std::int64_t>(rows), columns};
  points.numbers.resize(index(rows * fields.size()));
  for (std::size_t c = 0; c < fields.size(); ++c) {
    const NumberKind kind = number_kind(fields[c].type, name);
    std::string column;
    column.reserve(rows * kind.size);
    for (std::size_t r = 0; r < rows; ++r)
      column.append(bytes.substr(r * header.record + fields[c].at, kind.size));
    const VecX numbers = load_numbers(column, kind, rows, order_of(fields[c].type));
    for (std::size_t r = 0; r < rows; ++r)
      points.numbers[index(r * fields.size() + c)] = numbers[index(r)];
  }
  return points;
}

}  // namespace

bool is_read_as_numbers(const NpyHeader& header) {
  constexpr std::string_view families = "fiub";
  if (!header.fields.empty()) return !point_fields(header).empty();
  return header.type.size() > 1 && families.find(header.type[1]) != std::string_view::npos;
}

NpyArray read_npy_array(std::string_view bytes, const std::string& name) {
  const auto header = parse_npy_header(bytes);
  if (!header) throw InputError(name + ": the header is not that of a NumPy array", "bad-file");
  const std::string_view data = bytes.substr(header->data);
  if (!header->fields.empty()) return points_of_records(*header, data, name);
  const NumberKind kind = number_kind(header->type, name);
  const std::size_t count = checked_count(*header, data.size(), kind.size, name);
  return {header->shape, header->fortran, load_numbers(data, kind, count, order_of(header->type))};
}

Volume npy_volume(const NpyArray& array, const std::string& name) {
  if (array.shape.size() != 3)
    throw InputError(name + ": the array has " + std::to_string(array.shape.size()) +
                         " dimensions, a volume has 3",
                     "bad-file");
  const std::array<std::int64_t, 3> n{array.shape[0], array.shape[1], array.shape[2]};
  checked_nodes(n, std::size_t(array.numbers.size()), name);
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
        volume.values[index(volume.grid.node(i, j, k))] = array.numbers[from++];
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
    const bool lies = array.shape.size() == 2 && array.shape[0] == 3 && array.shape[1] != 3;
    throw InputError(name + ": " + expected + ", this one is " +
                         (shape.empty() ? "a number" : shape) +
                         (lies ? ": transpose it, as array.T does" : ""),
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
  if (rows.cols() == 6 && (array.of_records || !are_colours(rows.rightCols(3))))
    cloud.normals = rows.rightCols(3);
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
  return {npy_points(read_npy_array(bytes, name), name)};
}

void write_npy_volume(std::ostream& out, const Volume& volume, const VolumeWriteOptions&) {
  const auto& n = volume.grid.n;
  write_npy_header(
      out, std::to_string(n[0]) + ", " + std::to_string(n[1]) + ", " + std::to_string(n[2]), true);
  store_numbers(out, volume.values);
}

}  // namespace littoral::io
