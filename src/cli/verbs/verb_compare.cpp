// littoral compare: how far two surfaces are from each other.

#include <iostream>
#include <memory>

#include "api/space/surface_difference.h"
#include "base/option_table.h"
#include "cli/output.h"
#include "cli/verbs/verbs.h"
#include "io/read.h"
#include "io/write.h"

namespace littoral::cli {

namespace {

struct CompareArguments {
  std::string a, b;
  std::vector<std::string> out;
  int samples = 100000;
};

void add_sizes(Report& report, const std::string& name, const OneSidedDistance& d) {
  for (const auto& [what, value] : {std::pair("largest", d.largest),
                                    {"mean", d.mean},
                                    {"rms", d.rms},
                                    {"median", d.median},
                                    {"95 % below", d.p95},
                                    {"99 % below", d.p99}})
    report.sizes.emplace_back(name + ": " + what, value);
}

void run_compare(CompareArguments& arguments, Session& session) {
  const io::Kinds outputs = {io::Kind::field, io::Kind::page, io::Kind::picture};
  check_outputs(arguments.out, outputs);
  const PolygonSoup a = io::read_surface(arguments.a), b = io::read_surface(arguments.b);
  session.reading = false;
  Report& report = session.report;
  Task task = session.task();
  const OneSidedDistance there = one_sided_distance(a, b, arguments.samples, task.stage(0.5, "A"));
  const OneSidedDistance back = one_sided_distance(b, a, arguments.samples, task.stage(0.5, "B"));
  report.method = "compare";
  report.domain = "two surfaces";
  report.sizes.emplace_back("hausdorff", std::max(there.largest, back.largest));
  add_sizes(report, "A to B", there);
  add_sizes(report, "B to A", back);
  session.record.values = {range_of("distance", there.at_vertices)};
  if (!session.json)
    for (const auto& [name, value] : report.sizes)
      session.facts() << name << ": " << number_text(value) << "\n";
  PolygonSoup shown = a;
  shown.scalars = {{"distance", there.at_vertices}};
  finish(arguments.out, session.task(), session, [&](const std::string& file) {
    write_result(file, shown, "distance", arguments.a, report);
  });
}

}  // namespace

void add_compare(CLI::App& program, Session& session) {
  auto arguments = std::make_shared<CompareArguments>();
  CLI::App& verb =
      add_verb(program, session, arguments, "compare",
               "how far two surfaces or clouds are from each other, both ways", run_compare);
  const std::string kinds = kinds_help({io::Kind::surface, io::Kind::cloud});
  add_input_option(verb, "A", arguments->a, kinds);
  add_input_option(verb, "B", arguments->b, kinds);
  add_repeated_option(
      verb, "-o,--output", arguments->out,
      "A with its distance to B at its vertices: " +
          io::written_extensions({io::Kind::field, io::Kind::page, io::Kind::picture}) +
          "; may be repeated")
      ->type_name("OUT");
  verb.add_option("--samples", arguments->samples,
                  "points on each surface, 1 to 100000000 [default 100000]")
      ->check(whole_number(1, 100000000))
      ->type_name("N");
  add_json_option(verb, session);
}

}  // namespace littoral::cli
