// littoral query: signed distance at given points.

#include <memory>

#include "cli/input/space_input.h"
#include "cli/verbs/verbs.h"

namespace littoral::cli {

namespace {

struct Arguments {
  SpaceArguments space;
  std::string points;
  std::vector<std::string> out;
  bool gradient = false;
};

void run(Arguments& arguments, Session& session) {
  for (const std::string& file : arguments.out)
    check_output(file, {".csv", ".txt", ".npy", ".ply"}, "values at points");
  const CsgShapes shapes = read_shapes(arguments.space, session, {});
  const MatX3 queries = read_queries(arguments.points);
  session.reading = false;
  MatX3 gradients;
  const VecX values = query_distance(shapes, queries, arguments.gradient ? &gradients : nullptr,
                                     session.task(), session.report);
  Table table{{"distance"}, values};
  if (arguments.gradient) {
    table.names.insert(table.names.end(), {"gradient_x", "gradient_y", "gradient_z"});
    table.columns.conservativeResize(Eigen::NoChange, 4);
    table.columns.rightCols(3) = gradients;
  }
  write_query_table(arguments.out, queries, table);
  session.print_report();
}

}  // namespace

void add_query(CLI::App& program, Session& session) {
  CLI::App* verb = program.add_subcommand(
      "query", "signed distance at given points, around a mesh, soup or point cloud");
  auto arguments = std::make_shared<Arguments>();
  add_space_input(*verb, arguments->space, session);
  add_query_files(*verb, arguments->points, arguments->out);
  verb->add_flag("--gradient", arguments->gradient, "also the gradient");
  add_space_method(*verb, arguments->space, "tori for point clouds, otherwise winding");
  add_shape_options(*verb, arguments->space);
  add_json_option(*verb, session);
  add_common_options(*verb, session);
  verb->callback(
      [arguments, &session] { session.job = [arguments, &session] { run(*arguments, session); }; });
}

}  // namespace littoral::cli
