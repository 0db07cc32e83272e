#pragma once
// Points in space at which values are asked for, and files of these values.

#include <string>
#include <vector>

#include "cli/session.h"
#include "io/formats.h"

namespace littoral::cli {

/// As given: one of the two.
struct QueryPoints {
  std::string file;
  std::vector<std::string> at;  // "x,y,z"

  bool empty() const { return file.empty() && at.empty(); }
};

/// Adds --points, whose help begins with `help`, and --at.
void add_query_points(CLI::App& verb, QueryPoints& points, const std::string& help);

/// Points of any surface or cloud file, those of a table with its other columns, or those given
/// one by one. Throws InputError where both or neither are given, and for coordinates that are not
/// finite.
io::PointTable read_queries(const QueryPoints& points);

/// What values at points are written to: tables, or clouds with the values.
inline const io::Kinds query_outputs = {io::Kind::table, io::Kind::cloud};
void write_at_points(const std::string& file, const io::PointTable& queries, io::Table table);

}  // namespace littoral::cli
