// Tets with a field, as VTK's legacy and XML files.

#include <cstdint>

#include "io/binary.h"
#include "io/formats.h"
#include "io/surface/surface_writers.h"
#include "io/tet/tet_formats.h"
#include "io/text_scan.h"
#include "io/write.h"
#include "littoral/error.h"

namespace littoral::io {

namespace {

constexpr std::int32_t tet_type = 10;

template <class T>
void store_big(std::ostream& out, T value) {
  auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if (std::endian::native != std::endian::big) std::reverse(bytes.begin(), bytes.end());
  out.write(bytes.data(), sizeof(T));
}

/// A name without blanks, as legacy files need it.
std::string one_word(std::string name) {
  for (char& c : name)
    if (is_blank(c) || c == '\n' || c == '\r') c = '_';
  return name.empty() ? "field" : name;
}

}  // namespace

void write_vtk(std::ostream& out, const TetMesh& mesh, const VecX& values,
               const std::string& field) {
  out << "# vtk DataFile Version 3.0\ndistance by littoral\nBINARY\nDATASET UNSTRUCTURED_GRID\n"
      << "POINTS " << mesh.n_vertices() << " double\n";
  for (const double x : mesh.points.reshaped<Eigen::RowMajor>()) store_big(out, x);
  out << "\nCELLS " << mesh.n_tets() << ' ' << 5 * std::int64_t{mesh.n_tets()} << '\n';
  for (const auto& tet : mesh.tets.rowwise()) {
    store_big(out, std::int32_t{4});
    for (const int v : tet) store_big(out, std::int32_t{v});
  }
  out << "\nCELL_TYPES " << mesh.n_tets() << '\n';
  for (int t = 0; t < mesh.n_tets(); ++t) store_big(out, tet_type);
  out << "\nPOINT_DATA " << mesh.n_vertices() << "\nSCALARS " << one_word(field)
      << " double 1\nLOOKUP_TABLE default\n";
  for (const double x : values) store_big(out, x);
  out << '\n';
}

void write_vtu(std::ostream& out, const TetMesh& mesh, const VecX& values,
               const std::string& field) {
  const auto n = static_cast<std::uint64_t>(mesh.n_vertices());
  const auto tets = static_cast<std::uint64_t>(mesh.n_tets());
  out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
         "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<UnstructuredGrid>\n"
      << "<Piece NumberOfPoints=\"" << n << "\" NumberOfCells=\"" << tets << "\">\n";
  AppendedArrays arrays(out);
  out << "<PointData Scalars=\"" << xml_text(field) << "\">\n";
  arrays.announce("Float64", field, 1, 8 * n);
  out << "</PointData>\n<Points>\n";
  arrays.announce("Float64", "Points", 3, 24 * n);
  out << "</Points>\n<Cells>\n";
  arrays.announce("Int32", "connectivity", 1, 16 * tets);
  arrays.announce("Int64", "offsets", 1, 8 * tets);
  arrays.announce("UInt8", "types", 1, tets);
  out << "</Cells>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_";
  store_little(out, 8 * n);
  store_all_little(out, values);
  store_little(out, 24 * n);
  store_all_little(out, mesh.points);
  store_little(out, 16 * tets);
  store_all_little(out, mesh.tets);
  store_little(out, 8 * tets);
  for (std::uint64_t t = 1; t <= tets; ++t) store_little(out, static_cast<std::int64_t>(4 * t));
  store_little(out, tets);
  for (std::uint64_t t = 0; t < tets; ++t) out.put(static_cast<char>(tet_type));
  out << "\n</AppendedData>\n</VTKFile>\n";
}

void write_tets(const std::filesystem::path& path, const TetMesh& mesh, const VecX& values,
                const std::string& field) {
  if (values.size() != mesh.n_vertices())
    throw InputError("cannot write " + path.string() + ": " + std::to_string(values.size()) +
                         " values for " + std::to_string(mesh.n_vertices()) + " vertices",
                     "cannot-write");
  const Format& format = format_to_write(path, {Kind::tets});
  write_atomically(path, [&](std::ostream& out) { format.write_tets(out, mesh, values, field); });
}

}  // namespace littoral::io
