// littoral repair: a closed surface made of a broken one.

#include <memory>

#include "api/space/repair_surface.h"
#include "cli/input/space_input.h"
#include "cli/output.h"
#include "cli/plan/plan.h"
#include "cli/verbs/verbs.h"
#include "io/write.h"
#include "littoral/error.h"

namespace littoral::cli {

namespace {

struct RepairArguments {
  std::vector<std::string> out;
  std::string error, thicken, smallest_part;
  bool no_fit = false, fill_cavities = false, remesh = false;
  SpaceArguments space;
};

void run_repair(RepairArguments& arguments, Session& session) {
  check_outputs(arguments.out, {io::Kind::surface, io::Kind::page, io::Kind::picture});
  const CsgShapes shapes = read_shapes(arguments.space, session);
  const Shape& shape = shapes.all.front();
  const InputSize size = [&] { return longest_side(shapes); };
  RepairOptions options;
  const GridOptions grid = grid_request(arguments.space, size);
  options.grid = grid;
  options.error = parse_radius("error", arguments.error, size);
  if (!arguments.error.empty() && !(options.error > 0))
    throw InputError("option error must be greater than 0", "option-value");
  options.thicken = parse_radius("thicken", arguments.thicken, size);
  options.smallest_part = parse_radius("smallest-part", arguments.smallest_part, size);
  options.remesh = arguments.remesh;
  options.fit = !arguments.no_fit;
  options.cavities = !arguments.fill_cavities;
  if (options.error > 0 && (grid.resolution || grid.spacing))
    throw InputError("option error chooses the grid: give it, or resolution or spacing",
                     "options-conflict");
  session.reading = false;
  GridOptions likely = options.grid;
  if (!likely.resolution && !likely.spacing) likely.resolution = repair_nodes;
  if (planned(plan_in_space(shapes, choose_grid(shapes, likely), session.dry_run), session)) return;
  const PolygonSoup result =
      repair_surface(shape.surface, options, shape.request, session.task(), session.report);
  session.record.values = {range_of("distance", result.scalars.at("distance"))};
  finish(arguments.out, session.task(), session, [&](const std::string& file) {
    if (io::is_written_as(file, {io::Kind::surface})) return io::write_surface(file, result);
    write_result(file, result, "distance", arguments.space.input, session.report);
  });
}

void add_options(CLI::App& verb, RepairArguments& arguments, Session& session) {
  add_space_input(verb, arguments.space, session, {io::Kind::surface, io::Kind::cloud});
  add_output_option(verb, arguments.out,
                    "the closed surface: " + io::written_extensions({io::Kind::surface}) +
                        ", or a page or picture of it");
  const std::string unit = std::string(" [") + length_unit_text + "]";
  verb.add_option("--error", arguments.error,
                  "refine the grid, up to 512 nodes, until no point of the result is farther than "
                  "that from the input or what closes it" +
                      unit)
      ->type_name("D");
  verb.add_option(
          "--thicken", arguments.thicken,
          "sheets, and thin parts that the grid tears, become walls of this thickness" + unit)
      ->type_name("T");
  verb.add_option("--smallest-part", arguments.smallest_part,
                  "drop parts whose boxes have shorter diagonals" + unit)
      ->type_name("D");
  verb.add_flag("--fill-cavities", arguments.fill_cavities, "drop holes inside of parts");
  verb.add_flag("--remesh", arguments.remesh,
                "take the surface from a grid also where the input's own triangles will do");
  verb.add_flag("--no-fit", arguments.no_fit,
                "keep the contour of the grid: vertices are not moved onto the input");
  add_grid_options(verb, arguments.space, {repair_nodes, {}, {}, RepairOptions().grid.padding});
  add_space_method(verb, arguments.space);
  add_plan_option(verb, session);
  add_json_option(verb, session);
}

}  // namespace

void add_repair(CLI::App& program, Session& session) {
  auto arguments = std::make_shared<RepairArguments>();
  add_options(
      add_verb(program, session, arguments, "repair",
               "a closed, manifold surface without crossings, from a broken one", run_repair),
      *arguments, session);
}

}  // namespace littoral::cli
