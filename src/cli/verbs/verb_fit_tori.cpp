// littoral fit-tori: the tori of a point cloud, evaluated later.

#include <memory>

#include "cli/input/space_input.h"
#include "cli/verbs/verbs.h"
#include "io/read.h"
#include "io/write.h"

namespace littoral::cli {

namespace {

struct Arguments {
  SpaceArguments space;
  std::string out;
};

void run(Arguments& arguments, Session& session) {
  check_output(arguments.out, {".ply"}, "fitted tori");
  const SpaceRequest request = space_request(arguments.space, Tori{}, session);
  const PolygonSoup input = io::read_surface(arguments.space.input);
  session.reading = false;
  const PolygonSoup tori = fit_tori_cloud(input, request, session.task(), session.report);
  io::write_surface(arguments.out, tori);
  session.print_report();
}

}  // namespace

void add_fit_tori(CLI::App& program, Session& session) {
  CLI::App* verb = program.add_subcommand(
      "fit-tori", "fit a torus to each point of a cloud; query, sdf and offset take the result");
  auto arguments = std::make_shared<Arguments>();
  add_space_input(*verb, arguments->space, session);
  verb->add_option("-o,--output", arguments->out, "where to write: .ply")
      ->required()
      ->type_name("OUT");
  add_method_options(*verb, arguments->space.method.options,
                     {Registry<SpaceDomain>::instance().find(Tori::method)->info});
  add_json_option(*verb, session);
  add_common_options(*verb, session);
  verb->callback(
      [arguments, &session] { session.job = [arguments, &session] { run(*arguments, session); }; });
}

}  // namespace littoral::cli
