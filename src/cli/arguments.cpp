#include "cli/arguments.h"

#include <algorithm>
#include <map>
#include <regex>
#include <set>

#include "base/option_table.h"
#include "cli/input/method_options.h"
#include "littoral/error.h"
#include "littoral/methods.h"

namespace littoral::cli {

namespace {

/// Options of any verb whose values are several numbers between commas: what they are called says
/// so, "X,Y,Z" or "L[,L...]".
std::set<std::string> lists_of_numbers(const CLI::App& program) {
  std::set<std::string> names;
  for (const CLI::App* verb : verbs_of(program))
    for (const CLI::Option* option : verb->get_options())
      if (option->get_type_name().find(',') != std::string::npos)
        for (const std::string& name : option->get_lnames()) names.insert("--" + name);
  return names;
}

bool is_list_of_numbers(const std::string& word) {
  return word.find_first_of("0123456789") != std::string::npos &&
         word.find_first_not_of("0123456789,.+-eE% ") == std::string::npos;
}

std::string without_blanks(std::string word) {
  std::erase(word, ' ');
  return word;
}

/// "10," and "1500" as well as "10" and "1500" are "10,1500".
void append_to_list(std::string& list, const std::string& more) {
  if (!list.empty() && !list.ends_with(',') && !more.starts_with(',')) list += ',';
  list += more;
}

void check_list(const std::string& option, const std::string& list) {
  if (list.starts_with(',') || list.ends_with(',') || list.find(",,") != std::string::npos)
    throw InputError("option " + option + ": a number is missing in '" + list + "'",
                     "option-value");
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
  // Not program.help, which is that of the verb where one was given, `help` for one.
  return program.get_formatter()->make_help(&program, program.get_name(),
                                            CLI::AppFormatMode::Normal);
}

std::vector<std::string> expanded_arguments(const CLI::App& program,
                                            std::vector<std::string> words) {
  const auto without_word = options_without_word();
  const auto lists = lists_of_numbers(program);
  std::vector<std::string> out;
  for (auto next = words.begin(); next != words.end();) {
    std::string word = *next++;
    const std::size_t equals = std::min(word.find('='), word.size());
    const std::string name = word.substr(0, equals);
    if (lists.count(name) != 0) {
      std::string list = without_blanks(word.substr(std::min(equals + 1, word.size())));
      while (next != words.end() && (list.empty() || is_list_of_numbers(list)) &&
             is_list_of_numbers(*next))
        append_to_list(list, without_blanks(*next++));
      if (is_list_of_numbers(list)) check_list(name, list);
      if (!list.empty()) word = name + "=" + list;
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

std::vector<std::string> doubtful_lists(const CLI::App& program,
                                        const std::vector<std::string>& words) {
  static const std::regex zero_and_more("(--[a-z-]+)?=?(-?0),([1-9][0-9]*)");
  std::vector<std::string> found;
  std::smatch part;
  for (std::size_t i = 1; i < words.size(); ++i) {
    if (!std::regex_match(words[i], part, zero_and_more)) continue;
    const std::string name = part[1].matched ? part[1].str() : words[i - 1];
    const std::string one = part[2].str() + "." + part[3].str();
    const bool is_list = std::ranges::any_of(verbs_of(program), [&](const CLI::App* verb) {
      const CLI::Option* option = verb->get_option_no_throw(name);
      return option && option->get_type_name().find("[,") != std::string::npos &&
             !option->get_type_name().starts_with('I') && verb->get_name() == words.front();
    });
    if (is_list)
      found.push_back("option " + name + ": " + part[2].str() + "," + part[3].str() +
                      " is two numbers, " + part[2].str() + " and " + part[3].str() +
                      "; for one number write " + one + ", and a blank behind the comma for two");
  }
  return found;
}

std::vector<std::string> verb_names(const CLI::App& program) {
  std::vector<std::string> names;
  for (const CLI::App* verb : verbs_of(program)) names.push_back(verb->get_name());
  return names;
}

const CLI::App& verb_named(const CLI::App& program, const std::string& name) {
  for (const CLI::App* verb : verbs_of(program))
    if (verb->get_name() == name) return *verb;
  if (name == "version")
    throw InputError("there is no verb 'version'; did you mean '--version'?", "unknown-name");
  throw InputError(
      "there is no verb '" + name + "'" + instead_of(name, verb_names(program), "verbs"),
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

bool takes_value(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

[[noreturn]] void throw_unknown(const CLI::App& program, const CLI::App& verb,
                                const std::string& name) {
  std::vector<std::string> known;
  for (const CLI::Option* option : verb.get_options())
    for (const std::string& other : option->get_lnames()) known.push_back("--" + other);
  std::vector<std::string> elsewhere;
  for (const CLI::App* other : verbs_of(program))
    if (other->get_option_no_throw(name)) elsewhere.push_back(other->get_name());
  const bool is_short = name.size() == 2;
  const std::string own = &verb == &program ? "littoral" : "littoral " + verb.get_name();
  throw InputError(own + " has no option '" + name + "'" +
                       (!elsewhere.empty() ? "; it is one of " + listed(elsewhere)
                        : is_short         ? "; " + own + " --help lists them"
                                           : meant(name, known)),
                   "unknown-name");
}

/// The option that a word names, with "-s=FILE" and "-sFILE" as "-s". Throws InputError where the
/// verb has none of this name.
const CLI::Option& known_option(const CLI::App& program, const CLI::App& verb,
                                const std::string& word) {
  const bool is_long = word.starts_with("--");
  const std::string name = is_long ? word.substr(0, word.find('=')) : word.substr(0, 2);
  if (const CLI::Option* option = verb.get_option_no_throw(name)) return *option;
  throw_unknown(program, verb, name);
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

std::vector<std::string> check_names(const CLI::App& program, std::vector<std::string>& arguments) {
  std::vector<std::string> outputs;
  if (arguments.empty())
    throw InputError("no verb given; littoral help lists them, such as in littoral info FILE",
                     "usage");
  if (arguments.front().front() == '-') {
    known_option(program, program, arguments.front());
    return outputs;
  }
  const CLI::App& verb = verb_named(program, arguments.front());
  for (std::size_t i = 1; i < arguments.size(); ++i) {
    std::string& word = arguments[i];
    if (word == "--") break;
    if (!is_option(word)) continue;
    const CLI::Option& option = known_option(program, verb, word);
    const bool is_long = word.starts_with("--");
    if (!is_long && word.size() > 3 && word[2] == '=') word.erase(2, 1);  // "-s=FILE"
    if (!takes_value(option)) continue;
    const std::size_t equals = is_long ? word.find('=') : std::string::npos;
    const bool joined = is_long ? equals != std::string::npos : word.size() > 2;
    const bool has_next = i + 1 < arguments.size();
    const bool next_is_option =
        has_next && is_option(arguments[i + 1]) &&
        verb.get_option_no_throw(arguments[i + 1].substr(0, arguments[i + 1].find('=')));
    if (joined ? equals + 1 == word.size() : !has_next || next_is_option)
      throw InputError("option " + word.substr(0, equals) + " has no value: " +
                           option.get_name(false, true) + " " + option.get_type_name() +
                           (next_is_option ? ", found '" + arguments[i + 1] + "'" : ""),
                       "usage");
    if (option.get_type_name() == "OUT")
      outputs.push_back(!joined   ? arguments[i + 1]
                        : is_long ? word.substr(equals + 1)
                                  : word.substr(2));
    if (!joined) ++i;
  }
  return outputs;
}

namespace {

/// Why a value that was given to an option is none; empty where all are.
std::string refusal_of_value(CLI::Option& option) {
  for (const std::string& value : option.results())
    for (const CLI::Validator* check : validators_of(option)) {
      try {
        if (const std::string why = (*check)(value); !why.empty()) return why;
      } catch (const CLI::ValidationError& error) {  // those of sizes in bytes
        return error.what();
      }
    }
  return "";
}

}  // namespace

std::string refused_text(const CLI::ParseError& error, CLI::App& program,
                         const std::vector<std::string>& arguments, std::string& code) {
  CLI::App* verb = nullptr;
  for (CLI::App* used : verbs_of(program))
    if (!arguments.empty() && used->get_name() == arguments.front()) verb = used;
  code = "usage";
  if (!verb) return error.what();
  const std::string name = "littoral " + verb->get_name();
  std::string inputs;
  for (const CLI::Option* option : verb->get_options())
    if (option->get_positional()) inputs += " " + option->get_name(true);
  const auto see = "; see " + name + " --help";
  if (dynamic_cast<const CLI::ExtrasError*>(&error)) {
    const std::vector<std::string> extra = verb->remaining(true);
    if (!extra.empty() && extra.front() == "%")
      return "'%' stands apart from its number; write them as one, as in 2%";
    return "'" + (extra.empty() ? std::string() : extra.front()) +
           "' is one argument too many: " + name + " takes" + inputs +
           ", and files and values behind their options" + see;
  }
  if (dynamic_cast<const CLI::RequiredError*>(&error)) {
    for (const CLI::Option* option : verb->get_options()) {
      if (!option->get_required() || option->count() > 0) continue;
      if (option->get_positional())
        return "no " + option->get_name(true) + " given: " + name + inputs + " ..." + see;
      return "no " + option->get_name(false, true) + " given: " + option->get_description();
    }
  }
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error))
    for (const CLI::Option* option : verb->get_options())
      if (option->count() > 1 && option->get_multi_option_policy() == CLI::MultiOptionPolicy::Throw)
        return "option " + option->get_name(false, true) + " is given " +
               std::to_string(option->count()) + " times; give it once";
  if (dynamic_cast<const CLI::ValidationError*>(&error))
    for (CLI::Option* option : verb->get_options())
      if (const std::string why = refusal_of_value(*option); !why.empty()) {
        code = words_to_complete(*option).empty() ? "option-value" : "unknown-name";
        return "option " + option->get_name() + ": " + why;
      }
  return error.what() + see;
}

}  // namespace littoral::cli
