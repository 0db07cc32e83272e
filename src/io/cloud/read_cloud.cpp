// Point clouds as text: .pc (v and vn records) and .xyz (columns).

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "base/counted.h"
#include "base/index.h"
#include "io/point_rows.h"
#include "io/surface/surface_formats.h"
#include "io/text_scan.h"
#include "littoral/error.h"

namespace littoral::io {
namespace {

MatX3 rows_of(const std::vector<double>& numbers) {
  return Eigen::Map<const MatX3>(numbers.data(), index(numbers.size() / 3), 3);
}

PolygonSoup cloud_of(const std::vector<double>& points, const std::vector<double>& normals,
                     const std::string& name) {
  if (points.empty()) throw InputError(name + ": no points", "bad-file");
  if (points.size() / 3 > std::size_t(std::numeric_limits<int>::max()))
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
    throw InputError(name + ": " + counted(points.size() / 3, "point", "points") + " but " +
                         counted(normals.size() / 3, "normal", "normals"),
                     "bad-file");
  return cloud_of(points, normals, name);
}

PolygonSoup read_xyz(std::string_view bytes, const std::string& name) {
  constexpr std::array normal_names = std::to_array<NamedAxes>(
      {{"n", "xyz"}, {"normal_", "xyz"}, {"normals_", "xyz"}, {"normals:", "012"}});
  PointRows rows(bytes, name);
  std::vector<double> points, normals;
  if (rows.n_columns() > 0) {
    if (rows.n_columns() < 3)
      throw InputError(name + ": the first row, " + rows.first_row() + ", has " +
                           counted(rows.n_columns(), "column", "columns") +
                           "; x, y and z are needed",
                       "bad-file");
    const auto xyz = rows.points();
    // Six columns without names are points and normals, or colours; what else there is, is not
    // taken for normals.
    std::optional<std::array<std::size_t, 3>> normal = rows.columns(normal_names);
    const bool six = rows.names().empty() && rows.n_columns() == 6;
    if (six) normal = {3, 4, 5};
    while (rows.next()) {
      for (const std::size_t c : xyz) points.push_back(rows.number(c));
      if (normal)
        for (const std::size_t c : *normal) normals.push_back(rows.number(c));
    }
    if (six && are_colours(rows_of(normals))) normals.clear();
  }
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
