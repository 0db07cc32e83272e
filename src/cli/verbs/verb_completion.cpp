// littoral completion: scripts for shells, made from the verbs and their options.

#include <iostream>
#include <memory>

#include "cli/arguments.h"
#include "cli/verbs/verbs.h"

namespace littoral::cli {

namespace {

std::string spaced_verb_names(const CLI::App& program) {
  std::string names;
  for (const std::string& name : verb_names(program)) names += (names.empty() ? "" : " ") + name;
  return names;
}

std::string long_options(const CLI::App& verb) {
  std::string names;
  for (const CLI::Option* option : verb.get_options())
    for (const std::string& name : option->get_lnames())
      names += (names.empty() ? "--" : " --") + name;
  return names;
}

/// A case for each verb, as bash and zsh have it.
std::string option_cases(const CLI::App& program, const std::string& before,
                         const std::string& after) {
  std::string text;
  for (const CLI::App* verb : verbs_of(program))
    text += "    " + verb->get_name() + ") " + before + long_options(*verb) + after + " ;;\n";
  return text;
}

/// A case for each option with words to choose from, "VERB --OPTION"; "VERB" for what it is run on.
std::string word_cases(CLI::App& program, const std::string& before, const std::string& after) {
  std::string text;
  for (CLI::App* verb : verbs_of(program))
    for (CLI::Option* option : verb->get_options()) {
      const std::string words = words_to_complete(*option);
      if (words.empty()) continue;
      const std::vector<std::string>& names = option->get_lnames();
      text += "    \"" + verb->get_name() + (names.empty() ? "" : " --" + names.front()) + "\") " +
              before + words + after + " ;;\n";
    }
  return text;
}

std::string bash_script(CLI::App& program) {
  return "_littoral() {\n"
         "  local word=\"${COMP_WORDS[COMP_CWORD]}\" options= words=\n"
         "  if [ \"$COMP_CWORD\" -eq 1 ]; then\n"
         "    COMPREPLY=($(compgen -W \"" +
         spaced_verb_names(program) +
         "\" -- \"$word\"))\n    return\n  fi\n"
         "  case \"${COMP_WORDS[1]}\" in\n" +
         option_cases(program, "options=\"", "\"") +
         "  esac\n"
         "  local place=\"${COMP_WORDS[1]}\"\n"
         "  [ \"$COMP_CWORD\" -eq 2 ] || place=\"$place ${COMP_WORDS[COMP_CWORD-1]}\"\n"
         "  case \"$place\" in\n" +
         word_cases(program, "words=\"", "\"") +
         "  esac\n"
         "  case \"$word\" in\n"
         "    -*) COMPREPLY=($(compgen -W \"$options\" -- \"$word\")) ;;\n"
         "    *) if [ -n \"$words\" ]; then COMPREPLY=($(compgen -W \"$words\" -- \"$word\"))\n"
         "       else COMPREPLY=($(compgen -f -- \"$word\")); fi ;;\n"
         "  esac\n}\n"
         "complete -o filenames -F _littoral littoral\n";
}

std::string zsh_script(CLI::App& program) {
  return "#compdef littoral\n_littoral() {\n"
         "  if (( CURRENT == 2 )); then\n    compadd -- " +
         spaced_verb_names(program) +
         "\n    return\n  fi\n"
         "  if [[ $words[CURRENT] != -* ]]; then\n"
         "    local place=$words[2]\n"
         "    (( CURRENT == 3 )) || place+=\" $words[CURRENT-1]\"\n"
         "    case \"$place\" in\n" +
         word_cases(program, "compadd -- ", "") +
         "    *) _files ;;\n    esac\n    return\n  fi\n"
         "  case $words[2] in\n" +
         option_cases(program, "compadd -- ", "") + "  esac\n}\ncompdef _littoral littoral\n";
}

/// Text between single quotes.
std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text.substr(0, text.find('\n'))) {
    if (c == '\'' || c == '\\') out += '\\';
    out += c;
  }
  return out + "'";
}

std::string fish_script(CLI::App& program) {
  std::string text;
  for (CLI::App* verb : verbs_of(program)) {
    text += "complete -c littoral -n __fish_use_subcommand -a " + verb->get_name() + " -d " +
            quoted(verb->get_description()) + "\n";
    const std::string chosen =
        "complete -c littoral -n '__fish_seen_subcommand_from " + verb->get_name() + "' ";
    for (CLI::Option* option : verb->get_options()) {
      const std::string words = words_to_complete(*option);
      const std::string choice = words.empty() ? "" : " -f -a " + quoted(words);
      if (option->get_lnames().empty() && !words.empty()) text += chosen + choice + "\n";
      for (const std::string& name : option->get_lnames())
        text += chosen + "-l " + name + (option->get_items_expected_max() > 0 ? " -r" : "") +
                choice + " -d " + quoted(option->get_description()) + "\n";
    }
  }
  return text;
}

}  // namespace

void add_completion(CLI::App& program, Session& session) {
  CLI::App* verb = program.add_subcommand(
      "completion", "a script that completes verbs, options and files in a shell");
  auto shell = std::make_shared<std::string>();
  verb->add_option("SHELL", *shell, "bash, zsh or fish: to be sourced or put where it looks")
      ->required()
      ->check(one_of({"bash", "zsh", "fish"}))
      ->type_name("");
  verb->callback([=, &program, &session] {
    session.job = [=, &program] {
      std::cout << (*shell == "bash"  ? bash_script(program)
                    : *shell == "zsh" ? zsh_script(program)
                                      : fish_script(program));
    };
  });
}

}  // namespace littoral::cli
