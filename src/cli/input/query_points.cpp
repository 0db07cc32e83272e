#include "cli/input/query_points.h"

#include "base/index.h"
#include "cli/input/numbers.h"
#include "io/read.h"
#include "io/write.h"
#include "littoral/error.h"

namespace littoral::cli {

void add_query_points(CLI::App& verb, QueryPoints& points, const std::string& help) {
  verb.add_option("--points", points.file,
                  help + "the vertices of any surface or cloud file, or " +
                      io::read_extensions({io::Kind::table}) +
                      " with columns x, y, z; results in .csv and .tsv stand behind all columns of "
                      "the table")
      ->type_name("FILE");
  add_repeated_option(verb, "--at", points.at,
                      help + "this place, instead of --points; may be repeated")
      ->type_name("X,Y,Z");
}

io::PointTable read_queries(const QueryPoints& points) {
  if (points.empty())
    throw InputError("no points given: use option points or option at", "nothing-given");
  if (!points.file.empty() && !points.at.empty())
    throw InputError("option points and option at both say where: give one", "options-conflict");
  io::PointTable queries;
  if (points.file.empty()) {
    queries.points.resize(index(points.at.size()), 3);
    for (Eigen::Index i = 0; i < queries.points.rows(); ++i)
      queries.points.row(i) = parse_position("at", points.at[i]);
    return queries;
  }
  const io::Format& format =
      io::format_to_read(io::extension_to_read(points.file), points.file,
                         {io::Kind::table, io::Kind::surface, io::Kind::cloud});
  queries = format.read_table ? format.read_table(io::FileBytes(points.file).view(), points.file)
                              : io::PointTable{io::read_surface(points.file).points};
  for (Eigen::Index i = 0; i < queries.points.rows(); ++i)
    if (!queries.points.row(i).allFinite())
      throw InputError(points.file + ": point " + std::to_string(i) +
                           ", counted from 0, has coordinates that are not finite",
                       "not-finite");
  return queries;
}

void write_at_points(const std::string& file, const io::PointTable& queries, io::Table table) {
  table.at = &queries;
  if (io::is_written_as(file, {io::Kind::table})) return io::write_table(file, table);
  PolygonSoup cloud;
  cloud.points = queries.points;
  for (std::size_t c = 0; c < table.names.size(); ++c)
    cloud.scalars[table.names[c]] = table.columns.col(index(c));
  io::write_surface(file, cloud);
}

}  // namespace littoral::cli
