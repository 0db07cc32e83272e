// Point clouds as text: .pc (v and vn records) and .xyz (columns).

#include <limits>
#include <string>
#include <vector>

#include "io/surface/surface_formats.h"
#include "io/text_scan.h"
#include "littoral/error.h"

namespace littoral::io {
namespace {

MatX3 rows_of(const std::vector<double>& numbers) {
  return Eigen::Map<const MatX3>(numbers.data(), static_cast<Eigen::Index>(numbers.size() / 3), 3);
}

PolygonSoup cloud_of(const std::vector<double>& points, const std::vector<double>& normals,
                     const std::string& name) {
  if (points.empty()) throw InputError(name + ": no points", "bad-file");
  if (points.size() / 3 > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    throw InputError(name + ": more than 2147483647 points", "too-large");
  PolygonSoup cloud;
  cloud.points = rows_of(points);
  if (!normals.empty()) cloud.normals = rows_of(normals);
  return cloud;
}

}  // namespace

PolygonSoup read_pc(std::string_view bytes, const std::string& name) {
  LineScanner scan(bytes, name, '#');
  std::vector<double> points, normals;
  while (scan.next()) {
    const std::string_view record = scan.word();
    if (record != "v" && record != "vn")
      scan.fail("expected 'v x y z' or 'vn x y z', found " + in_quotes(record));
    std::vector<double>& to = record == "v" ? points : normals;
    for (int k = 0; k < 3; ++k) to.push_back(scan.number("a coordinate"));
    scan.expect_end();
  }
  if (!normals.empty() && normals.size() != points.size())
    throw InputError(name + ": " + std::to_string(points.size() / 3) + " points but " +
                         std::to_string(normals.size() / 3) + " normals",
                     "bad-file");
  return cloud_of(points, normals, name);
}

PolygonSoup read_xyz(std::string_view bytes, const std::string& name) {
  LineScanner scan(bytes, name, '#');
  std::vector<double> points, normals, row;
  std::size_t columns = 0;
  while (scan.next()) {
    row.clear();
    for (std::string_view word; !(word = scan.word()).empty();) {
      const auto number = parse_double(word);
      if (!number)
        scan.fail("expected a number, found " + in_quotes(word) +
                  (decimal_comma_hint(word).empty()
                       ? "; rows are x y z with blanks between, without names above them"
                       : decimal_comma_hint(word)));
      row.push_back(*number);
    }
    if (row.size() == 1 && points.empty() && columns == 0) continue;  // a count of points
    if (columns == 0) columns = row.size();
    if (row.size() != columns)
      scan.fail("a row of " + std::to_string(row.size()) + " numbers, the first had " +
                std::to_string(columns));
    if (columns < 3)
      scan.fail("a row of " + std::to_string(columns) + " numbers, x y z are needed");
    points.insert(points.end(), row.begin(), row.begin() + 3);
    // Six columns are points and normals, or colours; any other number of further ones is the like.
    if (columns == 6) normals.insert(normals.end(), row.begin() + 3, row.end());
  }
  if (are_colours(rows_of(normals))) normals.clear();
  return cloud_of(points, normals, name);
}

bool are_colours(const MatX3& columns) {
  constexpr double unit = 1e-2;  // how far from 1 a unit normal's length may be by rounding
  constexpr double dark = 16;    // of bytes: the largest is above it
  if (columns.rows() == 0 || !columns.allFinite() || (columns.array() < 0).any()) return false;
  const bool bytes = columns.maxCoeff() >= dark && columns.maxCoeff() <= 255 &&
                     (columns.array() == columns.array().round()).all();
  const bool shares =
      columns.maxCoeff() <= 1 && ((columns.rowwise().norm().array() - 1).abs() > unit).any();
  return bytes || shares;
}

}  // namespace littoral::io
