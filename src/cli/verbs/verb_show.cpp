// littoral view and render: pages and pictures of a surface with its field and sources.

#include <unistd.h>

#include <iostream>
#include <memory>

#include "api/tet/tet_boundary.h"
#include "base/platform/temporary_folder.h"
#include "cli/input/surface_input.h"
#include "cli/input/trace_input.h"
#include "cli/input/volume_input.h"
#include "cli/output.h"
#include "cli/serve.h"
#include "cli/verbs/verbs.h"
#include "domain/cloud/cloud_surface.h"
#include "io/read.h"
#include "io/render/picture.h"
#include "io/render/scene.h"
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

io::Scene scene_of(PolygonSoup soup, const Arguments& arguments, Session& session) {
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

/// The boundary, which --slice cuts open.
io::Scene scene_of(const io::TetFile& file, const Arguments& arguments, Session& session) {
  const VolumeViewArguments& view = arguments.volume;
  return scene_of(view.position.empty() ? boundary_of(file)
                                        : cut_open(file, view.axis_number(), view.slice_at()),
                  arguments, session);
}

io::Scene scene_of(const Volume& volume, const Arguments& arguments, Session&) {
  if (!arguments.sources.empty())
    throw InputError("option sources: sources are drawn on surfaces, " + arguments.in +
                     " is a volume");
  return volume_scene(volume, arguments.in, arguments.volume);
}

io::Scene read_scene_of(Arguments& arguments, bool for_page, Session& session) {
  if (arguments.trace.trace) {
    if (!arguments.sources.empty() || !arguments.field.empty())
      throw InputError("options --sources and --field do not go with --trace");
    return read_traced_scene(arguments.in, arguments.trace, arguments.volume, for_page, session);
  }
  check_no_trace_options(*arguments.verb);
  return std::visit([&](auto&& held) { return scene_of(std::move(held), arguments, session); },
                    io::read_content(arguments.in, arguments.field));
}

io::Scene read_scene(Arguments& arguments, bool for_page, Session& session) {
  io::Scene scene = read_scene_of(arguments, for_page, session);
  describe(scene, arguments.in, session.report);
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
  check_outputs({arguments.out.empty() ? "page.html" : arguments.out}, {io::Kind::page});
  const io::Scene scene = read_scene(arguments, true, session);
  session.print_warnings();
  if (arguments.out.empty())
    serve_page(page_text(scene), session.task());
  else
    io::write_page(arguments.out, scene);
}

void render(Arguments& arguments, Session& session) {
  check_outputs({arguments.out}, {io::Kind::picture});
  const io::Scene scene = read_scene(arguments, false, session);
  session.print_warnings();
  io::write_picture(arguments.out, scene, arguments.picture);
}

CLI::App& add_show_verb(CLI::App& program, Session& session, std::shared_ptr<Arguments> arguments,
                        void (*job)(Arguments&, Session&), const char* name, const char* help) {
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
      ->check(CLI::Range(0, 1000).description(""))
      ->type_name("N");
  add_volume_view_options(verb, arguments->volume);
  add_trace_options(verb, arguments->trace, session);
  arguments->verb = &verb;
  add_index_option(verb, session);
  return verb;
}

}  // namespace

void add_view(CLI::App& program, Session& session) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App& verb = add_show_verb(program, session, arguments, view, "view",
                                 "a page that shows a result in a browser, also offline");
  verb.add_option("-o,--output", arguments->out,
                  "the page: " + io::written_extensions({io::Kind::page}) +
                      "; without it the page is served on 127.0.0.1 until Ctrl-C")
      ->type_name("OUT");
}

void add_render(CLI::App& program, Session& session) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App& verb =
      add_show_verb(program, session, arguments, render, "render", "a picture, without a display");
  add_output_option(verb, arguments->out,
                    "the picture: " + io::written_extensions({io::Kind::picture}));
  verb.add_option("--width", arguments->picture.width, "pixels, 16 to 16384 [default 1200]")
      ->type_name("N");
  verb.add_option("--height", arguments->picture.height, "pixels, 16 to 16384 [default 900]")
      ->type_name("N");
}

}  // namespace littoral::cli
