#include "cli/arguments.h"

#include <algorithm>
#include <map>

#include "base/option_table.h"
#include "cli/input/method_options.h"
#include "littoral/error.h"
#include "littoral/methods.h"

namespace littoral::cli {

namespace {

bool is_list_of_numbers(const std::string& word) {
  return !word.empty() && word.find_first_not_of("0123456789,") == std::string::npos;
}

std::map<std::string, std::vector<std::string>> options_without_word() {
  std::map<std::string, std::vector<std::string>> found;
  for (const MethodFamily& family : method_families())
    for (const MethodInfo& method : family.methods)
      for (const OptionInfo& info : method.options)
        if (std::find(info.choices.begin(), info.choices.end(), "on") != info.choices.end())
          found["--" + info.name] = info.choices;
  return found;
}

}  // namespace

std::vector<CLI::App*> verbs_of(CLI::App& program) {
  return program.get_subcommands([](const CLI::App*) { return true; });
}

std::vector<const CLI::App*> verbs_of(const CLI::App& program) {
  return program.get_subcommands([](const CLI::App*) { return true; });
}

std::string help_text(CLI::App& program, const std::string& name, bool all) {
  for (CLI::App* verb : verbs_of(program)) {
    if (verb->get_name() != name) continue;
    bool left_out = false;
    for (CLI::Option* option : verb->get_options())
      if (!all && option->get_group() == method_options_group) {
        option->group("");
        left_out = true;
      }
    return verb->help(program.get_name()) +
           (left_out ? "\nlittoral " + name +
                           " --help-all adds the options of methods, littoral methods lists them.\n"
                     : "");
  }
  return program.help("", CLI::AppFormatMode::Normal);
}

std::vector<std::string> expanded_arguments(std::vector<std::string> words) {
  const auto without_word = options_without_word();
  std::vector<std::string> out;
  for (auto next = words.begin(); next != words.end();) {
    std::string word = *next++;
    if (word == "--vertex" || word == "--curve-vertices") {
      std::string list;
      while (next != words.end() && is_list_of_numbers(*next))
        list.append(list.empty() ? "" : ",").append(*next++);
      if (!list.empty()) word += "=" + list;
    } else if (const auto found = without_word.find(word); found != without_word.end()) {
      const std::vector<std::string>& known = found->second;
      const bool given =
          next != words.end() && std::find(known.begin(), known.end(), *next) != known.end();
      word += "=" + (given ? *next++ : "on");
    }
    out.push_back(std::move(word));
  }
  return out;
}

const CLI::App& verb_named(const CLI::App& program, const std::string& name) {
  std::vector<std::string> names;
  for (const CLI::App* verb : verbs_of(program)) {
    if (verb->get_name() == name) return *verb;
    names.push_back(verb->get_name());
  }
  throw InputError("there is no verb '" + name + "'" + instead_of(name, names, "verbs"),
                   "unknown-name");
}

namespace {

/// The option of an app that a word names; null where there is none.
const CLI::Option* option_named(const CLI::App& app, const std::string& word) {
  return app.get_option_no_throw(word.substr(0, word.find('=')));
}

bool is_option(const std::string& word) {
  return word.size() > 1 && word[0] == '-' && word.find_first_of("0123456789.") != 1;
}

}  // namespace

std::vector<std::string> separate_words(const CLI::App& own, const CLI::App& other,
                                        const std::vector<std::string>& words,
                                        std::vector<std::string>& of_other) {
  std::vector<std::string> kept;
  for (auto next = words.begin(); next != words.end();) {
    const std::string& word = *next++;
    if (word == "--") {
      kept.insert(kept.end(), next - 1, words.end());
      break;
    }
    if (!is_option(word)) {
      kept.push_back(word);
      continue;
    }
    const CLI::Option* option = option_named(own, word);
    const bool is_own = option != nullptr;
    if (!is_own) option = option_named(other, word);
    const bool takes_value = option != nullptr && option->get_items_expected_max() > 0 &&
                             word.find('=') == std::string::npos && next != words.end();
    if (is_own) {
      kept.push_back(word);
      if (takes_value) kept.push_back(*next++);
    } else if (word[1] == '-') {
      of_other.push_back(takes_value ? word + "=" + *next++ : word);
    } else {  // "-s FILE"; the long name takes "="
      const bool has_long = option != nullptr && !option->get_lnames().empty();
      of_other.push_back(
          has_long && takes_value ? "--" + option->get_lnames().front() + "=" + *next++ : word);
    }
  }
  return kept;
}

std::vector<std::string> without_words_of_verb(const CLI::App& program,
                                               std::vector<std::string> words,
                                               std::vector<std::string>& of_verb) {
  const CLI::App& batch = verb_named(program, batch_verb);
  std::string name = default_batch_verb;
  for (std::size_t i = 1; i < words.size(); ++i) {
    if (words[i].rfind("--verb=", 0) == 0) name = words[i].substr(7);
    if (words[i] == "--verb" && i + 1 < words.size()) name = words[i + 1];
  }
  const CLI::App& verb = verb_named(program, name);
  words = separate_words(batch, verb, words, of_verb);
  std::vector<std::string> checked{name};
  checked.insert(checked.end(), of_verb.begin(), of_verb.end());
  check_names(program, checked);
  return words;
}

void check_names(const CLI::App& program, const std::vector<std::string>& arguments) {
  if (arguments.empty() || arguments.front().front() == '-') return;
  const CLI::App& verb = verb_named(program, arguments.front());
  for (const std::string& word : arguments) {
    if (word == "--") return;
    if (word.substr(0, 2) != "--") continue;
    const std::string name = word.substr(0, word.find('='));
    if (verb.get_option_no_throw(name)) continue;
    std::vector<std::string> known;
    for (const CLI::Option* option : verb.get_options())
      for (const std::string& other : option->get_lnames()) known.push_back("--" + other);
    std::vector<std::string> elsewhere;
    for (const CLI::App* other : verbs_of(program))
      if (other->get_option_no_throw(name)) elsewhere.push_back(other->get_name());
    throw InputError(
        "littoral " + verb.get_name() + " has no option '" + name + "'" +
            (elsewhere.empty() ? meant(name, known) : "; it is one of " + listed(elsewhere)),
        "unknown-name");
  }
}

}  // namespace littoral::cli
