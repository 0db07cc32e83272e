#include "io/point_rows.h"

#include <algorithm>

#include "base/counted.h"
#include "littoral/error.h"

namespace littoral::io {

namespace {

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

/// What separates the cells of a row, outside of quotes.
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

/// "x" of " //X [mm]": without a unit in brackets and the mark of a comment before the first name.
std::string plain_name(const std::string& name) {
  const std::size_t begin = name.find_first_not_of("/ "), end = name.find_first_of("([");
  if (begin == std::string::npos || begin >= end) return lower_case(name);
  return lower_case(std::string(trimmed(std::string_view(name).substr(begin, end - begin))));
}

}  // namespace

PointRows::PointRows(std::string_view bytes, const std::string& name)
    : scan_(without_byte_order_mark(bytes, name), name, '#'), name_(name) {
  for (bool counted_points = false; scan_.next(); counted_points = true) {
    first_row_ = scan_.rest_of_line();
    separator_ = separator_of(first_row_);
    split(first_row_);
    if (!counted_points && cells_.size() == 1 && is_number(cells_[0])) continue;
    n_columns_ = cells_.size();
    waits_ = std::ranges::any_of(cells_, [&](const std::string& cell) { return is_number(cell); });
    if (!waits_) names_ = cells_;
    break;
  }
}

/// Doubled quotes within quotes are one.
void PointRows::split(std::string_view row) {
  std::size_t n = 0;  // cells before the current one
  const auto begin_cell = [&] {
    if (n == cells_.size()) cells_.emplace_back();
    cells_[n].clear();
  };
  begin_cell();
  bool quoted = false;
  for (std::size_t i = 0; i < row.size(); ++i) {
    const char c = row[i];
    if (c == '"') {
      if (quoted && i + 1 < row.size() && row[i + 1] == '"')
        cells_[n] += row[++i];
      else
        quoted = !quoted;
    } else if (!quoted && (c == separator_ || (separator_ == ' ' && is_blank(c)))) {
      if (separator_ == ' ' && cells_[n].empty()) continue;
      ++n;
      begin_cell();
    } else {
      cells_[n] += c;
    }
  }
  if (separator_ == ' ' && cells_[n].empty() && n > 0) --n;
  cells_.resize(n + 1);
  for (std::string& cell : cells_)
    if (const std::string_view kept = trimmed(cell); kept.size() != cell.size())
      cell = std::string(kept);
}

bool PointRows::next() {
  if (waits_) {
    waits_ = false;
    return true;
  }
  if (!scan_.next()) return false;
  split(scan_.rest_of_line());
  if (cells_.size() != n_columns_)
    fail("expected " + counted(n_columns_, "column", "columns") + " as in the first row, found " +
         std::to_string(cells_.size()));
  return true;
}

double PointRows::number(std::size_t column) const {
  const std::string& cell = cells_[column];
  if (const auto number = parse_double(cell)) return *number;
  const bool comma =
      cell.find(',') != std::string::npos ||
      (separator_ == ',' && std::ranges::any_of(cell, [](char c) { return is_blank(c); }));
  fail("expected a number, found " + in_quotes(cell) +
       (comma ? "; write a point, not a comma, before the decimals" : ""));
}

std::optional<std::array<std::size_t, 3>> PointRows::columns(
    std::span<const NamedAxes> known) const {
  for (const NamedAxes& each : known) {
    std::array<std::size_t, 3> at{};
    bool all = true;
    for (std::size_t d = 0; d < 3 && all; ++d) {
      const std::string wanted = std::string(each.before) + each.axes[d];
      const auto found = std::ranges::find_if(
          names_, [&](const std::string& name) { return plain_name(name) == wanted; });
      all = found != names_.end();
      at[d] = std::size_t(found - names_.begin());
    }
    if (all) return at;
  }
  return std::nullopt;
}

std::array<std::size_t, 3> PointRows::points() const {
  constexpr std::array known = std::to_array<NamedAxes>({{"", "xyz"},
                                                         {"points:", "012"},
                                                         {"points_", "012"},
                                                         {"points_", "xyz"},
                                                         {"coordinates:", "012"},
                                                         {"p", "xyz"},
                                                         {"pos_", "xyz"},
                                                         {"position_", "xyz"}});
  if (names_.empty()) return {0, 1, 2};
  if (const auto found = columns(known)) return *found;
  throw InputError(name_ + ": the first line, " + first_row() +
                       ", names no columns x, y and z (or Px, Py, Pz; Points:0, Points:1, "
                       "Points:2; pos_x, pos_y, pos_z)",
                   "bad-file");
}

std::string PointRows::first_row() const { return in_quotes(first_row_); }

}  // namespace littoral::io
