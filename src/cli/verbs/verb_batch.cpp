// littoral batch: another verb for each of many inputs, in processes of their own.

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "cli/arguments.h"
#include "cli/batch/job_list.h"
#include "cli/program.h"
#include "cli/verbs/verbs.h"
#include "io/formats.h"
#include "littoral/batch.h"
#include "littoral/error.h"

namespace littoral::cli {

namespace {

struct BatchArguments {
  std::string jobs, verb = default_batch_verb, shard;
  std::vector<std::string> to;
  BatchOptions options;
  int threads = 1;
};

using Words = std::vector<std::string>;

/// What a verb writes for each input where nobody says it.
Words usual_extensions(const std::string& verb) {
  static const std::map<std::string, std::string> usual{
      {"distance", ".ply"}, {"sdf", ".npz"},     {"query", ".csv"},    {"winding", ".obj"},
      {"offset", ".ply"},   {"contour", ".ply"}, {"fit-tori", ".ply"}, {"pairs", ".npy"},
      {"view", ".html"},    {"render", ".png"},  {"samples", ".npz"},  {"repair", ".ply"}};
  const auto found = usual.find(verb);
  return found == usual.end() ? Words{} : Words{found->second};
}

bool has_option(const CLI::App& verb, const std::string& name) {
  return verb.get_option_no_throw(name) != nullptr;
}

/// Throws unless the verb takes one input.
void check_verb(const CLI::App& verb) {
  int inputs = 0;
  for (const CLI::Option* option : verb.get_options())
    if (option->get_positional() && option->get_required()) ++inputs;
  if (inputs == 1 && verb.get_name() != "help" && verb.get_name() != "completion" &&
      verb.get_name() != batch_verb)
    return;
  throw InputError("option verb: batch is for verbs of one input, and " + verb.get_name() +
                       (inputs > 1 ? " takes " + std::to_string(inputs) : " takes no file"),
                   "options-conflict");
}

/// The words of both, where those of the line replace the others of the same option.
Words overridden(const CLI::App& verb, const Words& all, const Words& line) {
  const auto option = [&](const std::string& word) {
    return verb.get_option_no_throw(word.substr(0, word.find('=')));
  };
  Words out;
  for (const std::string& word : all) {
    bool again = false;
    for (const std::string& other : line) again = again || option(other) == option(word);
    if (!again) out.push_back(word);
  }
  out.insert(out.end(), line.begin(), line.end());
  return out;
}

/// What a line of a list may hold beside the verb's options; and what becomes of it.
class JobMaker {
 public:
  JobMaker(const BatchArguments& arguments, const Words& verb_words)
      : arguments_(arguments), verb_words_(verb_words), program_(std::make_unique<Program>()) {
    line_.add_option("--verb", verb_);
    line_.add_option("--name", name_);
    line_.add_option("--to", to_)->allow_extra_args(false);
  }

  BatchJob operator()(const ListedJob& listed) {
    try {
      return made(listed);
    } catch (const CLI::ParseError& e) {
      throw InputError(listed.line + e.what(), "usage");
    } catch (const InputError& e) {
      throw InputError(listed.line + e.what(), e.code());
    }
  }

 private:
  BatchJob made(const ListedJob& listed) {
    Words own, of_verb;
    verb_ = arguments_.verb;
    name_.clear();
    to_.clear();
    if (!listed.words.empty()) {
      const Words words = expanded_arguments(program_->app(), listed.words);
      for (const std::string& word : words)
        if (word.rfind("--verb=", 0) == 0) verb_ = word.substr(7);
      own = separate_words(line_, verb_named(program_->app(), verb_), words, of_verb);
      std::reverse(own.begin(), own.end());
      line_.parse(own);
      Words checked{verb_};
      checked.insert(checked.end(), of_verb.begin(), of_verb.end());
      check_names(program_->app(), checked);
    }
    const CLI::App& verb = verb_named(program_->app(), verb_);
    check_verb(verb);
    if (verb_ == arguments_.verb) of_verb = overridden(verb, verb_words_, of_verb);
    BatchJob job{listed.input, name_.empty() ? listed.name : name_, {verb_}};
    Words to = to_.empty() ? arguments_.to : to_;
    if (to.empty()) to = usual_extensions(verb_);
    if (!has_option(verb, "--output")) to.clear();
    for (const std::string& extension : to) job.options.push_back("--to=" + extension);
    job.options.insert(job.options.end(), of_verb.begin(), of_verb.end());
    check_options(job);
    return job;
  }

  /// Options that the verb's own reader refuses are refused before anything is done.
  void check_options(const BatchJob& job);

  const BatchArguments& arguments_;
  const Words& verb_words_;
  std::unique_ptr<Program> program_;
  CLI::App line_;
  std::string verb_, name_;
  Words to_;
  std::set<Words> checked_;
};

/// What a user would have typed for this job.
Words words_of(const BatchJob& job, const std::filesystem::path& folder, const CLI::App& verb,
               int threads) {
  Words words{job.options.front()};
  const std::string stem = (folder / std::filesystem::path(job.name).filename()).string();
  bool own_threads = false;
  for (std::size_t i = 1; i < job.options.size(); ++i) {
    const std::string& word = job.options[i];
    own_threads = own_threads || word.rfind("--threads=", 0) == 0;
    words.push_back(word.rfind("--to=", 0) == 0 ? "--output=" + stem + word.substr(5) : word);
  }
  if (!own_threads && has_option(verb, "--threads"))
    words.push_back("--threads=" + std::to_string(threads));
  if (has_option(verb, "--json")) words.push_back("--json");
  words.push_back("--");
  words.push_back(job.input);
  return words;
}

/// Throws unless some verb writes files that end so.
void check_extension(const std::string& to) {
  static const io::Kinds written{io::Kind::surface, io::Kind::cloud,   io::Kind::volume,
                                 io::Kind::tets,    io::Kind::sources, io::Kind::field,
                                 io::Kind::table,   io::Kind::page,    io::Kind::picture};
  if (!io::is_written_as("output" + to, written))
    throw InputError(
        "option to: no verb writes '" + to + "'; possible: " + io::written_extensions(written),
        "option-value");
}

void JobMaker::check_options(const BatchJob& job) {
  if (!checked_.insert(job.options).second) return;
  Program fresh;
  BatchJob any = job;
  any.input = "input.obj";
  any.name = "output";
  for (const std::string& word : job.options)
    if (word.starts_with("--to=")) check_extension(word.substr(5));
  fresh.read(words_of(any, "", verb_named(fresh.app(), job.options.front()), arguments_.threads));
}

/// In the child: the run of the verb that a user would have made.
BatchOutcome run_verb(Program& program, const BatchJob& job, const std::filesystem::path& folder,
                      int threads) {
  std::ostringstream out;
  std::streambuf* const before = std::cout.rdbuf(out.rdbuf());
  const CLI::App& verb = verb_named(program.app(), job.options.front());
  const int status =
      program.run(words_of(job, folder, verb, threads), Program::Signals::as_they_are);
  std::cout.rdbuf(before);
  BatchOutcome outcome{"done", "", out.str()};
  if (const auto& failure = program.session().failure)
    outcome = {failure->kind, failure->message, out.str()};
  else if (status != 0)
    outcome = {"internal", "ended with status " + std::to_string(status), out.str()};
  return outcome;
}

void read_shard(const std::string& text, BatchOptions& options) {
  if (text.empty()) return;
  const std::size_t slash = std::min(text.find('/'), text.size());
  const auto number = [&](const std::string& part) {
    if (part.empty() || part.size() > 6 ||
        part.find_first_not_of("0123456789") != std::string::npos)
      throw InputError("option shard: '" + text + "' is not I/N, as 3/8 is", "option-value");
    return std::stoi(part);
  };
  options.shard = number(text.substr(0, slash));
  options.shards = number(text.substr(std::min(slash + 1, text.size())));
}

std::string counts_text(const BatchSummary& summary) {
  char rate[64];
  std::snprintf(rate, sizeof rate, " in %.1f s, %.3g a second", summary.seconds,
                static_cast<double>(summary.done + summary.failed + summary.unchanged) /
                    std::max(summary.seconds, 1e-9));
  return std::to_string(summary.done) + " done, " + std::to_string(summary.unchanged) +
         " were done before, " + std::to_string(summary.failed) + " failed of " +
         std::to_string(summary.jobs) + rate;
}

void say_summary(const BatchSummary& summary) {
  constexpr std::size_t most = 20;
  std::fprintf(stderr, "littoral: %s\n", counts_text(summary).c_str());
  for (std::size_t f = 0; f < std::min(most, summary.failures.size()); ++f) {
    const BatchFailures& each = summary.failures[f];
    std::fprintf(stderr, "  %zu %s: %s (%s)\n", each.count, each.status.c_str(),
                 each.message.c_str(), each.example.c_str());
  }
  if (summary.failures.size() > most)
    std::fprintf(stderr, "  and %zu other messages\n", summary.failures.size() - most);
}

std::string summary_json(const BatchSummary& summary) {
  nlohmann::ordered_json json{{"jobs", summary.jobs},
                              {"done", summary.done},
                              {"unchanged", summary.unchanged},
                              {"failed", summary.failed},
                              {"seconds", summary.seconds},
                              {"start_seconds", summary.start_seconds},
                              {"peak_memory", summary.peak_memory}};
  json["failures"] = nlohmann::ordered_json::array();
  for (const BatchFailures& each : summary.failures)
    json["failures"].push_back({{"status", each.status},
                                {"message", each.message},
                                {"example", each.example},
                                {"count", each.count}});
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

void run_batch_verb(BatchArguments& arguments, Session& session) {
  read_shard(arguments.shard, arguments.options);
  const auto ready = std::make_shared<Program>();  // what every child starts from
  Batch batch({[ready, threads = arguments.threads](const BatchJob& job,
                                                    const std::filesystem::path& folder) {
    return run_verb(*ready, job, folder, threads);
  }});
  std::vector<BatchJob> jobs;
  {
    JobMaker make(arguments, session.verb_words);
    for (const ListedJob& listed : listed_jobs(arguments.jobs, arguments.options.folder))
      jobs.push_back(make(listed));
  }
  session.reading = false;
  Context context;
  context.cancel = session.cancel;
  context.progress = session.progress_callback();
  const BatchSummary summary = batch.run(jobs, arguments.options, context);
  session.end_progress();
  if (!session.quiet) say_summary(summary);
  if (session.json) std::cout << summary_json(summary) << "\n";
  if (summary.failed > 0) session.status = 1;
}

/// A number of bytes, but for those that forgot the unit.
CLI::Validator enough_memory() {
  return CLI::Validator(
      [](const std::string& bytes) -> std::string {
        if (bytes.size() > 6 || bytes.find_first_not_of('0') == std::string::npos) return "";
        return bytes + " bytes are too few: units are MB and GB";
      },
      "");
}

}  // namespace

void add_batch(CLI::App& program, Session& session) {
  auto arguments = std::make_shared<BatchArguments>();
  BatchOptions& options = arguments->options;
  CLI::App* verb = program.add_subcommand(
      batch_verb, "another verb for each of many inputs, in processes of their own");
  add_input_option(*verb, "JOBS", arguments->jobs,
                   "a folder, a pattern in quotes ('scans/*.ply'), a list .txt .csv .jsonl of "
                   "inputs with options, or one file");
  verb->add_option("-o,--output", options.folder,
                   "the folder for results and status.jsonl, a line for each input")
      ->required()
      ->type_name("DIR");
  verb->add_option("--verb", arguments->verb,
                   "what to do with each; its options go between those of batch [default " +
                       std::string(default_batch_verb) + "]")
      ->type_name("VERB");
  add_repeated_option(*verb, "--to", arguments->to,
                      "extension of what the verb writes; may be repeated [default: by verb, .npz "
                      "of sdf]")
      ->type_name("EXT");
  const auto number = [&](const char* name, int& value, int low, const std::string& help) {
    verb->add_option(name, value, help)->check(whole_number(low, 100000))->type_name("N");
  };
  number("--jobs", options.processes, 0, "inputs at once; 0: one for each core [default 0]");
  number("--threads", arguments->threads, 0, "of each; 0: all cores [default 1]");
  verb->add_option("--time-limit", options.time_limit,
                   "an input that takes longer is ended and has failed; 0: none [seconds; default "
                   "0]")
      ->check(number_between(0, 1e9))
      ->type_name("S");
  verb->add_option("--memory-limit", options.memory_limit,
                   "an input that needs more has failed: 800MB, 4GB; 0: none [default 0]")
      ->transform(CLI::AsSizeValue(true).description(""))
      ->check(enough_memory())
      ->type_name("SIZE");
  number("--retry", options.retries, 0,
         "try what crashed, took too long or could not be written again so often [default 0]");
  verb->add_option("--shard", arguments->shard,
                   "only the I-th of N parts, the same for the same list: 3/8 [default 1/1]")
      ->type_name("I/N");
  verb->add_flag(
      "--resume", [&options](std::int64_t) { options.resume = true; },
      "leave out what is done, with these options and this content of the input [default]");
  verb->add_flag(
      "--no-resume", [&options](std::int64_t) { options.resume = false; }, "do everything again");
  verb->add_flag("--fail-fast", options.fail_fast, "end with the first failure");
  verb->add_option("--progress", session.progress,
                   "a bar on stderr: auto (if it is a terminal), always, never [default auto]")
      ->check(one_of({"auto", "always", "never"}))
      ->type_name("WHEN");
  verb->add_flag("--quiet", session.quiet, "no summary, no progress");
  add_json_option(*verb, session);
  verb->callback(
      [=, &session] { session.job = [=, &session] { run_batch_verb(*arguments, session); }; });
}

}  // namespace littoral::cli
