// littoral view and render: pages and pictures of a surface with its field and sources.

#include <iostream>
#include <memory>

#include "base/platform/temporary_folder.h"
#include "cli/input/surface_input.h"
#include "cli/input/tet_input.h"
#include "cli/input/trace_input.h"
#include "cli/input/volume_input.h"
#include "cli/serve.h"
#include "cli/verbs/verbs.h"
#include "domain/cloud/cloud_surface.h"
#include "io/read.h"
#include "io/render/picture.h"
#include "io/render/scene.h"
#include "io/volume/volume.h"
#include "littoral/error.h"

namespace littoral::cli {

namespace {

struct Arguments {
  std::string in, out, field;
  std::vector<std::string> sources;
  io::PictureOptions picture;
  VolumeViewArguments volume;
  TraceArguments trace;
  const CLI::App* verb = nullptr;
  int isolines = 20;
};

/// A surface or cloud, or the boundary of tets, which --slice cuts open.
PolygonSoup read_shown(const Arguments& arguments) {
  if (!io::is_tets(arguments.in)) return io::read_surface(arguments.in);
  const io::TetFile file = io::read_tets(arguments.in);
  const VolumeViewArguments& view = arguments.volume;
  return view.position.empty() ? boundary_of(file)
                               : cut_open(file, view.axis_number(), view.slice_at());
}

io::Scene read_scene_of(Arguments& arguments, bool for_page, Session& session) {
  if (arguments.trace.trace) {
    if (!arguments.sources.empty() || !arguments.field.empty())
      throw InputError("options --sources and --field do not go with --trace");
    return read_traced_scene(arguments.in, arguments.trace, arguments.volume, for_page, session);
  }
  check_no_trace_options(*arguments.verb);
  if (io::is_volume(arguments.in)) {
    if (!arguments.sources.empty())
      throw InputError("option --sources: sources are drawn on surfaces, " + arguments.in +
                       " is a volume");
    return read_volume_scene(arguments.in, arguments.field, arguments.volume);
  }
  PolygonSoup soup = read_shown(arguments);
  const std::string field = choose_field(soup, arguments.field, arguments.in, true);
  const bool cloud = soup.n_faces() == 0 && soup.lines.empty();
  io::Scene scene =
      io::make_scene(cloud ? cloud_triangles(soup, session.report, session.task()) : soup, field);
  if (!field.empty()) scene.field_name = field;
  if (!arguments.sources.empty()) {
    const SurfaceMesh mesh = mesh_of(std::move(soup), arguments.in);
    io::add_sources(scene, mesh, read_all_sources(arguments.sources, mesh, session));
  }
  return scene;
}

io::Scene read_scene(Arguments& arguments, bool for_page, Session& session) {
  io::Scene scene = read_scene_of(arguments, for_page, session);
  scene.title = std::filesystem::path(arguments.in).stem().string();
  scene.isolines = arguments.isolines;
  io::check_scene(scene);
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

void view(Arguments& arguments, Session& session) {
  check_output(arguments.out.empty() ? "page.html" : arguments.out, {".html"}, "a page");
  const io::Scene scene = read_scene(arguments, true, session);
  session.print_warnings();
  if (arguments.out.empty())
    serve_page(page_text(scene), session.task());
  else
    io::write_page(arguments.out, scene);
}

void render(Arguments& arguments, Session& session) {
  check_output(arguments.out, {".png"}, "a picture");
  const io::Scene scene = read_scene(arguments, false, session);
  session.print_warnings();
  io::write_picture(arguments.out, scene, arguments.picture);
}

using Job = void (*)(Arguments&, Session&);

CLI::App& add_verb(CLI::App& program, Session& session, std::shared_ptr<Arguments> arguments,
                   Job job, const char* name, const char* help) {
  CLI::App* verb = program.add_subcommand(name, help);
  verb->add_option(
          "FILE", arguments->in,
          "a surface or cloud, with values or without: .obj .ply .off .stl .pc .xyz .pcd; or a "
          "volume: .vti .nrrd .npy .vol; or the boundary of tets: .mesh .vtk .tet")
      ->required()
      ->type_name("");
  verb->add_option("--sources,-s", arguments->sources, "sources to draw; may be repeated")
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->type_name("FILE");
  verb->add_option("--field", arguments->field,
                   "which values [default: distance, an OBJ's texture u, or the only ones]")
      ->type_name("NAME");
  verb->add_option("--isolines", arguments->isolines,
                   "about how many isolines, 0 to 1000 [default 20]")
      ->check(CLI::Range(0, 1000).description(""))
      ->type_name("N");
  add_volume_view_options(*verb, arguments->volume);
  add_trace_options(*verb, arguments->trace, session);
  arguments->verb = verb;
  add_index_option(*verb, session);
  add_common_options(*verb, session);
  verb->callback([=, &session] { session.job = [=, &session] { job(*arguments, session); }; });
  return *verb;
}

}  // namespace

void add_view(CLI::App& program, Session& session) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App& verb = add_verb(program, session, arguments, view, "view",
                            "a page that shows a result in a browser, also offline");
  verb.add_option("-o,--output", arguments->out,
                  "the page: .html; without it the page is served on 127.0.0.1 until Ctrl-C")
      ->type_name("OUT");
}

void add_render(CLI::App& program, Session& session) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App& verb =
      add_verb(program, session, arguments, render, "render", "a picture, without a display");
  verb.add_option("-o,--output", arguments->out, "the picture: .png")->required()->type_name("OUT");
  verb.add_option("--width", arguments->picture.width, "pixels, 16 to 16384 [default 1200]")
      ->type_name("N");
  verb.add_option("--height", arguments->picture.height, "pixels, 16 to 16384 [default 900]")
      ->type_name("N");
}

}  // namespace littoral::cli
