// Tables of points as text.

#include <algorithm>
#include <array>
#include <optional>

#include "io/text_scan.h"
#include "io/write_table.h"
#include "littoral/error.h"

namespace littoral::io {

namespace {

using TextCells = std::vector<std::string>;

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

/// What separates the cells of a row: a semicolon, comma or tab where it holds one outside of
/// quotes, otherwise blanks.
char separator_of(std::string_view row) {
  bool quoted = false;
  std::array<bool, 3> found{};
  constexpr std::string_view marks = ";,\t";
  for (const char c : row) {
    if (c == '"') quoted = !quoted;
    if (const auto m = marks.find(c); !quoted && m != std::string_view::npos) found[m] = true;
  }
  for (std::size_t m = 0; m < marks.size(); ++m)
    if (found[m]) return marks[m];
  return ' ';
}

/// The cells of a row; quotes are taken off, and doubled ones within are one.
TextCells cells_of(std::string_view row, char separator) {
  TextCells cells(1);
  bool quoted = false;
  for (std::size_t i = 0; i < row.size(); ++i) {
    const char c = row[i];
    if (c == '"') {
      if (quoted && i + 1 < row.size() && row[i + 1] == '"')
        cells.back() += row[++i];
      else
        quoted = !quoted;
    } else if (!quoted && (c == separator || (separator == ' ' && is_blank(c)))) {
      if (separator != ' ' || !cells.back().empty()) cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  if (separator == ' ' && cells.back().empty() && cells.size() > 1) cells.pop_back();
  for (std::string& cell : cells) cell = trimmed(cell);
  return cells;
}

/// "x" of " //X [mm]": without a unit in brackets and the mark of a comment before the first name.
std::string plain_name(const std::string& name) {
  const std::size_t begin = name.find_first_not_of("/ "), end = name.find_first_of("([");
  if (begin == std::string::npos || begin >= end) return lower_case(name);
  return lower_case(std::string(trimmed(std::string_view(name).substr(begin, end - begin))));
}

/// Where x, y and z are among the names.
std::optional<std::array<std::size_t, 3>> coordinate_columns(const TextCells& names) {
  struct Known {
    std::string_view before, axes;
  };
  constexpr std::array all_known = std::to_array<Known>({{"", "xyz"},
                                                         {"points:", "012"},
                                                         {"points_", "012"},
                                                         {"points_", "xyz"},
                                                         {"coordinates:", "012"},
                                                         {"p", "xyz"},
                                                         {"pos_", "xyz"},
                                                         {"position_", "xyz"}});
  for (const Known& known : all_known) {
    std::array<std::size_t, 3> at{};
    bool all = true;
    for (std::size_t d = 0; d < 3 && all; ++d) {
      const std::string wanted = std::string(known.before) + known.axes[d];
      const auto found = std::ranges::find_if(
          names, [&](const std::string& name) { return plain_name(name) == wanted; });
      all = found != names.end();
      at[d] = static_cast<std::size_t>(found - names.begin());
    }
    if (all) return at;
  }
  return std::nullopt;
}

struct Columns {
  std::array<std::size_t, 3> xyz{0, 1, 2};
  TextCells names;  // empty: there is no head
  std::size_t count = 3;
};

Columns columns_of(const TextCells& first, const std::string& line, const std::string& name) {
  Columns columns;
  columns.count = first.size();
  const bool head =
      !parse_double(first.front()) && std::ranges::none_of(first, [](const std::string& cell) {
        return parse_double(cell).has_value();
      });
  if (!head) {
    if (columns.count == 3) return columns;
    throw InputError(name + ": the first line, " + in_quotes(line) + ", has " +
                         std::to_string(columns.count) +
                         " columns without names: three are x, y, z; of more, a first line such as "
                         "'id,x,y,z' says which",
                     "bad-file");
  }
  const auto xyz = coordinate_columns(first);
  if (!xyz)
    throw InputError(name + ": the first line, " + in_quotes(line) +
                         ", names no columns x, y and z (or Px, Py, Pz; Points:0, Points:1, "
                         "Points:2; pos_x, pos_y, "
                         "pos_z)",
                     "bad-file");
  columns.xyz = *xyz;
  columns.names = first;
  return columns;
}

}  // namespace

PointTable read_points_text(std::string_view bytes, const std::string& name) {
  LineScanner scan(without_byte_order_mark(bytes, name), name, '#');
  std::vector<double> numbers;
  PointTable table;
  Columns columns;
  char separator = ',';
  for (bool first = true; scan.next(); first = false) {
    const std::string line(scan.rest_of_line());
    if (first) separator = separator_of(line);
    const TextCells cells = cells_of(line, separator);
    if (first) {
      columns = columns_of(cells, line, name);
      for (std::size_t c = 0; c < columns.names.size(); ++c)
        if (std::ranges::find(columns.xyz, c) == columns.xyz.end())
          table.carried.push_back({columns.names[c], {}});
      if (!columns.names.empty()) continue;
    }
    if (cells.size() != columns.count)
      scan.fail("expected " + std::to_string(columns.count) + " columns, found " +
                std::to_string(cells.size()));
    for (const std::size_t c : columns.xyz) {
      const auto number = parse_double(cells[c]);
      if (!number)
        scan.fail(
            "expected a number, found " + in_quotes(cells[c]) +
            (cells[c].find(',') != std::string::npos ? "; decimals stand behind a point" : ""));
      numbers.push_back(*number);
    }
    for (std::size_t c = 0, carried = 0; c < columns.names.size(); ++c)
      if (std::ranges::find(columns.xyz, c) == columns.xyz.end())
        table.carried[carried++].cells.push_back(cells[c]);
  }
  if (numbers.empty()) throw InputError(name + ": no points", "bad-file");
  table.points =
      Eigen::Map<const MatX3>(numbers.data(), static_cast<Eigen::Index>(numbers.size() / 3), 3);
  return table;
}

}  // namespace littoral::io
