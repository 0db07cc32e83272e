// littoral pairs: distance between all pairs of vertices of a surface.

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>

#include "api/surface/pairs.h"
#include "base/stopwatch.h"
#include "cli/input/method_options.h"
#include "cli/input/surface_input.h"
#include "cli/output.h"
#include "cli/plan/plan.h"
#include "cli/verbs/verbs.h"
#include "io/write_table.h"

namespace littoral::cli {

namespace {

struct PairsArguments {
  std::string domain;
  std::vector<std::string> out;
  std::vector<long long> vertices;
  MethodArguments method;
};

void run_pairs(PairsArguments& arguments, Session& session) {
  check_outputs(arguments.out, {io::Kind::table});
  const AnyMethod method = arguments.method.method();
  check_pairs_method(method);
  Report& report = session.report;
  const SurfaceInput input = [&] {
    const Stopwatch watch(report, "read");
    return read_domain(arguments.domain);
  }();
  const SurfaceMesh& mesh = input.mesh;
  const std::vector<int> vertices =
      checked_vertices(arguments.vertices, mesh.n_vertices(), arguments.domain, session);
  session.reading = false;
  const SurfaceDomain domain = domain_of(mesh, input.normals());
  RunPlan plan = plan_on(method, domain);
  plan.methods = pair_methods();
  plan.shorter =
      "option vertex measures from some vertices only, and method unsigned-heat in a thirtieth of "
      "the time, less exactly";
  if (!vertices.empty()) {
    plan.sizes.emplace_back("from", static_cast<double>(vertices.size()));
    plan.share = std::min(1.0, static_cast<double>(vertices.size()) / plan.elements);
  }
  if (planned(plan, session)) return;
  Task task = session.task();
  PairsAnswer answer =
      pair_distances(domain, vertices, method, task.stage(0.95, "pairs of vertices"), report);
  session.record.values = {range_of(
      "distance", Eigen::Map<const VecX>(answer.distances.data(), answer.distances.size()))};
  io::Table table{{}, std::move(answer.distances)};
  for (int v = 0; v < mesh.n_vertices(); ++v) table.names.push_back("to " + std::to_string(v));
  finish(arguments.out, task.stage(0.05, "writing"), session,
         [&](const std::string& file) { io::write_table(file, table); });
}

}  // namespace

void add_pairs(CLI::App& program, Session& session) {
  auto arguments = std::make_shared<PairsArguments>();
  CLI::App& verb =
      add_verb(program, session, arguments, "pairs",
               "distance between all pairs of vertices of a surface, as a matrix", run_pairs);
  add_input_option(
      verb, "DOMAIN", arguments->domain,
      "the surface: " + kinds_help({io::Kind::surface, io::Kind::cloud, io::Kind::voxels}));
  add_repeated_option(
      verb, "--vertex", arguments->vertices,
      "a vertex to measure from, from 0; several as 1,5,9 or repeated; without, all")
      ->delimiter(',')
      ->check(whole_number(std::numeric_limits<long long>::min(),
                           std::numeric_limits<long long>::max()))
      ->type_name("I[,I...]");
  add_output_option(verb, arguments->out,
                    "the matrix, a row for each vertex measured from: " +
                        io::written_extensions({io::Kind::table}));
  add_methods(verb, arguments->method, pair_methods());
  add_index_option(verb, session);
  add_plan_option(verb, session);
  add_json_option(verb, session);
}

}  // namespace littoral::cli
