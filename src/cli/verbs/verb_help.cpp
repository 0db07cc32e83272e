// littoral help: verbs, options and messages, also as pages of the documentation and of the manual.

#include <filesystem>
#include <iostream>
#include <memory>

#include "base/messages.h"
#include "cli/arguments.h"
#include "cli/input/method_options.h"
#include "cli/verbs/manual.h"
#include "cli/verbs/verbs.h"
#include "io/write.h"
#include "littoral/error.h"

namespace littoral::cli {

namespace {

/// Text in a cell of a table.
std::string cell(std::string text) {
  for (std::size_t at = 0; (at = text.find_first_of("|\n", at)) != std::string::npos; ++at) {
    text.replace(at, 1, text[at] == '|' ? "\\|" : " ");
    if (text[at] == '\\') ++at;
  }
  return text;
}

bool is_common(const CLI::Option& option) { return option.get_group() == common_options_group; }

void print_option(const CLI::Option& option) {
  const std::string value = option.get_type_name();
  std::cout << "| `" << option.get_name(option.get_positional(), true)
            << cell(value.empty() ? "" : " " + value) << "` | " << cell(option.get_description())
            << (option.get_required() && !option.get_positional() ? "; required" : "") << " |\n";
}

/// The verb's options but those of all verbs and those of methods, which `littoral methods` lists.
void print_verb(const CLI::App& verb) {
  std::cout << "\n## " << verb.get_name() << "\n\n" << verb.get_description() << "\n\n";
  std::cout << "| option | meaning |\n|---|---|\n";
  for (const CLI::Option* option : verb.get_options()) {
    if (option->get_group() == method_options_group || option == verb.get_help_ptr() ||
        option == verb.get_help_all_ptr())
      continue;
    if (is_common(*option)) continue;
    print_option(*option);
  }
}

void print_verbs(const CLI::App& program) {
  std::cout << "# Verbs and their options\n\nOptions of methods are [a page of their own]"
               "(support.md), file formats [another](formats.md); "
               "[the command line](../guides/command_line.md) has examples.\n";
  const auto verbs = verbs_of(program);
  for (const CLI::App* verb : verbs) print_verb(*verb);
  std::cout << "\n## Options of all verbs\n\nBut of those that tell what there is.\n\n"
               "| option | meaning |\n|---|---|\n";
  for (const CLI::Option* option : verbs.front()->get_options())
    if (is_common(*option)) print_option(*option);
}

struct HelpArguments {
  std::string verb, manual;
  bool markdown = false, messages = false;
};

void write_manual(const CLI::App& program, const std::filesystem::path& folder) {
  std::error_code failed;  // said by the first page that cannot be written
  std::filesystem::create_directories(folder, failed);
  const auto write = [&](const std::string& name, const std::string& text) {
    io::write_atomically(folder / (name + ".1"), [&](std::ostream& out) { out << text; });
  };
  write("littoral", manual_page(program));
  for (const CLI::App* verb : verbs_of(program))
    write("littoral-" + verb->get_name(), manual_page(program, *verb));
}

void help(const HelpArguments& arguments, CLI::App& program) {
  if (arguments.messages)
    std::cout << messages_markdown();
  else if (!arguments.manual.empty())
    write_manual(program, arguments.manual);
  else if (arguments.markdown)
    print_verbs(program);
  else
    std::cout << help_text(
        program, arguments.verb.empty() ? "" : verb_named(program, arguments.verb).get_name(),
        false);
}

}  // namespace

void add_help(CLI::App& program, Session& session) {
  CLI::App* verb = program.add_subcommand("help", "all verbs, or one with its options");
  auto arguments = std::make_shared<HelpArguments>();
  verb->add_option("VERB", arguments->verb, "the verb to explain")
      ->check(among(verb_names(program)))
      ->type_name("");
  verb->add_flag("--markdown", arguments->markdown,
                 "with their options, as tables for the documentation");
  verb->add_flag("--messages", arguments->messages,
                 "all errors and warnings by their codes, with what to do, for the documentation");
  verb->add_option("--man-pages", arguments->manual,
                   "write the manual into this folder: littoral.1, and a page for each verb")
      ->type_name("FOLDER");
  verb->callback(
      [=, &program, &session] { session.job = [=, &program] { help(*arguments, program); }; });
}

}  // namespace littoral::cli
