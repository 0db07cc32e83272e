#include "cli/input/trace_input.h"

#include <algorithm>

#include "api/space/traced_scene.h"
#include "littoral/error.h"

namespace littoral::cli {

namespace {
const char* const group = "Tracing";
constexpr int framing_nodes = 40, slice_nodes = 128, page_nodes = 64;  // along the longest side
}  // namespace

void add_trace_options(CLI::App& verb, TraceArguments& texts, Session& session) {
  const std::vector<CLI::Option*> before = verb.get_options();
  verb.add_flag("--estimate-normals", texts.space.estimate_normals,
                "of a point cloud: compute normals from neighbouring points");
  verb.add_flag("--flip", session.flip, "reverse all normals: the other side is positive");
  add_space_method(verb, texts.space, method_for_points_text);
  add_shape_options(verb, texts.space);
  add_grid_options(verb, texts.space);
  for (CLI::Option* option : verb.get_options())
    if (std::find(before.begin(), before.end(), option) == before.end()) option->group(group);
  verb.add_flag("--trace", texts.trace,
                "FILE is a mesh, soup, cloud or volume of distance: follow rays through its signed "
                "distance to the surface, or with --level to an offset of it");
}

void check_no_trace_options(const CLI::App& verb) {
  for (const CLI::Option* option : verb.get_options())
    if (option->get_group() == group && option->count() > 0)
      throw InputError("option " + option->get_single_name() + " goes with option trace");
}

io::Scene read_traced_scene(const std::string& file, TraceArguments& texts,
                            const VolumeViewArguments& view, bool for_page, Session& session) {
  texts.space.input = file;
  const CsgShapes shapes = read_shapes(texts.space, session);
  TracedView traced;
  traced.axis = view.axis_number();
  traced.for_page = for_page;
  if (!view.position.empty()) traced.position = view.slice_at();
  if (!view.level.empty()) traced.level = parse_number("level", view.level);
  GridRequest request = grid_request(texts.space);
  if (!request.resolution && !request.spacing)
    request.resolution = for_page                      ? page_nodes
                         : traced.position.has_value() ? slice_nodes
                                                       : framing_nodes;
  request.padding += std::max(0.0, traced.level) / longest_side(shapes);
  const Grid grid = choose_grid(shapes, request);
  session.reading = false;
  return traced_scene(shapes, grid, traced, session.task(), session.report);
}

}  // namespace littoral::cli
