// littoral pairs: distance between all pairs of vertices of a surface.

#include <memory>

#include "api/surface/pairs.h"
#include "base/stopwatch.h"
#include "cli/input/method_options.h"
#include "cli/input/surface_input.h"
#include "cli/verbs/verbs.h"
#include "io/write_table.h"
#include "littoral/error.h"

namespace littoral::cli {

namespace {

struct Arguments {
  std::string domain;
  std::vector<std::string> out;
  std::vector<long long> vertices;
  MethodArguments method;
};

void run(Arguments& arguments, Session& session) {
  for (const std::string& file : arguments.out)
    check_output(file, {".npy", ".csv", ".txt"}, "a matrix");
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
  Task task = session.task();
  const PairsAnswer answer = pair_distances(domain_of(mesh, input.normals()), vertices, method,
                                            task.stage(0.95, "pairs of vertices"), report);
  {
    const Stopwatch watch(report, "write");
    std::vector<std::string> names;
    for (int v = 0; v < mesh.n_vertices(); ++v) names.push_back("to " + std::to_string(v));
    for (const std::string& file : arguments.out) {
      task.checkpoint();
      io::write_table(file, names, answer.distances);
    }
  }
  session.print_report();
}

}  // namespace

void add_pairs(CLI::App& program, Session& session) {
  CLI::App* verb = program.add_subcommand(
      "pairs", "distance between all pairs of vertices of a surface, as a matrix");
  auto arguments = std::make_shared<Arguments>();
  verb->add_option("DOMAIN", arguments->domain, "the surface: mesh, point cloud or voxels")
      ->required()
      ->type_name("");
  add_repeated_option(*verb, "--vertex", arguments->vertices,
                      "a vertex to measure from, from 0; may be repeated; without, all")
      ->type_name("I");
  add_output_option(*verb, arguments->out,
                    "the matrix, a row for each vertex measured from: .npy .csv .txt");
  add_methods(*verb, arguments->method, pair_methods());
  add_index_option(*verb, session);
  add_json_option(*verb, session);
  add_common_options(*verb, session);
  verb->callback(
      [arguments, &session] { session.job = [arguments, &session] { run(*arguments, session); }; });
}

}  // namespace littoral::cli
