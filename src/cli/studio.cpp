#include "cli/studio.h"

#include "cli/serve.h"
#include "cli/studio_page.h"
#include "littoral/io.h"

namespace littoral::cli {

#ifndef LITTORAL_HAS_STUDIO
std::string_view studio_page() { return {}; }
#endif

void serve_studio(const CLI::App& verb, const std::string& surface,
                  const std::vector<std::string>& sources, Session& session) {
  for (const CLI::Option* option : verb.get_options())
    if (option->count() > 0 && option->get_group() != common_options_group &&
        option->get_name() != "FILE" && !option->check_name("--sources") &&
        !option->check_name("--edit"))
      throw InputError("option " + option->get_single_name() +
                           " does not go with --edit: it is chosen in the page",
                       "options-conflict");
  if (studio_page().empty())
    throw UnsupportedError(
        "option --edit: this build lacks the studio (configure with LITTORAL_VIEWER=ON and npm "
        "installed); the studio that `make web` builds needs no program",
        "cannot-write");
  desk::Given given{surface, {sources.begin(), sources.end()}};
  {  // What cannot be read is said here, not in the page.
    Context context;
    context.threads = session.threads;
    context.cancel = session.cancel;
    const Mesh mesh = desk::surface_of_file(surface, context);
    for (const std::string& file : sources) littoral::read_sources(file, mesh);
  }
  session.reading = false;
  serve_page(std::string(studio_page()), given, session.threads, session.task());
}

}  // namespace littoral::cli
