// PLY, binary little endian.

#include <algorithm>
#include <array>
#include <string_view>

#include "base/index.h"
#include "io/binary.h"
#include "io/render/scene_style.h"
#include "io/surface/surface_writers.h"
#include "io/text_scan.h"
#include "littoral/error.h"

namespace littoral::io {
namespace {

constexpr std::array<const char*, 3> colour_names{"red", "green", "blue"};

std::size_t largest_face(const PolygonSoup& soup) {
  std::size_t largest = 0;
  for (int f = 0; f < soup.n_faces(); ++f) largest = std::max(largest, soup.face(f).size());
  return largest;
}

// A property's name is one word of a PLY header, and must not be one of those with a meaning.
void check_names(const PolygonSoup& soup) {
  for (const auto& [field, values] : soup.scalars) {
    const bool word = std::ranges::all_of(field, [](char c) { return c > ' ' && c <= '~'; });
    const std::array<std::string_view, 6> taken{"x", "y", "z", "nx", "ny", "nz"};
    if (word && !field.empty() && std::ranges::find(taken, field) == taken.end()) continue;
    throw UnsupportedError(
        "the scalar " + in_quotes(field) + " cannot be the name of a PLY property; rename it",
        "unsupported-file");
  }
}

/// Are there scalars of these names? Then nothing else is written as colours.
bool has_colour_names(const PolygonSoup& soup) {
  return std::ranges::any_of(colour_names,
                             [&](const char* name) { return soup.scalars.count(name) > 0; });
}

void write_header(std::ostream& out, const PolygonSoup& soup, bool small_faces, bool colours) {
  out << "ply\nformat binary_little_endian 1.0\ncomment written by littoral\n";
  out << "element vertex " << soup.n_vertices() << '\n';
  for (const char* name : {"x", "y", "z"}) out << "property double " << name << '\n';
  for (const char* name : {"nx", "ny", "nz"}) {
    if (soup.normals.rows() > 0) out << "property double " << name << '\n';
  }
  for (const auto& [name, values] : soup.scalars) out << "property double " << name << '\n';
  for (const char* name : colour_names)
    if (colours) out << "property uchar " << name << '\n';
  out << "element face " << soup.n_faces() << '\n';
  out << "property list " << (small_faces ? "uchar" : "int") << " int vertex_indices\n";
  if (!soup.lines.empty()) {
    std::size_t n_edges = 0;
    for (const auto& line : soup.lines) n_edges += line.size() - 1;
    out << "element edge " << n_edges << '\n';
    for (const char* name : {"vertex1", "vertex2", "line"}) out << "property int " << name << '\n';
  }
  out << "end_header\n";
}

void store_vertices(std::ostream& out, const PolygonSoup& soup, const std::vector<Rgb>& colours) {
  const bool normals = soup.normals.rows() > 0;
  const std::size_t size =
      sizeof(double) * ((normals ? 6 : 3) + soup.scalars.size()) + (colours.empty() ? 0 : 3);
  store_records(
      out, std::size_t(soup.n_vertices()), [size](std::size_t i) { return size * i; },
      [&](std::size_t i, char* to) {
        const auto v = index(i);
        for (int k = 0; k < 3; ++k) to = put_little(to, soup.points(v, k));
        for (int k = 0; k < 3 && normals; ++k) to = put_little(to, soup.normals(v, k));
        for (const auto& [name, values] : soup.scalars) to = put_little(to, values(v));
        if (colours.empty()) return;
        for (const unsigned char byte : colours[i]) to = put_little(to, byte);
      });
}

void store_faces(std::ostream& out, const PolygonSoup& soup, bool small_faces) {
  const std::size_t head = small_faces ? 1 : 4;  // bytes that count the corners
  store_records(
      out, std::size_t(soup.n_faces()),
      [&](std::size_t f) { return head * f + 4 * std::size_t(soup.face_offsets[f]); },
      [&](std::size_t f, char* to) {
        const auto face = soup.face(int(f));
        to = small_faces ? put_little(to, static_cast<std::uint8_t>(face.size()))
                         : put_little(to, static_cast<std::int32_t>(face.size()));
        for (const int v : face) to = put_little(to, static_cast<std::int32_t>(v));
      });
}

}  // namespace

void write_ply(std::ostream& out, const PolygonSoup& soup, const std::string& field) {
  check_names(soup);
  const auto shown = soup.scalars.find(field);
  std::vector<Rgb> colours;
  if (shown != soup.scalars.end() && !has_colour_names(soup))
    colours = value_colours(shown->second, field);
  const bool small_faces = largest_face(soup) <= 255;
  write_header(out, soup, small_faces, !colours.empty());
  store_vertices(out, soup, colours);
  store_faces(out, soup, small_faces);
  std::int32_t number = 0;
  for (const auto& line : soup.lines) {
    for (std::size_t k = 0; k + 1 < line.size(); ++k) {
      store_little(out, static_cast<std::int32_t>(line[k]));
      store_little(out, static_cast<std::int32_t>(line[k + 1]));
      store_little(out, number);
    }
    ++number;
  }
}

}  // namespace littoral::io
