#pragma once
// What all verbs share: common options, messages on stderr, progress and cancellation.

#include <CLI/CLI.hpp>
#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "api/report_json.h"
#include "base/task.h"
#include "io/formats.h"
#include "littoral/report.h"

namespace littoral::cli {

/// The state of one run of the program.
struct Session {
  // options
  std::string progress = "auto";
  int threads = 0;
  double time_limit = 0;  // [seconds]; 0: none
  bool json = false, verbose = false, quiet = false, flip = false, dry_run = false;
  std::string log_file;
  bool result_to_stdout = false;
  std::optional<int> index_base;

  std::function<void()> job;  // the verb's work, set when its arguments have been read
  bool reading = true;        // a file error is then the input's fault (exit status 2, not 1)
  CancelToken cancel;
  Report report;
  RunRecord record;
  std::vector<std::string> verb_words;  // of `batch`: the options of the verb that it runs
  struct Failure {
    std::string kind, message;
  };
  std::optional<Failure> failure;  // what was said at the end

  int status = 0;  // of a run without an error
  const CLI::App* program = nullptr;

  /// The library names its parameters, "raise option resolution". Flags of the verb are that here:
  /// "raise --resolution", and at the beginning "option --resolution"; those of another verb name
  /// it: "raise --resolution of littoral sdf". `about`: the verb that a text is about, if not the
  /// one that runs.
  std::string with_flags(const std::string& text, const std::string& about = "") const;

  /// Draws progress on stderr; empty where nobody asked for it.
  Task::Callback progress_callback();
  /// A task that draws progress on stderr where asked for, and stops on interrupts.
  Task task();
  /// Removes the progress line.
  void end_progress();
  /// One line on stderr and in the log: "littoral: TEXT".
  void say_line(const std::string& text);
  /// The same for what is good to know, unless --quiet.
  void note(const std::string& text);
  /// Opens the log. Throws IoError.
  void begin_log();
  /// Where reports and facts go: standard output, unless a result does.
  std::ostream& facts() const;
  /// Prints the report's warnings that have not been printed yet, and keeps them as printed.
  void print_warnings();
  /// Prints method, options, sizes and timings on stderr.
  void print_details() const;
  /// What a verb says at its end: warnings, details, and the report as JSON where asked for.
  void print_report();

 private:
  using Clock = std::chrono::steady_clock;
  void log_line(const std::string& text);

  Clock::time_point begin_ = Clock::now();
  std::shared_ptr<std::ofstream> log_;
  bool drawn_ = false;
  std::size_t warned_ = 0;
};

/// What those of all verbs stand under in --help.
inline constexpr const char* common_options_group = "Common options";
/// Adds --threads, --progress, --verbose and --quiet.
void add_common_options(CLI::App& verb, Session& session);
/// What puts options under a heading of --help.
inline auto in_group(const char* heading) {
  return [heading](CLI::Option* option) { return option->group(heading); };
}
/// Adds an option that may be given several times, one value each.
template <class T>
CLI::Option* add_repeated_option(CLI::App& verb, const std::string& names, std::vector<T>& values,
                                 const std::string& help) {
  return verb.add_option(names, values, help)
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}
/// Accepts one of these words; the message for another one names the nearest.
CLI::Validator one_of(const std::vector<std::string>& words);
/// Accepts whole numbers, or any numbers, from `low` to `high`.
CLI::Validator whole_number(long long low, long long high);
CLI::Validator number_between(double low, double high);
/// Accepts any word, so that another check may say more; shells complete these.
CLI::Validator among(const std::vector<std::string>& words);
/// What checks the values of an option.
std::vector<const CLI::Validator*> validators_of(CLI::Option& option);
/// The words that `one_of` or `among` gave to an option, separated by spaces; empty if neither did.
std::string words_to_complete(CLI::Option& option);
/// Text without line breaks and other control characters, which readers of lines stumble over.
std::string one_line(std::string text);
/// Adds --json.
void add_json_option(CLI::App& verb, Session& session);
/// Adds --index-base.
void add_index_option(CLI::App& verb, Session& session);

/// Adds the file that a verb is about.
CLI::Option* add_input_option(CLI::App& verb, const std::string& name, std::string& file,
                              const std::string& help);
/// "a surface .obj .ply, tets .mesh"
std::string kinds_help(const io::Kinds& kinds);

/// Notes the files that were named, by what the options say of their values.
void record_files(const CLI::App& verb, Session& session);

/// Adds a verb that runs `job(arguments, session)`.
template <class Arguments, class Job>
CLI::App& add_verb(CLI::App& program, Session& session, std::shared_ptr<Arguments> arguments,
                   const char* name, const std::string& help, Job job) {
  CLI::App* verb = program.add_subcommand(name, help);
  add_common_options(*verb, session);
  verb->callback([=, &session] {
    record_files(*verb, session);
    session.job = [=, &session] { job(*arguments, session); };
  });
  return *verb;
}

}  // namespace littoral::cli
