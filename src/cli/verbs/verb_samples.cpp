// littoral samples: points on and around a shape with their distances, for learning.

#include <memory>

#include "api/space/sdf.h"
#include "cli/input/numbers.h"
#include "cli/input/space_input.h"
#include "cli/output.h"
#include "cli/verbs/verbs.h"
#include "io/read.h"
#include "io/write_arrays.h"
#include "littoral/error.h"
#include "littoral/samples.h"

namespace littoral::cli {

namespace {

struct SamplesArguments {
  SpaceArguments space;
  SampleOptions options;
  std::string scales, numbers = "float32", out;
};

SampleNumbers numbers_named(const std::string& word) {
  return word == "float16"   ? SampleNumbers::float16
         : word == "float64" ? SampleNumbers::float64
                             : SampleNumbers::float32;
}

void run_samples(SamplesArguments& arguments, Session& session) {
  check_before([&] { io::check_arrays_output(arguments.out); });
  SampleOptions& options = arguments.options;
  options.numbers = numbers_named(arguments.numbers);
  if (!arguments.scales.empty()) options.scales = parse_numbers("scales", arguments.scales);
  const PolygonSoup input = io::read_surface(arguments.space.input);
  const SpaceRequest request = space_request(arguments.space, session);
  Context context;
  context.cancel = session.cancel;
  context.progress = session.progress_callback();
  context.threads = session.threads;
  session.reading = false;
  const Samples samples =
      sample(input, options, request.method, {request.flip, request.estimate_normals}, context);
  session.report.merge(samples.report);
  session.report.method = samples.report.method;
  session.report.domain = samples.report.domain;
  session.report.status = samples.report.status;
  session.record.values = {range_of("distances", samples.distances),
                           range_of("confidence", samples.confidence)};
  finish({arguments.out}, Task(session.cancel), session, [&](const std::string& file) {
    write(samples, file, std::filesystem::path(arguments.space.input).filename().string());
  });
}

}  // namespace

void add_samples(CLI::App& program, Session& session) {
  auto arguments = std::make_shared<SamplesArguments>();
  SampleOptions& options = arguments->options;
  CLI::App& verb =
      add_verb(program, session, arguments, "samples",
               "points on and around a shape with distances, for learning", run_samples);
  add_space_input(verb, arguments->space, session, {io::Kind::surface, io::Kind::cloud});
  add_output_option(verb, arguments->out,
                    "where to write: .npz, .zarr (a folder), .tar (WebDataset); a card with the "
                    "same name and .json is beside it");
  verb.add_option("--resolution", options.resolution,
                  "nodes along a side of the cube, of the grid for the surface, 8 to 2048 "
                  "[default 64]")
      ->check(whole_number(8, 2048))
      ->type_name("N");
  const auto count = [&](const char* name, int& value, const std::string& help) {
    verb.add_option(name, value, help)->check(whole_number(0, 1000000000))->type_name("N");
  };
  const auto share = [&](const char* name, double& value, const std::string& help) {
    add_share_option(verb, name, value, 1, help);
  };
  count("--surface", options.surface, "points on the surface [default 8192]");
  count("--space", options.space, "points in space [default 8192]");
  share("sharp", options.sharp,
        "share of the surface's points that are where normals turn [default 0.5]");
  share("uniform", options.uniform,
        "share of space's points that are anywhere in the cube [default 0.25]");
  share("curvature", options.curvature,
        "share of them that are near where normals turn; the rest are near the surface [default "
        "0.25]");
  verb.add_option("--scales", arguments->scales,
                  "how far from the surface, deviations in half sides of the cube [default "
                  "0.005,0.02,0.08]")
      ->type_name("S[,S...]");
  add_share_option(verb, "margin", options.margin, 10,
                   "of the cube about the input, in its longest side, 0 to 10, or 10% [default "
                   "0.1]");
  verb.add_option("--seed", options.seed, "of the random numbers [default 0]")
      ->check(whole_number(0, std::numeric_limits<long long>::max()))
      ->type_name("N");
  verb.add_option("--numbers", arguments->numbers,
                  "of positions and distances: float16, float32, float64 [default float32]")
      ->check(one_of({"float16", "float32", "float64"}))
      ->type_name("WORD");
  add_space_method(verb, arguments->space, "set of points");
  add_json_option(verb, session);
}

}  // namespace littoral::cli
