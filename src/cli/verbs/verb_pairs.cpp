// littoral pairs: distance between all pairs of vertices of a surface.

#include <memory>

#include "api/surface/pairs.h"
#include "base/error.h"
#include "cli/input/method_options.h"
#include "cli/input/surface_input.h"
#include "cli/verbs/verbs.h"
#include "io/write_table.h"

namespace littoral::cli {

namespace {

struct Arguments {
  std::string domain;
  std::vector<std::string> out;
  std::vector<long long> vertices;
  PairsRequest request;
  GivenOptions options;
};

void run(Arguments& arguments, Session& session) {
  for (const std::string& file : arguments.out)
    check_output(file, {".npy", ".csv", ".txt"}, "a matrix");
  PairsRequest& request = arguments.request;
  request.options.assign(arguments.options.begin(), arguments.options.end());
  check_request(request);
  Report& report = session.report;
  const SurfaceMesh mesh = [&] {
    const Stopwatch watch(report, "read");
    return read_mesh(arguments.domain);
  }();
  request.vertices =
      checked_vertices(arguments.vertices, mesh.n_vertices(), arguments.domain, session);
  session.reading = false;
  Task task = session.task();
  const PairsAnswer answer =
      pair_distances(mesh, request, task.stage(0.95, "pairs of vertices"), report);
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
      "pairs", "distance between all pairs of vertices of a triangle mesh, as a matrix");
  auto arguments = std::make_shared<Arguments>();
  verb->add_option("DOMAIN", arguments->domain, "the surface: .obj .ply .off .stl")
      ->required()
      ->type_name("");
  add_repeated_option(*verb, "--vertex", arguments->vertices,
                      "a vertex to measure from, from 0; may be repeated; without, all")
      ->type_name("I");
  add_output_option(*verb, arguments->out,
                    "the matrix, a row for each vertex measured from: .npy .csv .txt");
  add_method_option(*verb, arguments->request.method, pair_methods());
  add_method_options(*verb, arguments->options, pair_methods());
  add_index_option(*verb, session);
  add_json_option(*verb, session);
  add_common_options(*verb, session);
  verb->callback(
      [arguments, &session] { session.job = [arguments, &session] { run(*arguments, session); }; });
}

}  // namespace littoral::cli
