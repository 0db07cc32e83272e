// One scalar per vertex.

#include <array>
#include <cstdint>
#include <cstdio>

#include "io/binary.h"
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
                     " points");
  }
  std::string names;
  for (const auto& [name, values] : soup.scalars) names += (names.empty() ? "" : ", ") + name;
  throw InputError("cannot write " + path.string() + ": there is no field " + in_quotes(field) +
                   (names.empty() ? "" : ", only " + names));
}

void write_txt(std::ostream& out, const VecX& values) {
  std::array<char, 32> text;
  for (double value : values) {
    std::snprintf(text.data(), text.size(), "%.17g\n", value);
    out << text.data();
  }
}

// A name as a CSV cell: quoted where it holds a comma, a quote or a line end.
std::string csv_cell(const std::string& name) {
  if (name.find_first_of(",\"\r\n") == std::string::npos) return name;
  std::string cell = "\"";
  for (char c : name) cell += c == '"' ? std::string("\"\"") : std::string(1, c);
  return cell + '"';
}

void write_csv(std::ostream& out, const VecX& values, const std::string& field) {
  out << "vertex," << csv_cell(field) << '\n';
  for (Eigen::Index v = 0; v < values.size(); ++v) out << v << ',' << exact_text(values(v)) << '\n';
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

void write_npy_header(std::ostream& out, const std::string& shape, bool first_axis_fastest) {
  std::string header = std::string("{'descr': '<f8', 'fortran_order': ") +
                       (first_axis_fastest ? "True" : "False") + ", 'shape': (" + shape + "), }";
  // Magic, version and length take 10 bytes; the data begin at a multiple of 64.
  header.append(63 - (10 + header.size()) % 64, ' ').push_back('\n');
  out.write("\x93NUMPY\x01\x00", 8);
  store_little(out, static_cast<std::uint16_t>(header.size()));
  out << header;
}

void write_npy(std::ostream& out, const VecX& values) {
  write_npy_header(out, std::to_string(values.size()) + ",", false);
  for (double value : values) store_little(out, value);
}

void write_vtp(std::ostream& out, const PolygonSoup& soup, const std::string& field) {
  Cells faces, lines;
  for (int f = 0; f < soup.n_faces(); ++f) faces.add(soup.face(f));
  for (const auto& line : soup.lines) lines.add(line);
  const VecX& values = soup.scalars.at(field);

  AppendedArrays arrays(out);
  const auto cells = [&](const char* element, const Cells& set) {
    out << '<' << element << ">\n";
    arrays.announce("Int64", "connectivity", 1, 8 * set.connectivity.size());
    arrays.announce("Int64", "offsets", 1, 8 * set.ends.size());
    out << "</" << element << ">\n";
  };
  out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" "
         "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<PolyData>\n"
      << "<Piece NumberOfPoints=\"" << soup.n_vertices()
      << "\" NumberOfVerts=\"0\" NumberOfLines=\"" << soup.lines.size()
      << "\" NumberOfStrips=\"0\" NumberOfPolys=\"" << soup.n_faces()
      << "\">\n<PointData Scalars=\"" << xml_text(field) << "\">\n";
  const auto points = static_cast<std::size_t>(soup.n_vertices());
  arrays.announce("Float64", field, 1, 8 * points);
  out << "</PointData>\n<Points>\n";
  arrays.announce("Float64", "Points", 3, 24 * points);
  out << "</Points>\n";
  cells("Lines", lines);
  cells("Polys", faces);
  out << "</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_";

  const auto block = [&](const auto* data, std::size_t count) {
    store_little(out, static_cast<std::uint64_t>(8 * count));
    for (std::size_t i = 0; i < count; ++i) store_little(out, data[i]);
  };
  block(values.data(), points);
  block(soup.points.data(), 3 * points);
  for (const Cells* set : {&lines, &faces}) {
    block(set->connectivity.data(), set->connectivity.size());
    block(set->ends.data(), set->ends.size());
  }
  out << "\n</AppendedData>\n</VTKFile>\n";
}

void write_field(const std::filesystem::path& path, const PolygonSoup& soup,
                 const std::string& field) {
  const VecX& values = find_field(path, soup, field);
  const std::string format = lower_case(path.extension().string());
  const auto write = [&](const auto& body) { write_atomically(path, body); };
  if (format == ".txt") {
    write([&](std::ostream& out) { write_txt(out, values); });
  } else if (format == ".csv") {
    write([&](std::ostream& out) { write_csv(out, values, field); });
  } else if (format == ".npy") {
    write([&](std::ostream& out) { write_npy(out, values); });
  } else if (format == ".vtp") {
    write([&](std::ostream& out) { write_vtp(out, soup, field); });
  } else if (format == ".obj" || format == ".ply") {
    write_surface(path, soup, field);
  } else {
    throw UnsupportedError("cannot write " + path.string() + ": " + in_quotes(format) +
                           " holds no field; .csv, .npy, .obj, .ply, .txt and .vtp do");
  }
}

}  // namespace littoral::io
