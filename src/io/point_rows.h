#pragma once
// Points as rows of text: what tables of points and point clouds have in common.

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/text_scan.h"

namespace littoral::io {

/// Three columns named alike: "nx", "ny", "nz" have the axes "xyz" after "n".
struct NamedAxes {
  std::string_view before, axes;
};

/// Rows of cells between semicolons, commas, tabs or blanks, whichever comes first in this list and
/// in the first row. Quotes are taken off. A first row of one number counts the points and is left
/// out; a first row without any number names the columns.
class PointRows {
 public:
  using Cells = std::vector<std::string>;

  /// `name` is used in messages.
  PointRows(std::string_view bytes, const std::string& name);

  /// Goes to the next row; false at the end. Throws InputError where it has more or fewer cells
  /// than the first one.
  bool next();
  const Cells& cells() const { return cells_; }
  /// Of a cell of the row; throws InputError where it is no number.
  double number(std::size_t column) const;

  /// Of the file; 0 where it has no row.
  std::size_t n_columns() const { return n_columns_; }
  /// Empty where the rows have no names above them.
  const Cells& names() const { return names_; }
  /// Where the three columns of the first of these are that is there, in any case and without a
  /// unit in brackets.
  std::optional<std::array<std::size_t, 3>> columns(std::span<const NamedAxes> known) const;
  /// Where x, y and z are. Throws InputError where the names do not tell.
  std::array<std::size_t, 3> points() const;

  /// Throws InputError for the current row.
  [[noreturn]] void fail(const std::string& text) const { scan_.fail(text); }
  /// The first row, in quotes.
  std::string first_row() const;

 private:
  void split(std::string_view row);
  bool is_number(const std::string& cell) const { return parse_double(cell).has_value(); }

  LineScanner scan_;
  std::string name_, first_row_;
  char separator_ = ' ';
  std::size_t n_columns_ = 0;
  bool waits_ = false;  // the first row, read already, is the next one
  Cells cells_, names_;
};

}  // namespace littoral::io
