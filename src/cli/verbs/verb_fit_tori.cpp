// littoral fit-tori: the tori of a point cloud, evaluated later.

#include <memory>

#include "cli/input/space_input.h"
#include "cli/output.h"
#include "cli/verbs/verbs.h"
#include "io/read.h"
#include "io/write.h"

namespace littoral::cli {

namespace {

struct FitToriArguments {
  SpaceArguments space;
  std::string out;
};

void run_fit_tori(FitToriArguments& arguments, Session& session) {
  check_outputs({arguments.out}, {io::Kind::cloud});
  const SpaceRequest request = space_request(arguments.space, session);
  const PolygonSoup input = io::read_surface(arguments.space.input);
  session.reading = false;
  const PolygonSoup tori = fit_tori_cloud(input, request, session.task(), session.report);
  finish({arguments.out}, session.task(), session,
         [&](const std::string& file) { io::write_surface(file, tori); });
}

}  // namespace

void add_fit_tori(CLI::App& program, Session& session) {
  auto arguments = std::make_shared<FitToriArguments>();
  CLI::App& verb = add_verb(
      program, session, arguments, "fit-tori",
      "fit a torus to each point of a cloud; query, sdf and offset take the result", run_fit_tori);
  add_space_input(verb, arguments->space, session, {io::Kind::surface, io::Kind::cloud});
  add_output_option(verb, arguments->out,
                    "where to write: " + io::written_extensions({io::Kind::cloud}));
  add_method_options(verb, arguments->space.method.options,
                     {Registry<SpaceDomain>::instance().find(Tori::method)->info});
  add_json_option(verb, session);
}

}  // namespace littoral::cli
