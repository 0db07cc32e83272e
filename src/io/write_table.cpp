#include "io/write_table.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <sstream>

#include "io/binary.h"
#include "io/text_scan.h"
#include "io/write.h"
#include "littoral/error.h"

namespace littoral::io {

namespace {

void write_rows(std::ostream& out, const Eigen::MatrixXd& columns, char between) {
  char text[32];
  for (Eigen::Index r = 0; r < columns.rows(); ++r)
    for (Eigen::Index c = 0; c < columns.cols(); ++c) {
      std::snprintf(text, sizeof text, "%.17g", columns(r, c));
      out << text << (c + 1 < columns.cols() ? between : '\n');
    }
}

void write_npy(std::ostream& out, const Eigen::MatrixXd& columns) {
  std::ostringstream text;
  text << "{'descr': '<f8', 'fortran_order': True, 'shape': (" << columns.rows() << ",";
  if (columns.cols() > 1) text << " " << columns.cols();
  text << "), }";
  std::string header = text.str();
  const std::size_t over = (header.size() + 11) % 64;  // with the ten bytes before and the newline
  if (over > 0) header.append(64 - over, ' ');
  header += '\n';
  out.write("\x93NUMPY\x01\x00", 8);
  store_little(out, static_cast<std::uint16_t>(header.size()));
  out << header;
  for (const double value : columns.reshaped()) store_little(out, value);
}

}  // namespace

void write_table(const std::filesystem::path& path, const std::vector<std::string>& names,
                 const Eigen::MatrixXd& columns) {
  const std::string format = lower_case(path.extension().string());
  if (format != ".csv" && format != ".txt" && format != ".npy")
    throw UnsupportedError(path.string() + ": unknown format " + in_quotes(format) +
                           " for a table; .csv, .txt and .npy are written");
  write_atomically(path, [&](std::ostream& out) {
    if (format == ".npy") return write_npy(out, columns);
    if (format == ".csv")
      for (std::size_t c = 0; c < names.size(); ++c)
        out << names[c] << (c + 1 < names.size() ? ',' : '\n');
    write_rows(out, columns, format == ".csv" ? ',' : ' ');
  });
}

MatX3 read_columns(std::string_view bytes, const std::string& name) {
  std::string text(bytes);
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == ',' || c == ';'; }, ' ');
  LineScanner scan(text, name, '#');
  std::vector<double> numbers;
  for (bool first = true; scan.next(); first = false) {
    const std::string_view word = scan.word();
    const auto x = parse_double(word);
    if (!x && first) continue;
    if (!x) scan.fail("expected a number, found " + in_quotes(word));
    numbers.push_back(*x);
    numbers.push_back(scan.number("y"));
    numbers.push_back(scan.number("z"));
  }
  if (numbers.empty()) throw InputError(name + ": no points");
  return Eigen::Map<const MatX3>(numbers.data(), static_cast<Eigen::Index>(numbers.size() / 3), 3);
}

}  // namespace littoral::io
