// Wavefront OBJ.

#include <algorithm>
#include <limits>
#include <span>

#include "base/counted.h"
#include "base/index.h"
#include "io/surface/surface_formats.h"
#include "io/text_scan.h"
#include "littoral/error.h"

namespace littoral::io {
namespace {

constexpr int none = -1;

// The record as it was written, before indices into later vertices can be checked.
struct ObjFile {
  std::vector<double> positions, textures, normals;  // 3, 1 and 3 numbers each
  std::vector<int> offsets{0}, corners, corner_texture, corner_normal;
  std::vector<std::size_t> face_line, polyline_line;
  std::vector<std::vector<int>> polylines;

  std::size_t n_vertices() const { return positions.size() / 3; }
};

// A 1-based index, or one counted back from the `count` records so far, as a 0-based one.
int resolve(const LineScanner& scan, std::string_view word, std::size_t count, const char* record,
            const char* what) {
  const auto index = parse_integer(word);
  if (!index) scan.fail(std::string("expected a ") + what + " index, found " + in_quotes(word));
  const auto refers = [&] {
    return std::string(record) + " refers to " + what + " " + std::to_string(*index);
  };
  if (*index == 0) scan.fail(refers() + ", but OBJ counts from 1");
  if (*index < 0) {
    if (*index < -static_cast<std::int64_t>(count)) {
      scan.fail(refers() + ", only " + std::to_string(count) + " come before it");
    }
    return static_cast<int>(static_cast<std::int64_t>(count) + *index);
  }
  if (*index > std::numeric_limits<int>::max()) scan.fail(refers() + ", which is out of range");
  return static_cast<int>(*index - 1);
}

// A corner: v, v/vt, v//vn or v/vt/vn.
void read_corner(const LineScanner& scan, std::string_view word, ObjFile& file) {
  const std::size_t first = std::min(word.find('/'), word.size());
  file.corners.push_back(resolve(scan, word.substr(0, first), file.n_vertices(), "face", "vertex"));
  int texture = none, normal = none;
  if (first < word.size()) {
    const std::string_view rest = word.substr(first + 1);
    const std::size_t second = std::min(rest.find('/'), rest.size());
    if (second > 0) {
      texture = resolve(scan, rest.substr(0, second), file.textures.size(), "face", "texture");
    }
    if (second + 1 < rest.size()) {
      normal = resolve(scan, rest.substr(second + 1), file.normals.size() / 3, "face", "normal");
    }
  }
  file.corner_texture.push_back(texture);
  file.corner_normal.push_back(normal);
}

void read_face(LineScanner& scan, ObjFile& file) {
  int degree = 0;
  for (std::string_view word = scan.word(); !word.empty(); word = scan.word(), ++degree) {
    read_corner(scan, word, file);
  }
  if (degree < 3) {
    scan.fail("face has " + counted(degree, "corner", "corners") + ", at least 3 are needed");
  }
  file.offsets.push_back(static_cast<int>(file.corners.size()));
  file.face_line.push_back(scan.line());
}

void read_polyline(LineScanner& scan, ObjFile& file) {
  std::vector<int> line;
  for (std::string_view word = scan.word(); !word.empty(); word = scan.word()) {
    const std::string_view vertex = word.substr(0, word.find('/'));
    line.push_back(resolve(scan, vertex, file.n_vertices(), "line", "vertex"));
  }
  if (line.size() < 2) {
    scan.fail("line has " + counted(line.size(), "vertex", "vertices") + ", at least 2 are needed");
  }
  file.polylines.push_back(std::move(line));
  file.polyline_line.push_back(scan.line());
}

ObjFile parse(LineScanner& scan) {
  constexpr std::size_t most = std::numeric_limits<int>::max();
  ObjFile file;
  while (scan.next()) {
    const std::string_view record = scan.word();
    if (record == "v") {
      for (int k = 0; k < 3; ++k) file.positions.push_back(scan.number("a coordinate"));
    } else if (record == "vt") {
      file.textures.push_back(scan.number("a texture coordinate"));
    } else if (record == "vn") {
      for (int k = 0; k < 3; ++k) file.normals.push_back(scan.number("a normal's coordinate"));
    } else if (record == "f") {
      read_face(scan, file);
    } else if (record == "l") {
      read_polyline(scan, file);
    }
    if (file.positions.size() / 3 > most || file.corners.size() > most) {
      scan.fail("more than 2147483647 vertices or corners");
    }
  }
  return file;
}

void check_range(const LineScanner& scan, const ObjFile& file) {
  const int n = static_cast<int>(file.n_vertices());
  const auto check = [&](int vertex, std::size_t line, const char* record) {
    if (vertex < n) return;
    scan.fail_at(line, std::string(record) + " refers to vertex " + std::to_string(vertex + 1LL) +
                           ", the file has " + std::to_string(n));
  };
  for (std::size_t f = 0; f < file.face_line.size(); ++f) {
    for (int c = file.offsets[f]; c < file.offsets[f + 1]; ++c) {
      check(file.corners[c], file.face_line[f], "face");
    }
  }
  for (std::size_t i = 0; i < file.polylines.size(); ++i) {
    for (int v : file.polylines[i]) check(v, file.polyline_line[i], "line");
  }
}

// Values that corners refer to, as one value per vertex; empty unless every vertex has exactly one.
// A vertex that no corner speaks for takes the value of its own number where there are as many
// values as vertices (point clouds and our own files are written so). References to missing values
// say nothing: exporters leave them behind when they strip textures, and the geometry is sound.
std::vector<double> per_vertex(const ObjFile& file, const std::vector<int>& refs,
                               const std::vector<double>& values, std::size_t width) {
  const std::size_t n = file.n_vertices(), count = values.size() / width;
  if (count == 0) return {};
  std::vector<int> chosen(n, none);
  const auto value = [&](int r) {
    return std::span(values).subspan(std::size_t(r) * width, width);
  };
  for (std::size_t c = 0; c < refs.size(); ++c) {
    if (refs[c] == none || std::size_t(refs[c]) >= count) continue;
    int& slot = chosen[file.corners[c]];
    if (slot == none) slot = refs[c];
    if (slot != refs[c] && !std::ranges::equal(value(slot), value(refs[c]))) return {};
  }
  std::vector<double> result;
  result.reserve(n * width);
  for (std::size_t v = 0; v < n; ++v) {
    if (chosen[v] == none && count != n) return {};
    const auto found = value(chosen[v] == none ? static_cast<int>(v) : chosen[v]);
    result.insert(result.end(), found.begin(), found.end());
  }
  return result;
}

}  // namespace

PolygonSoup read_obj(std::string_view bytes, const std::string& name) {
  LineScanner scan(without_byte_order_mark(bytes, name), name, '#', true);
  ObjFile file = parse(scan);
  if (file.n_vertices() == 0) throw InputError(name + ": no vertices", "bad-file");
  check_range(scan, file);

  PolygonSoup soup;
  const auto n = index(file.n_vertices());
  soup.points = Eigen::Map<const MatX3>(file.positions.data(), n, 3);
  const auto normals = per_vertex(file, file.corner_normal, file.normals, 3);
  if (!normals.empty()) soup.normals = Eigen::Map<const MatX3>(normals.data(), n, 3);
  const auto u = per_vertex(file, file.corner_texture, file.textures, 1);
  if (!u.empty()) soup.scalars["u"] = Eigen::Map<const VecX>(u.data(), n);
  soup.face_offsets = std::move(file.offsets);
  soup.corners = std::move(file.corners);
  soup.lines = std::move(file.polylines);
  return soup;
}

}  // namespace littoral::io
