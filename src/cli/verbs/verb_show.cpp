// littoral view and render: pages and pictures of a surface with its field and sources.

#include <algorithm>
#include <iostream>
#include <memory>
#include <utility>

#include "api/space/traced_scene.h"
#include "api/tet/tet_boundary.h"
#include "base/index.h"
#include "base/platform/temporary_folder.h"
#include "cli/input/numbers.h"
#include "cli/input/space_input.h"
#include "cli/input/surface_input.h"
#include "cli/output.h"
#include "cli/serve.h"
#include "cli/studio.h"
#include "cli/verbs/verbs.h"
#include "domain/cloud/cloud_surface.h"
#include "io/read.h"
#include "io/render/discs.h"
#include "io/render/picture.h"
#include "io/render/scene.h"
#include "io/render/volume_scene.h"
#include "littoral/error.h"

namespace littoral::cli {

namespace {

const char* const trace_group = "Tracing";
constexpr int traced_nodes = 64, slice_nodes = 128;  // along the longest side

/// Options about volumes, as given.
struct VolumeViewArguments {
  std::string axis, position, level;
  int axis_number() const { return axis.empty() ? 2 : axis.front() - 'x'; }
  double slice_at(const Vec3& low, const Vec3& high) const {
    const int a = axis_number();
    return parse_place("slice", position.empty() ? "50%" : position, low[a], high[a]);
  }
  bool no_surface = false;

  /// The first of them that was given, if any.
  std::string given() const {
    if (!axis.empty()) return "axis";
    if (!position.empty()) return "slice";
    if (!level.empty()) return "level";
    return no_surface ? "no-surface" : "";
  }
};

/// Surfaces of fields, traced by rays.
struct TraceArguments {
  bool trace = false;
  SpaceArguments space;  // its input is set from the verb's FILE
};

const std::vector<std::pair<std::string, io::ColourMap>> colour_maps = {
    {"auto", io::ColourMap::automatic},      {"sequential", io::ColourMap::sequential},
    {"diverging", io::ColourMap::diverging}, {"grey", io::ColourMap::grey},
    {"heat", io::ColourMap::heat},           {"viridis", io::ColourMap::viridis},
    {"cividis", io::ColourMap::cividis}};

const std::vector<std::pair<std::string, io::Shading>> shadings = {
    {"smooth", io::Shading::smooth},
    {"flat", io::Shading::flat},
    {"occluded", io::Shading::occluded}};

struct ShowArguments {
  std::string in, beside, out, field;
  std::vector<std::string> sources;
  io::PictureOptions picture;
  VolumeViewArguments volume;
  TraceArguments trace;
  const CLI::App* verb = nullptr;
  bool edit = false, volume_shown = false;
  int isolines = 20;
  std::string up, view, colour_map = "auto", colour_range, shading = "smooth";
};

/// An axis, as x or -z, or three numbers.
Vec3 direction_of(const std::string& option, const std::string& text) {
  const bool back = text.starts_with('-');
  const std::string axis = text.substr(back || text.starts_with('+') ? 1 : 0);
  if (axis.size() == 1)
    if (const auto k = std::string_view("xyzXYZ").find(axis); k != std::string_view::npos)
      return (back ? -1 : 1) * Vec3::Unit(index(k % 3));
  try {
    return parse_position(option, text);
  } catch (const InputError&) {
    throw InputError("option " + option + ": '" + text +
                         "' is no direction: x, y, z, -x, -y, -z or three numbers X,Y,Z",
                     "option-value");
  }
}

void set_style(io::Scene& scene, const ShowArguments& arguments) {
  scene.isolines = arguments.isolines;
  if (!arguments.up.empty()) scene.up = direction_of("up", arguments.up);
  if (!arguments.view.empty()) scene.towards_eye = direction_of("view", arguments.view);
  if (!arguments.colour_range.empty())
    scene.colour_range = parse_range("colour-range", arguments.colour_range);
  for (const auto& [name, map] : colour_maps)
    if (name == arguments.colour_map) scene.colour_map = map;
  for (const auto& [name, shading] : shadings)
    if (name == arguments.shading) scene.shading = shading;
}

void add_style_options(CLI::App& verb, ShowArguments& arguments) {
  const auto style = in_group("Looks");
  style(verb.add_option("--up", arguments.up,
                        "what points up: x, y, z, -x, -y, -z or X,Y,Z [default: y, or z for what "
                        "stands on z = 0]"))
      ->type_name("AXIS");
  style(verb.add_option("--view", arguments.view,
                        "from where it is seen: an axis or X,Y,Z, from the shape to the eye "
                        "[default: from the front above]"))
      ->type_name("AXIS");
  std::vector<std::string> names;
  for (const auto& [name, map] : colour_maps) names.push_back(name);
  style(verb.add_option(
            "--colour-map", arguments.colour_map,
            "sequential, diverging, grey, heat, viridis, cividis, or auto: diverging where "
            "values are negative somewhere, regions in colours of their own "
            "[default auto]"))
      ->check(one_of(names))
      ->type_name("NAME");
  names.clear();
  for (const auto& [name, shading] : shadings) names.push_back(name);
  style(verb.add_option("--shading", arguments.shading,
                        "smooth, flat: every face as it lies, or occluded: darker where less of "
                        "the sky is seen, so that corners and folds stand out [default smooth]"))
      ->check(one_of(names))
      ->type_name("NAME");
  style(verb.add_option("--colour-range", arguments.colour_range,
                        "values at the ends of the colours [default: what there is]"))
      ->type_name("A,B");
}

void add_volume_view_options(CLI::App& verb, VolumeViewArguments& texts) {
  const auto volumes = in_group("Volumes");
  volumes(verb.add_option("--axis", texts.axis,
                          "the slice is orthogonal to this axis: x, y or z [default z]"))
      ->check(one_of({"x", "y", "z"}))
      ->type_name("A");
  volumes(
      verb.add_option("--slice", texts.position,
                      "where along the axis [length, or with % of the way through the box; default "
                      "50%]; tets are cut open there, without both options where their boundary "
                      "does not show what they hold"))
      ->type_name("P");
  volumes(verb.add_option("--level", texts.level,
                          "the level of the surface shown; with --trace a length, or with % of the "
                          "longest side [default 0, or half way where the values do not pass 0]"))
      ->type_name("L");
  volumes(verb.add_flag("--no-surface", texts.no_surface, "show the slice only"));
}

void add_trace_options(CLI::App& verb, TraceArguments& texts, Session& session) {
  const std::vector<CLI::Option*> before = verb.get_options();
  verb.add_flag("--estimate-normals", texts.space.estimate_normals,
                "of a point cloud: compute normals from neighbouring points");
  verb.add_flag("--flip", session.flip, "reverse all normals: the other side is positive");
  add_space_method(verb, texts.space, "set of points");
  add_shape_options(verb, texts.space);
  add_grid_options(verb, texts.space);
  for (CLI::Option* option : verb.get_options())
    if (std::find(before.begin(), before.end(), option) == before.end() &&
        option->get_group() != method_options_group)
      option->group(trace_group);
  verb.add_flag("--trace", texts.trace,
                "FILE is a mesh, soup, cloud or volume of distance: follow rays through its signed "
                "distance to the surface, or with --level to an offset of it");
}

void check_no_trace_options(const CLI::App& verb) {
  for (const CLI::Option* option : verb.get_options())
    if ((option->get_group() == trace_group || option->get_group() == method_options_group) &&
        option->count() > 0)
      throw InputError("option " + option->get_single_name() + " goes with option trace",
                       "options-conflict");
}

io::Scene volume_scene(const Volume& volume, const std::string& file,
                       const VolumeViewArguments& texts) {
  io::VolumeView view;
  view.axis = texts.axis_number();
  const auto& n = volume.grid.n;
  if (!texts.position.empty())
    view.position =
        texts.slice_at(volume.grid.origin, volume.grid.point(n[0] - 1, n[1] - 1, n[2] - 1));
  if (!texts.level.empty()) view.level = parse_number("level", texts.level);
  view.isosurface = !texts.no_surface;
  return naming(file, [&] { return io::make_volume_scene(volume, view); });
}

io::Scene read_traced_scene(const std::string& file, TraceArguments& texts,
                            const VolumeViewArguments& view, bool for_page, Session& session) {
  texts.space.input = file;
  const CsgShapes shapes = read_shapes(texts.space, session);
  TracedView traced;
  traced.axis = view.axis_number();
  traced.for_page = for_page;
  const InputSize size = [&] { return longest_side(shapes); };
  if (const Box box = bounding_box(shapes); !view.position.empty())
    traced.position = view.slice_at(box.low, box.high);
  if (!view.level.empty()) traced.level = parse_length("level", view.level, size);
  GridOptions request = grid_request(texts.space, size);
  if (!request.resolution && !request.spacing)
    request.resolution = !for_page && traced.position ? slice_nodes : traced_nodes;
  request.padding += std::max(0.0, traced.level) / longest_side(shapes);
  const Grid grid = choose_grid(shapes, request);
  session.reading = false;
  return traced_scene(shapes, grid, traced, session.task(), session.report);
}

io::Scene scene_of(PolygonSoup soup, const ShowArguments& arguments, Session& session) {
  const std::string field = choose_field(soup, arguments.field, arguments.in, true);
  const bool cloud = soup.n_faces() == 0 && soup.lines.empty();
  io::Scene scene =
      io::make_scene(cloud ? cloud_triangles(soup, session.report, session.task()) : soup, field);
  if (!field.empty()) scene.field_name = field;
  if (cloud) io::show_as_discs(scene);
  scene.nodes = cloud ? io::SceneNodes::vertices : io::SceneNodes::faces;
  if (!arguments.sources.empty()) {
    const SurfaceMesh mesh = mesh_of(std::move(soup), arguments.in);
    io::add_sources(scene, mesh, read_all_sources(arguments.sources, mesh, session));
  }
  return scene;
}

/// The boundary, which --slice and --axis cut open; open in any case where it hides what is inside.
io::Scene scene_of(const io::TetFile& file, ShowArguments& arguments, Session& session) {
  const VolumeViewArguments& view = arguments.volume;
  arguments.volume_shown = true;
  const MatX3& x = file.mesh.points;
  io::Scene scene =
      scene_of(view.position.empty() && view.axis.empty()
                   ? drawn_surface(file)
                   : cut_open(file, view.axis_number(),
                              view.slice_at(x.colwise().minCoeff(), x.colwise().maxCoeff())),
               arguments, session);
  scene.nodes = io::SceneNodes::none;  // those of the boundary are numbered anew
  return scene;
}

io::Scene scene_of(const Volume& volume, ShowArguments& arguments, Session&) {
  arguments.volume_shown = true;
  if (!arguments.sources.empty())
    throw InputError(
        "option sources: sources are drawn on surfaces, " + arguments.in + " is a volume",
        "options-conflict");
  return volume_scene(volume, arguments.in, arguments.volume);
}

io::Scene read_scene_of(ShowArguments& arguments, bool for_page, Session& session) {
  if (arguments.trace.trace) {
    if (!arguments.sources.empty() || !arguments.field.empty())
      throw InputError("options --sources and --field do not go with --trace", "options-conflict");
    arguments.volume_shown = true;
    return read_traced_scene(arguments.in, arguments.trace, arguments.volume, for_page, session);
  }
  check_no_trace_options(*arguments.verb);
  return std::visit([&](auto&& held) { return scene_of(std::move(held), arguments, session); },
                    io::read_content(arguments.in, arguments.field));
}

io::Scene read_scene(ShowArguments& arguments, bool for_page, Session& session) {
  io::Scene scene = read_scene_of(arguments, for_page, session);
  io::describe(scene, title_of(arguments.in), session.report);
  set_style(scene, arguments);
  keep_upright(scene, arguments.in);
  naming(arguments.in, [&] { io::check_scene(scene); });
  if (!arguments.beside.empty()) {
    ShowArguments other = arguments;
    other.in = std::exchange(other.beside, "");
    io::Scene second = read_scene_of(other, for_page, session);
    second.title = title_of(other.in);
    set_style(second, other);
    naming(other.in, [&] { io::check_scene(second); });
    arguments.volume_shown |= other.volume_shown;
    scene.beside = std::make_shared<const io::Scene>(std::move(second));
  }
  if (const std::string option = arguments.volume.given();
      !option.empty() && !arguments.volume_shown)
    throw InputError("option " + option + " is of volumes, tets and traced surfaces; " +
                         arguments.in + " is a surface or a cloud",
                     "options-conflict");
  session.reading = false;
  session.task().checkpoint();
  return scene;
}

/// The page as text, by way of a file of its own that nobody else can read.
std::string page_text(const io::Scene& scene) {
  const TemporaryFolder folder("littoral");
  const std::filesystem::path page = folder.path() / "page.html";
  io::write_page(page, scene);
  return io::read_bytes(page);
}

void view(ShowArguments& arguments, Session& session) {
  if (arguments.edit)
    return serve_studio(*arguments.verb, arguments.in, arguments.sources, session);
  if (arguments.out.empty())
    io::format_to_write("page.html", {io::Kind::page});  // is there a viewer?
  else
    check_outputs({arguments.out}, {io::Kind::page});
  const io::Scene scene = read_scene(arguments, true, session);
  session.print_warnings();
  if (arguments.out.empty())
    serve_page(page_text(scene), std::nullopt, session.threads, session.task());
  else
    io::write_page(arguments.out, scene);
}

void render(ShowArguments& arguments, Session& session) {
  check_outputs({arguments.out}, {io::Kind::picture});
  const io::Scene scene = read_scene(arguments, false, session);
  session.print_warnings();
  io::write_picture(arguments.out, scene, arguments.picture);
}

CLI::App& add_show_verb(CLI::App& program, Session& session,
                        std::shared_ptr<ShowArguments> arguments,
                        void (*job)(ShowArguments&, Session&), const char* name, const char* help) {
  CLI::App& verb = add_verb(program, session, arguments, name, help, job);
  add_input_option(verb, "FILE", arguments->in,
                   "a surface or cloud, with values or without: " +
                       io::read_extensions({io::Kind::surface, io::Kind::cloud}) + "; or " +
                       kinds_help({io::Kind::volume}) + "; or the boundary of " +
                       kinds_help({io::Kind::tets}));
  add_repeated_option(verb, "--sources,-s", arguments->sources, "sources to draw; may be repeated")
      ->type_name("FILE");
  verb.add_option("--field", arguments->field,
                  "which values [default: distance, an OBJ's texture u, or the only ones]")
      ->type_name("NAME");
  verb.add_option("--isolines", arguments->isolines,
                  "about how many isolines, 0 to 1000 [default 20]")
      ->check(whole_number(0, 1000))
      ->type_name("N");
  add_style_options(verb, *arguments);
  add_volume_view_options(verb, arguments->volume);
  add_trace_options(verb, arguments->trace, session);
  arguments->verb = &verb;
  add_index_option(verb, session);
  return verb;
}

}  // namespace

void add_view(CLI::App& program, Session& session) {
  auto arguments = std::make_shared<ShowArguments>();
  CLI::App& verb = add_show_verb(program, session, arguments, view, "view",
                                 "a page that shows a result in a browser, also offline");
  verb.add_option("BESIDE", arguments->beside,
                  "a second result, shown beside the first with the same camera; on the same "
                  "surface also their difference")
      ->type_name("");
  verb.add_option("-o,--output", arguments->out,
                  "the page: " + io::written_extensions({io::Kind::page}) +
                      "; without it the page is served on 127.0.0.1 until Ctrl-C")
      ->type_name("OUT");
  verb.add_flag(
      "--edit", arguments->edit,
      "draw sources on FILE in a browser; the distance follows, computed by this program, "
      "which serves the page on 127.0.0.1 until Ctrl-C");
}

void add_render(CLI::App& program, Session& session) {
  auto arguments = std::make_shared<ShowArguments>();
  CLI::App& verb =
      add_show_verb(program, session, arguments, render, "render", "a picture, without a display");
  add_output_option(verb, arguments->out,
                    "the picture: " + io::written_extensions({io::Kind::picture}));
  verb.add_option("--width", arguments->picture.width, "pixels, 16 to 16384 [default 1200]")
      ->check(whole_number(16, 16384))
      ->type_name("N");
  verb.add_option("--height", arguments->picture.height, "pixels, 16 to 16384 [default 900]")
      ->check(whole_number(16, 16384))
      ->type_name("N");
}

}  // namespace littoral::cli
