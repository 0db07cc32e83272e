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

std::vector<std::string> expanded_arguments(int argc, char** argv) {
  const auto without_word = options_without_word();
  std::vector<std::string> out;
  for (int i = 1; i < argc; ++i) {
    out.emplace_back(argv[i]);
    std::string& word = out.back();
    if (word == "--vertex" || word == "--curve-vertices") {
      std::string list;
      while (i + 1 < argc && is_list_of_numbers(argv[i + 1]))
        list.append(list.empty() ? "" : ",").append(argv[++i]);
      if (!list.empty()) word += "=" + list;
      continue;
    }
    const auto found = without_word.find(word);
    if (found == without_word.end()) continue;
    const std::vector<std::string>& words = found->second;
    const bool given =
        i + 1 < argc && std::find(words.begin(), words.end(), argv[i + 1]) != words.end();
    word += "=" + std::string(given ? argv[++i] : "on");
  }
  return out;
}

const CLI::App& verb_named(const CLI::App& program, const std::string& name) {
  std::vector<std::string> names;
  for (const CLI::App* verb : verbs_of(program)) {
    if (verb->get_name() == name) return *verb;
    names.push_back(verb->get_name());
  }
  throw InputError("there is no verb '" + name + "'" + instead_of(name, names, "verbs"));
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
        (elsewhere.empty() ? meant(name, known) : "; it is one of " + listed(elsewhere)));
  }
}

}  // namespace littoral::cli
