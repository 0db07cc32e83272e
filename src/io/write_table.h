#pragma once
// Tables of numbers, one row a point.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "littoral/types.h"

namespace littoral::io {

/// Writes columns (rows x names): .csv with a line of names, .txt (blanks between, %.17g), .npy
/// (float64, rows x columns, or one axis for one column). Throws UnsupportedError for other
/// extensions, IoError naming the path.
void write_table(const std::filesystem::path& path, const std::vector<std::string>& names,
                 const Eigen::MatrixXd& columns);

/// The first three numbers of each line, rows x 3; separated by commas, semicolons or blanks. A
/// first line of words is a head. Throws InputError naming the line.
MatX3 read_columns(std::string_view bytes, const std::string& name);

}  // namespace littoral::io
