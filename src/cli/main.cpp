// The command `littoral`: reads arguments, runs a verb, turns errors into exit statuses.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <iostream>
#include <new>
#include <regex>

#include "base/option_table.h"
#include "base/parallel.h"
#include "cli/arguments.h"
#include "cli/interrupt.h"
#include "cli/output.h"
#include "cli/session.h"
#include "cli/verbs/verbs.h"
#include "littoral/error.h"

namespace {

using namespace littoral;

enum Status { done = 0, failed = 1, bad_input = 2 };

/// The library names its parameters: "option time-scale". Those that the verb has as flags get
/// their hyphens here.
std::string with_flags(const std::string& text, const CLI::App& program) {
  static const std::regex named("\\boption ([a-z][a-z-]*[a-z])");
  std::string out;
  auto rest = text.cbegin();
  for (std::sregex_iterator at(text.begin(), text.end(), named), end; at != end; ++at) {
    out.append(rest, (*at)[1].first);
    for (const CLI::App* verb : program.get_subcommands())
      if (verb->get_option_no_throw("--" + (*at)[1].str())) out += "--";
    rest = (*at)[1].first;
  }
  return out.append(rest, text.cend());
}

/// The error as one line, and as an object where a report was asked for.
Status say(cli::Session& session, const CLI::App& program, Status status, const std::string& kind,
           std::string text) {
  session.print_warnings();
  text = with_flags(text, program);
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 32 || c == 127; }, ' ');
  std::fprintf(stderr, "littoral: error: %s\n", text.c_str());
  if (session.json)
    std::cout << failure_json(session.record, session.report, kind, text, status) << std::endl;
  return status;
}

int run(cli::Session& session, const CLI::App& program) {
  const cli::TimeLimit limit(session.cancel, session.time_limit);
  try {
    set_thread_count(session.threads);
    session.job();
    session.print_warnings();
    std::cout.flush();
    if (!std::cout) throw IoError("cannot write to the standard output");
    return done;
  } catch (const Cancelled&) {
    if (limit.passed())
      return say(session, program, failed, "time",
                 "stopped after the time limit of " + number_text(session.time_limit) +
                     " s; nothing was written");
    cli::exit_interrupted();
  } catch (const InputError& e) {
    return say(session, program, bad_input, "input", e.what());
  } catch (const UnsupportedError& e) {
    return say(session, program, bad_input, "unsupported", e.what());
  } catch (const cli::OutputError& e) {
    return say(session, program, failed, "io", e.what());
  } catch (const IoError& e) {
    return say(session, program, session.reading ? bad_input : failed, "io", e.what());
  } catch (const SolveError& e) {
    return say(session, program, failed, "solve", e.what());
  } catch (const std::bad_alloc&) {
    return say(session, program, failed, "memory", "not enough memory");
  } catch (const std::exception& e) {
    return say(session, program, failed, "internal", e.what());
  }
}

}  // namespace

int main(int argc, char** argv) {
  cli::Session session;
  session.record.version = LITTORAL_VERSION;
  CLI::App program("Distance and inside/outside for geometry that is broken.", "littoral");
  program.set_version_flag("--version", "littoral " LITTORAL_VERSION);
  program.require_subcommand(1);
  program.set_help_all_flag("--help-all", "also the options of methods");
  program.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::Throw);
  cli::add_distance(program, session);
  cli::add_pairs(program, session);
  cli::add_winding(program, session);
  cli::add_sdf(program, session);
  cli::add_query(program, session);
  cli::add_fit_tori(program, session);
  cli::add_info(program, session);
  cli::add_convert(program, session);
  cli::add_repair(program, session);
  cli::add_compare(program, session);
  cli::add_contour(program, session);
  cli::add_offset(program, session);
  cli::add_methods(program, session);
  cli::add_formats(program, session);
  cli::add_help(program, session);
  cli::add_completion(program, session);
  cli::add_view(program, session);
  cli::add_render(program, session);
  try {
    std::vector<std::string> arguments = cli::expanded_arguments(argc, argv);
    session.json = std::find(arguments.begin(), arguments.end(), "--json") != arguments.end();
    if (!arguments.empty() && arguments.front().front() != '-')
      session.record.verb = arguments.front();
    cli::check_names(program, arguments);
    std::reverse(arguments.begin(), arguments.end());  // as the parser wants them
    program.parse(std::move(arguments));
  } catch (const CLI::CallForHelp&) {
    std::cout << cli::help_text(program, session.record.verb, false);
    return done;
  } catch (const CLI::CallForAllHelp&) {
    std::cout << cli::help_text(program, session.record.verb, true);
    return done;
  } catch (const CLI::Success& request) {  // --version
    return program.exit(request);
  } catch (const InputError& e) {
    return say(session, program, bad_input, "usage", e.what());
  } catch (const CLI::ParseError& e) {
    std::string verb;
    for (const CLI::App* used : program.get_subcommands()) verb = " " + used->get_name();
    return say(session, program, bad_input, "usage",
               std::string(e.what()) + " (see littoral" + verb + " --help)");
  }
  cli::watch_for_interrupts(session.cancel);
  return run(session, program);
}
