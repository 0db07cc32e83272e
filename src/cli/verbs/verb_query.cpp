// littoral query: signed distance at given points.

#include <memory>

#include "cli/input/query_points.h"
#include "cli/input/space_input.h"
#include "cli/output.h"
#include "cli/plan/plan.h"
#include "cli/verbs/verbs.h"

namespace littoral::cli {

namespace {

struct QueryArguments {
  SpaceArguments space;
  QueryPoints points;
  std::vector<std::string> out;
  bool gradient = false, confidence = false;
};

void run_query(QueryArguments& arguments, Session& session) {
  check_outputs(arguments.out, query_outputs);
  const CsgShapes shapes = read_shapes(arguments.space, session);
  const io::PointTable queries = read_queries(arguments.points);
  session.reading = false;
  const auto count = static_cast<double>(queries.points.rows());
  if (planned(plan_in_space(shapes, count, session.dry_run), session)) return;
  MatX3 gradients;
  const VecX values =
      query_distance(shapes, queries.points, arguments.gradient ? &gradients : nullptr,
                     session.task(), session.report);
  session.record.values = {range_of("distance", values)};
  io::Table table{{"distance"}, values};
  if (arguments.gradient) {
    table.names.insert(table.names.end(), {"gradient_x", "gradient_y", "gradient_z"});
    table.columns.conservativeResize(Eigen::NoChange, 4);
    table.columns.rightCols(3) = gradients;
  }
  if (arguments.confidence) {
    const Eigen::Index last = table.columns.cols();
    table.names.push_back("confidence");
    table.columns.conservativeResize(Eigen::NoChange, last + 1);
    table.columns.col(last) = confidence_at(shapes, queries.points, session);
  }
  finish(arguments.out, session.task(), session,
         [&](const std::string& file) { write_at_points(file, queries, table); });
}

}  // namespace

void add_query(CLI::App& program, Session& session) {
  auto arguments = std::make_shared<QueryArguments>();
  CLI::App& verb =
      add_verb(program, session, arguments, "query",
               "signed distance at given points, around a mesh, soup or point cloud", run_query);
  add_space_input(verb, arguments->space, session);
  add_query_points(verb, arguments->points, "where to evaluate: ");
  add_output_option(verb, arguments->out,
                    "where to write: " + io::written_extensions(query_outputs));
  verb.add_flag("--gradient", arguments->gradient, "also the gradient");
  add_confidence_option(verb, arguments->confidence);
  add_values_option(verb, arguments->space);
  add_space_method(verb, arguments->space, "set of points");
  add_shape_options(verb, arguments->space);
  add_plan_option(verb, session);
  add_json_option(verb, session);
}

}  // namespace littoral::cli
