#include "cli/program.h"

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <new>

#include "base/option_table.h"
#include "base/parallel.h"
#include "base/platform/memory.h"
#include "cli/arguments.h"
#include "cli/interrupt.h"
#include "cli/output.h"
#include "cli/verbs/verbs.h"
#include "littoral/error.h"

namespace littoral::cli {

namespace {

enum Status { done = 0, failed = 1, bad_input = 2 };

/// The error as one line with its code, and as an object where a report was asked for.
Status say(Session& session, Status status, const std::string& kind, const std::string& code,
           std::string text) {
  session.print_warnings();
  text = one_line(session.with_flags(text));
  session.say_line("error: " + text + " [" + code + "]");
  session.failure = {kind, text};
  if (session.json)
    session.facts() << failure_json(session.record, session.report, {kind, code, text, status})
                    << std::endl;
  return status;
}

int run_job(Session& session) {
  TimeLimit limit;
  try {
    limit.begin(session.cancel, session.time_limit);
    set_thread_count(session.threads);
    session.begin_log();
    session.job();
    session.print_warnings();
    std::cout.flush();
    if (!std::cout) throw IoError("cannot write to the standard output", "cannot-write");
    return session.status;
  } catch (const Cancelled&) {
    if (limit.passed())
      return say(session, failed, "time", "time-limit",
                 "stopped after the time limit of " + number_text(session.time_limit) +
                     " s; nothing was written");
    exit_interrupted();
  } catch (const InputError& e) {
    return say(session, bad_input, "input", e.code(), e.what());
  } catch (const UnsupportedError& e) {
    return say(session, bad_input, "unsupported", e.code(), e.what());
  } catch (const OutputError& e) {
    return say(session, failed, "io", e.code(), e.what());
  } catch (const IoError& e) {
    const std::string kind = is_about_memory(e) ? "memory" : "io";
    const bool by_input = session.reading && e.code() != "system";
    return say(session, by_input ? bad_input : failed, kind, e.code(), e.what());
  } catch (const SolveError& e) {
    return say(session, failed, "solve", e.code(), e.what());
  } catch (const std::bad_alloc&) {
    return say(session, failed, "memory", "too-large", "not enough memory");
  } catch (const std::exception& e) {
    return say(session, failed, "internal", "internal", e.what());
  }
}

/// Words that `app` parses, in the order in which they stand.
void parse(CLI::App& app, std::vector<std::string> words) {
  std::reverse(words.begin(), words.end());  // as the parser wants them
  app.parse(std::move(words));
}

}  // namespace

Program::Program() : app_("Distance and inside/outside for geometry that is broken.", "littoral") {
  session_.record.version = LITTORAL_VERSION;
  session_.program = &app_;
  app_.set_version_flag("--version", "littoral " LITTORAL_VERSION);
  app_.require_subcommand(1);
  app_.set_help_all_flag("--help-all", "also the options of methods");
  app_.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::Throw);
  add_distance(app_, session_);
  add_pairs(app_, session_);
  add_winding(app_, session_);
  add_sdf(app_, session_);
  add_query(app_, session_);
  add_fit_tori(app_, session_);
  add_info(app_, session_);
  add_convert(app_, session_);
  add_repair(app_, session_);
  add_compare(app_, session_);
  add_contour(app_, session_);
  add_offset(app_, session_);
  add_samples(app_, session_);
  add_batch(app_, session_);
  add_view(app_, session_);
  add_render(app_, session_);
  add_methods(app_, session_);
  add_formats(app_, session_);
  add_completion(app_, session_);
  add_help(app_, session_);
}

void Program::read(std::vector<std::string> arguments) {
  arguments = expanded_arguments(app_, std::move(arguments));
  check_names(app_, arguments);
  try {
    parse(app_, arguments);
  } catch (const CLI::ParseError& e) {
    std::string code;
    const std::string text = refused_text(e, app_, arguments, code);
    throw InputError(text, code);
  }
}

int Program::run(std::vector<std::string> arguments, Signals signals) {
  try {
    const std::vector<std::string> doubtful = doubtful_lists(app_, arguments);
    arguments = expanded_arguments(app_, std::move(arguments));
    session_.json = std::find(arguments.begin(), arguments.end(), "--json") != arguments.end();
    if (!arguments.empty() && arguments.front().front() != '-')
      session_.record.verb = arguments.front();
    if (session_.record.verb == batch_verb)
      arguments = without_words_of_verb(app_, std::move(arguments), session_.verb_words);
    session_.result_to_stdout =
        std::ranges::any_of(check_names(app_, arguments), io::is_standard_stream);
    parse(app_, arguments);
    for (const std::string& text : doubtful) session_.report.warn("decimal-comma", text);
  } catch (const CLI::CallForHelp&) {
    std::cout << help_text(app_, session_.record.verb, false);
    return done;
  } catch (const CLI::CallForAllHelp&) {
    std::cout << help_text(app_, session_.record.verb, true);
    return done;
  } catch (const CLI::Success& request) {  // --version
    return app_.exit(request);
  } catch (const InputError& e) {
    return say(session_, bad_input, "usage", e.code(), e.what());
  } catch (const CLI::ParseError& e) {
    std::string code;
    const std::string text = refused_text(e, app_, arguments, code);
    return say(session_, bad_input, "usage", code, text);
  }
  if (signals == Signals::watched) watch_for_interrupts(session_.cancel);
  return run_job(session_);
}

}  // namespace littoral::cli
