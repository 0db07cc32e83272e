#include "cli/session.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <limits>
#include <regex>
#include <string_view>

#include "base/option_table.h"
#include "base/platform/process.h"
#include "cli/input/numbers.h"
#include "cli/output.h"
#include "io/write.h"
#include "littoral/error.h"

namespace littoral::cli {

namespace {

/// "12 s left" once enough is done to tell; nothing before, nor where the stage says it.
std::string remaining_text(double fraction, double seconds, const std::string& stage) {
  constexpr double known_from = 0.05, soon = 2;
  if (fraction < known_from || fraction >= 1 || seconds < soon || stage.ends_with(" left"))
    return "";
  const double left = std::ceil(seconds * (1 - fraction) / fraction);
  if (left < 100) return ", about " + number_text(left) + " s left";
  return ", about " + number_text(std::ceil(left / 60)) + " min left";
}

void draw_progress(double fraction, const std::string& stage) {
  constexpr int width = 30;
  const int done = static_cast<int>(std::lround(fraction * width));
  const std::string bar =
      std::string(std::size_t(done), '#') + std::string(std::size_t(width - done), '.');
  std::fprintf(stderr, "\r\033[K[%s] %3.0f %% %s", bar.c_str(), fraction * 100, stage.c_str());
  std::fflush(stderr);
}

}  // namespace

std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < 32 || c == 127; }, ' ');
  return text;
}

namespace {

/// The verb that has an option: the one that runs, or else the first one; empty where none does.
std::string verb_with(const CLI::App& program, const std::string& flag, const std::string& runs) {
  std::string found;
  for (const CLI::App* verb : program.get_subcommands([](const CLI::App*) { return true; })) {
    if (!verb->get_option_no_throw(flag)) continue;
    if (verb->get_name() == runs) return runs;
    if (found.empty()) found = verb->get_name();
  }
  return found;
}

}  // namespace

std::string Session::with_flags(const std::string& text, const std::string& about) const {
  const std::string& here = about.empty() ? record.verb : about;
  static const std::regex named("\\boption ([a-z][a-z-]*[a-z])");
  std::string out;
  auto rest = text.cbegin();
  for (std::sregex_iterator at(text.begin(), text.end(), named), end; at != end; ++at) {
    const std::string flag = "--" + (*at)[1].str();
    const std::string verb = program ? verb_with(*program, flag, here) : "";
    const auto [begin, next] = std::pair((*at)[0].first, (*at)[0].second);
    const bool begins = begin == text.cbegin() || (next != text.cend() && *next == ':');
    const bool own = verb == here, known = !verb.empty() && (own || !begins);
    out.append(rest, known && !begins ? begin : (*at)[1].first);
    if (known) out += "--";
    out.append((*at)[1].first, next);
    if (known && !own) out += " of littoral " + verb;
    rest = next;
  }
  return out.append(rest, text.cend());
}

Task::Callback Session::progress_callback() {
  const bool wanted =
      progress == "always" || (progress == "auto" && !quiet && errors_go_to_terminal());
  if (!wanted && !log_) return {};
  return [this, wanted, last = Clock::time_point(), stage_before = std::string()](
             double fraction, const std::string& stage) mutable {
    const auto now = Clock::now();
    if (log_ && stage != stage_before) log_line(stage);
    if (stage == stage_before && now - last < std::chrono::milliseconds(50)) return;
    last = now;
    stage_before = stage;
    if (!wanted) return;
    drawn_ = true;
    const double seconds = std::chrono::duration<double>(now - begin_).count();
    draw_progress(fraction, stage + remaining_text(fraction, seconds, stage));
  };
}

Task Session::task() { return Task(cancel, progress_callback()); }

void Session::end_progress() {
  if (drawn_) std::fputs("\r\033[K", stderr);
  drawn_ = false;
}

void Session::say_line(const std::string& text) {
  const std::string line = one_line(text);
  std::fprintf(stderr, "littoral: %s\n", line.c_str());
  log_line(line);
}

void Session::note(const std::string& text) {
  end_progress();
  if (quiet)
    log_line(text);
  else
    say_line(text);
}

void Session::begin_log() {
  if (log_file.empty()) return;
  check_before([&] { io::check_writable(log_file); });
  log_ = std::make_shared<std::ofstream>(log_file, std::ios::app);
  if (!*log_) throw OutputError("cannot write " + log_file, "cannot-write");
  log_line("littoral " LITTORAL_VERSION " " + record.verb + " " + listed(record.inputs));
}

std::ostream& Session::facts() const { return result_to_stdout ? std::cerr : std::cout; }

void Session::log_line(const std::string& text) {
  if (!log_) return;
  char time[32];
  std::snprintf(time, sizeof time, "%9.3f s  ",
                std::chrono::duration<double>(Clock::now() - begin_).count());
  *log_ << time << one_line(text) << std::endl;
}

void Session::print_warnings() {
  end_progress();
  for (; warned_ < report.warnings.size(); ++warned_) {
    auto& [code, text] = report.warnings[warned_];
    text = with_flags(text);
    const std::string line = "warning: " + text + " [" + code + "]";
    quiet ? log_line(line) : say_line(line);
  }
}

void Session::print_report() {
  print_warnings();
  print_details();
  if (json) facts() << run_json(record, report) << "\n";
}

void Session::print_details() const {
  if (!verbose) return;
  std::fprintf(stderr, "method: %s on a %s\n", report.method.c_str(), report.domain.c_str());
  for (const auto& [name, text] : report.options)
    std::fprintf(stderr, "option %s: %s\n", name.c_str(), text.c_str());
  for (const auto* list : {&report.sizes, &report.iterations, &report.residuals})
    for (const auto& [name, value] : *list)
      std::fprintf(stderr, "%s: %s\n", name.c_str(), number_text(value).c_str());
  for (const auto& [stage, seconds] : report.timings)
    std::fprintf(stderr, "%s: %.3f s\n", stage.c_str(), seconds);
}

namespace {

bool is_same_file(const std::string& a, const std::string& b) {
  std::error_code none;
  return a == b || std::filesystem::equivalent(a, b, none);
}

/// A result must not replace what is read, or another result, and nor must the log be added to it.
void check_files(const RunRecord& record, const std::string& log) {
  const auto& in = record.inputs;
  for (std::size_t i = 0; i < in.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      if (io::is_standard_stream(in[i]) && io::is_standard_stream(in[k]))
        throw InputError(in[k] + " and " + in[i] + ": standard input can be read as one file only",
                         "usage");
  const auto& out = record.outputs;
  for (std::size_t i = 0; i < out.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k)
      if (is_same_file(out[k], out[i]) ||
          (io::is_standard_stream(out[k]) && io::is_standard_stream(out[i])))
        throw InputError(out[k] + " and " + out[i] + " are one output: name it once", "usage");
    for (const std::string& input : in)
      if (!io::is_standard_stream(input) && is_same_file(input, out[i]) &&
          std::filesystem::is_regular_file(input))
        throw InputError("the output " + out[i] + " would replace the input: name another file",
                         "cannot-write");
  }
  for (const auto* files : {&in, &out})
    for (const std::string& file : *files)
      if (!log.empty() && is_same_file(file, log))
        throw InputError("option log: " + log + " is a file of the " +
                             (files == &in ? "input" : "results") + ": name another",
                         "cannot-write");
}

}  // namespace

void record_files(const CLI::App& verb, Session& session) {
  session.record.verb = verb.get_name();
  for (const CLI::Option* option : verb.get_options()) {
    const bool input = option->get_positional() || option->get_type_name() == "FILE";
    if (!input && option->get_type_name() != "OUT") continue;
    auto& files = input ? session.record.inputs : session.record.outputs;
    files.insert(files.end(), option->results().begin(), option->results().end());
  }
  check_files(session.record, session.log_file);
}

void add_common_options(CLI::App& verb, Session& session) {
  verb.add_option("--threads", session.threads,
                  "threads to use, 0 to 4096; 0: all cores [default 0]")
      ->check(whole_number(0, 4096))
      ->type_name("N");
  verb.add_option("--progress", session.progress,
                  "a bar on stderr: auto (if it is a terminal), always, never [default auto]")
      ->check(one_of({"auto", "always", "never"}))
      ->type_name("WHEN");
  verb.add_option("--time-limit", session.time_limit,
                  "end with an error after this time, 0 to 1e9; 0: never [seconds; default 0]")
      ->check(number_between(0, 1e9))
      ->type_name("S");
  verb.add_option("--log", session.log_file,
                  "add stages with their times, warnings and errors to the end of this file")
      ->type_name("LOG");
  verb.add_flag("--verbose", session.verbose, "say more on stderr");
  verb.add_flag("--quiet", session.quiet, "no warnings, no progress");
  for (const char* name :
       {"--threads", "--progress", "--time-limit", "--log", "--verbose", "--quiet"})
    verb.get_option(name)->group(common_options_group);
}

void add_json_option(CLI::App& verb, Session& session) {
  verb.add_flag("--json", session.json, "print one JSON value to stdout");
}

void add_index_option(CLI::App& verb, Session& session) {
  verb.add_option("--index-base", session.index_base,
                  "what sources and --vertex count from: 0 or 1 [default: as the format has it]")
      ->check(whole_number(0, 1))
      ->type_name("0|1");
}

namespace {

constexpr std::string_view words_mark = "words";  // begins the names of validators that know some

std::string name_with(const std::vector<std::string>& words) {
  std::string name(words_mark);
  for (const std::string& word : words) name += " " + word;
  return name;
}

}  // namespace

CLI::Validator one_of(const std::vector<std::string>& words) {
  return CLI::Validator(
             [words](const std::string& word) {
               if (std::find(words.begin(), words.end(), word) != words.end()) return std::string();
               return "'" + word + "' is none of " + listed(words) + meant(word, words);
             },
             "")
      .name(name_with(words));
}

CLI::Validator whole_number(long long low, long long high) {
  return CLI::Validator(
      [low, high](const std::string& text) -> std::string {
        const char* const last = text.data() + text.size();
        long long value = 0;
        const auto [stop, code] = std::from_chars(text.data(), last, value);
        if (code == std::errc() && stop == last && low <= value && value <= high) return "";
        return "'" + text + "' is no whole number" +
               (high == std::numeric_limits<long long>::max()
                    ? ""
                    : " from " + std::to_string(low) + " to " + std::to_string(high));
      },
      "");
}

CLI::Validator number_between(double low, double high) {
  return CLI::Validator(
      [low, high](const std::string& text) -> std::string {
        try {
          if (const double value = parse_number("", text); low <= value && value <= high) return "";
        } catch (const InputError&) {
        }
        return "'" + text + "' is no number from " + number_text(low) + " to " + number_text(high);
      },
      "");
}

CLI::Validator among(const std::vector<std::string>& words) {
  return CLI::Validator([](const std::string&) { return std::string(); }, "")
      .name(name_with(words));
}

std::vector<const CLI::Validator*> validators_of(CLI::Option& option) {
  std::vector<const CLI::Validator*> out;
  try {
    for (int i = 0;; ++i) out.push_back(option.get_validator(i));
  } catch (const CLI::OptionNotFound&) {  // there are no more
    return out;
  }
}

std::string words_to_complete(CLI::Option& option) {
  for (const CLI::Validator* check : validators_of(option))
    if (const std::string& name = check->get_name(); name.starts_with(words_mark))
      return name.substr(std::min(name.size(), words_mark.size() + 1));
  return "";
}

CLI::Option* add_input_option(CLI::App& verb, const std::string& name, std::string& file,
                              const std::string& help) {
  return verb.add_option(name, file, help)->required()->type_name("");
}

std::string kinds_help(const io::Kinds& kinds) {
  std::string out;
  for (const io::Kind kind : kinds)
    out += (out.empty() ? "" : ", ") + io::kinds_text({kind}) + " " + io::read_extensions({kind});
  return out;
}

}  // namespace littoral::cli
