#pragma once
// Tables of numbers, one row a point.

#include <filesystem>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "littoral/types.h"

namespace littoral::io {

/// Columns of numbers under names.
struct Table {
  std::vector<std::string> names;
  Eigen::MatrixXd columns;  // rows x names
  std::string rows_are{};   // "vertex": .csv files count the rows, from 0, in a first column
};

/// By extension. Throws UnsupportedError for formats of anything else, IoError naming the path.
void write_table(const std::filesystem::path& path, const Table& table);

/// A line of names, then rows; numbers as short as they read back the same.
void write_csv(std::ostream& out, const Table& table);
/// Rows of %.17g with blanks between.
void write_txt(std::ostream& out, const Table& table);
/// NumPy's format 1.0: float64, rows x columns, or one axis for one column.
void write_npy(std::ostream& out, const Table& table);
/// The head of such a file; `shape` as "8," or "2, 3, 4".
void write_npy_header(std::ostream& out, const std::string& shape, bool first_axis_fastest);

/// The first three numbers of each line, rows x 3; separated by commas, semicolons or blanks. A
/// first line of words is a head. Throws InputError naming the line.
MatX3 read_columns(std::string_view bytes, const std::string& name);

}  // namespace littoral::io
