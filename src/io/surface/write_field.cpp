// One scalar per vertex.

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "base/option_table.h"
#include "io/binary.h"
#include "io/formats.h"
#include "io/surface/surface_writers.h"
#include "io/text_scan.h"
#include "io/write.h"
#include "littoral/error.h"

namespace littoral::io {
namespace {

const VecX& find_field(const std::filesystem::path& path, const PolygonSoup& soup,
                       const std::string& field) {
  const auto found = soup.scalars.find(field);
  if (found != soup.scalars.end()) {
    if (found->second.size() == soup.points.rows()) return found->second;
    throw InputError("cannot write " + path.string() + ": " + std::to_string(found->second.size()) +
                         " values of '" + field + "' for " + std::to_string(soup.points.rows()) +
                         " points",
                     "cannot-write");
  }
  const std::string names = listed_names(soup.scalars);
  throw InputError("cannot write " + path.string() + ": there is no field " + in_quotes(field) +
                       (names.empty() ? "" : ", only " + names),
                   "cannot-write");
}

/// The field and, where there is one, its confidence.
Table table_of(const std::filesystem::path& path, const PolygonSoup& soup,
               const std::string& field) {
  const VecX& values = find_field(path, soup, field);
  if (field == "confidence" || !soup.scalars.contains("confidence"))
    return {{field}, values, "vertex"};
  Table table{{field, "confidence"}, Eigen::MatrixXd(values.size(), 2), "vertex"};
  table.columns << values, find_field(path, soup, "confidence");
  return table;
}

// Offsets (running ends) and corners of a set of cells, as VTK stores them.
struct Cells {
  std::vector<std::int64_t> connectivity, ends;
  template <class Range>
  void add(const Range& vertices) {
    connectivity.insert(connectivity.end(), vertices.begin(), vertices.end());
    ends.push_back(static_cast<std::int64_t>(connectivity.size()));
  }
};

}  // namespace

std::string xml_text(const std::string& plain) {
  std::string text;
  for (char c : plain) {
    if (c == '&') {
      text += "&amp;";
    } else if (c == '<') {
      text += "&lt;";
    } else if (c == '"') {
      text += "&quot;";
    } else {
      text += c;
    }
  }
  return text;
}

void AppendedArrays::announce(const char* type, const std::string& name, int components,
                              std::uint64_t bytes) {
  out_ << "<DataArray type=\"" << type << "\" Name=\"" << xml_text(name)
       << "\" NumberOfComponents=\"" << components << "\" format=\"appended\" offset=\"" << offset_
       << "\"/>\n";
  offset_ += sizeof(std::uint64_t) + bytes;
}

void write_vtp(std::ostream& out, const PolygonSoup& soup, const std::string& field) {
  Cells points_alone, lines, faces;
  for (int f = 0; f < soup.n_faces(); ++f) faces.add(soup.face(f));
  for (const auto& line : soup.lines) lines.add(line);
  if (soup.n_faces() == 0 && soup.lines.empty())  // of points alone a program of VTK shows these
    for (int v = 0; v < soup.n_vertices(); ++v) points_alone.add(std::array{v});
  std::vector<std::pair<const char*, const Cells*>> sets = {{"Lines", &lines}, {"Polys", &faces}};
  if (!points_alone.ends.empty()) sets.insert(sets.begin(), {"Verts", &points_alone});

  const bool normals = soup.normals.rows() > 0;
  AppendedArrays arrays(out);
  const auto cells = [&](const char* element, const Cells& set) {
    out << '<' << element << ">\n";
    arrays.announce("Int64", "connectivity", 1, 8 * set.connectivity.size());
    arrays.announce("Int64", "offsets", 1, 8 * set.ends.size());
    out << "</" << element << ">\n";
  };
  out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" "
         "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<PolyData>\n"
      << "<Piece NumberOfPoints=\"" << soup.n_vertices() << "\" NumberOfVerts=\""
      << points_alone.ends.size() << "\" NumberOfLines=\"" << soup.lines.size()
      << "\" NumberOfStrips=\"0\" NumberOfPolys=\"" << soup.n_faces() << "\">\n<PointData";
  if (soup.scalars.contains(field)) out << " Scalars=\"" << xml_text(field) << '"';
  if (normals) out << " Normals=\"Normals\"";
  out << ">\n";
  const auto points = std::size_t(soup.n_vertices());
  if (normals) arrays.announce("Float64", "Normals", 3, 24 * points);
  for (const auto& [name, values] : soup.scalars) arrays.announce("Float64", name, 1, 8 * points);
  out << "</PointData>\n<Points>\n";
  arrays.announce("Float64", "Points", 3, 24 * points);
  out << "</Points>\n";
  for (const auto& [element, set] : sets) cells(element, *set);
  out << "</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_";

  const auto block = [&](const auto* data, std::size_t count) {
    store_little(out, static_cast<std::uint64_t>(8 * count));
    store_all_little(out, std::span(data, count));
  };
  if (normals) block(soup.normals.data(), 3 * points);
  for (const auto& [name, values] : soup.scalars) block(values.data(), points);
  block(soup.points.data(), 3 * points);
  for (const auto& [element, set] : sets) {
    block(set->connectivity.data(), set->connectivity.size());
    block(set->ends.data(), set->ends.size());
  }
  out << "\n</AppendedData>\n</VTKFile>\n";
}

void write_field(const std::filesystem::path& path, const PolygonSoup& soup,
                 const std::string& field) {
  find_field(path, soup, field);
  for (const auto& [name, values] : soup.scalars) find_field(path, soup, name);
  const Format& format = format_to_write(path, {Kind::field});
  if (format.write_table) return write_table(path, table_of(path, soup, field));
  if (format.write_surface) return write_surface(path, soup, field);
  write_atomically(path, [&](std::ostream& out) { format.write_field(out, soup, field); });
}

}  // namespace littoral::io
