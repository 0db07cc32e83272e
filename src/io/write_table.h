#pragma once
// Tables of numbers, one row a point.

#include <filesystem>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "littoral/types.h"

namespace littoral::io {

/// A column of a table of points: one of their coordinates, or cells that are passed on.
struct PointColumn {
  static constexpr int no_axis = -1;
  std::string name;
  int axis = no_axis;
  std::vector<std::string> cells{};  // as they were read; none of coordinates
};

/// Points, and the columns of the table that they were in, in its order.
struct PointTable {
  MatX3 points{0, 3};
  std::vector<PointColumn> columns{{"x", 0}, {"y", 1}, {"z", 2}};
};

/// Columns of numbers under names.
struct Table {
  std::vector<std::string> names;
  Eigen::MatrixXd columns;  // rows x names
  std::string rows_are{};   // "vertex": .csv files count the rows, from 0, in a first column
  /// Where the rows are: .csv and .tsv files have these columns first, but those that have a name
  /// of the table's own; .npz files have the points.
  const PointTable* at = nullptr;
};

/// By extension. Throws UnsupportedError for formats of anything else, IoError naming the path.
void write_table(const std::filesystem::path& path, const Table& table);

/// A line of names, then rows; numbers as short as they read back the same.
void write_csv(std::ostream& out, const Table& table);
/// The same with tabs between.
void write_tsv(std::ostream& out, const Table& table);
/// Rows of %.17g with blanks between.
void write_txt(std::ostream& out, const Table& table);
/// NumPy's format 1.0: float64, rows x columns, or one axis for one column.
void write_npy(std::ostream& out, const Table& table);
/// The head of such a file; `shape` as "8," or "2, 3, 4", `type` as "<f8".
void write_npy_header(std::ostream& out, const std::string& shape, bool first_axis_fastest,
                      const std::string& type = "<f8");

/// A table of points: rows of cells between commas, semicolons, tabs or blanks. A first row that
/// is no number names the columns, and x, y, z (or Px, Py, Pz; Points:0, Points:1, Points:2 of
/// ParaView; pos_x, pos_y, pos_z) are the points; without one there are three columns. Throws
/// InputError naming the line, and for other columns one that shows the first line.
PointTable read_points_text(std::string_view bytes, const std::string& name);
/// NumPy's N x 3 array, alone or in an archive, or one of records with the fields x, y, z.
PointTable read_npy_points(std::string_view bytes, const std::string& name);
PointTable read_npz_points(std::string_view bytes, const std::string& name);
void write_npz(std::ostream& out, const Table& table);

}  // namespace littoral::io
