// Tables of points as text.

#include <algorithm>

#include "base/counted.h"
#include "base/index.h"
#include "io/point_rows.h"
#include "io/write_table.h"
#include "littoral/error.h"

namespace littoral::io {

PointTable read_points_text(std::string_view bytes, const std::string& name) {
  PointRows rows(bytes, name);
  const PointRows::Cells& names = rows.names();
  if (names.empty() && rows.n_columns() > 0 && rows.n_columns() != 3)
    throw InputError(name + ": the first line, " + rows.first_row() + ", has " +
                         counted(rows.n_columns(), "column", "columns") +
                         " without names: three are x, y, z; of more, a first line such as "
                         "'id,x,y,z' says which",
                     "bad-file");
  std::vector<double> numbers;
  PointTable table;
  if (rows.n_columns() > 0) {
    const auto xyz = rows.points();
    if (!names.empty()) table.columns.clear();
    for (std::size_t c = 0; c < names.size(); ++c) {
      const auto axis = std::ranges::find(xyz, c);
      table.columns.push_back({names[c], axis == xyz.end() ? PointColumn::no_axis
                                                           : static_cast<int>(axis - xyz.begin())});
    }
    while (rows.next()) {
      for (const std::size_t c : xyz) numbers.push_back(rows.number(c));
      for (std::size_t c = 0; c < names.size(); ++c)
        if (table.columns[c].axis == PointColumn::no_axis)
          table.columns[c].cells.push_back(rows.cells()[c]);
    }
  }
  if (numbers.empty()) throw InputError(name + ": no points", "bad-file");
  table.points = Eigen::Map<const MatX3>(numbers.data(), index(numbers.size() / 3), 3);
  return table;
}

}  // namespace littoral::io
