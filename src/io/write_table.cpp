#include "io/write_table.h"

#include <algorithm>
#include <cstdint>

#include "io/binary.h"
#include "io/formats.h"
#include "io/surface/surface_writers.h"
#include "io/text_scan.h"
#include "io/write.h"
#include "littoral/error.h"

namespace littoral::io {

namespace {

/// A name as a cell: quoted where it holds a separator, a quote or a line end.
std::string csv_cell(const std::string& name) {
  if (name.find_first_of(",\t\"\r\n") == std::string::npos) return name;
  std::string cell = "\"";
  for (char c : name) cell += c == '"' ? std::string("\"\"") : std::string(1, c);
  return cell + '"';
}

/// Of what the rows are at: a table that was written before has its results replaced.
std::vector<const PointColumn*> columns_kept(const Table& table) {
  std::vector<const PointColumn*> kept;
  if (!table.at) return kept;
  for (const PointColumn& column : table.at->columns)
    if (std::ranges::find(table.names, column.name) == table.names.end()) kept.push_back(&column);
  return kept;
}

void write_separated(std::ostream& out, const Table& table, char separator) {
  const Eigen::MatrixXd& x = table.columns;
  const std::vector<const PointColumn*> kept = columns_kept(table);
  if (!table.rows_are.empty()) out << table.rows_are << separator;
  for (const PointColumn* column : kept) out << csv_cell(column->name) << separator;
  for (std::size_t c = 0; c < table.names.size(); ++c)
    out << csv_cell(table.names[c]) << (c + 1 < table.names.size() ? separator : '\n');
  for (Eigen::Index r = 0; r < x.rows(); ++r) {
    if (!table.rows_are.empty()) out << r << separator;
    for (const PointColumn* column : kept)
      out << (column->axis == PointColumn::no_axis ? csv_cell(column->cells[r])
                                                   : exact_text(table.at->points(r, column->axis)))
          << separator;
    for (Eigen::Index c = 0; c < x.cols(); ++c)
      out << exact_text(x(r, c)) << (c + 1 < x.cols() ? separator : '\n');
  }
}

}  // namespace

void write_csv(std::ostream& out, const Table& table) { write_separated(out, table, ','); }
void write_tsv(std::ostream& out, const Table& table) { write_separated(out, table, '\t'); }

void write_txt(std::ostream& out, const Table& table) {
  const Eigen::MatrixXd& x = table.columns;
  for (Eigen::Index r = 0; r < x.rows(); ++r)
    for (Eigen::Index c = 0; c < x.cols(); ++c)
      out << exact_text(x(r, c)) << (c + 1 < x.cols() ? ' ' : '\n');
}

void write_npy_header(std::ostream& out, const std::string& shape, bool first_axis_fastest,
                      const std::string& type) {
  std::string header = "{'descr': '" + type + "', 'fortran_order': ";
  header.append(first_axis_fastest ? "True" : "False").append(", 'shape': (" + shape + "), }");
  // Magic, version and length take 10 bytes; the data begin at a multiple of 64.
  header.append(63 - (10 + header.size()) % 64, ' ').push_back('\n');
  out.write("\x93NUMPY\x01\x00", 8);
  store_little(out, static_cast<std::uint16_t>(header.size()));
  out << header;
}

void write_npy(std::ostream& out, const Table& table) {
  const Eigen::MatrixXd& x = table.columns;
  const bool one = x.cols() == 1;
  write_npy_header(
      out, std::to_string(x.rows()) + "," + (one ? "" : " " + std::to_string(x.cols())), !one);
  store_all_little(out, x);
}

void write_table(const std::filesystem::path& path, const Table& table) {
  const Format& format = format_to_write(path, {Kind::table});
  write_atomically(path, [&](std::ostream& out) { format.write_table(out, table); });
}

}  // namespace littoral::io
