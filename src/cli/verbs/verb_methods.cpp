// littoral methods, formats and help: what there is, also as pages of the documentation.

#include <iostream>
#include <memory>

#include "api/report_json.h"
#include "cli/arguments.h"
#include "cli/input/method_options.h"
#include "cli/verbs/verbs.h"
#include "io/formats.h"
#include "littoral/methods.h"

namespace littoral::cli {

namespace {

std::string listed(const std::vector<std::string>& words) {
  std::string out;
  for (const auto& word : words) out += (out.empty() ? "" : ", ") + word;
  return out;
}

void print_table() {
  for (const MethodFamily& family : method_families()) {
    std::cout << family.title << ":\n";
    for (const MethodInfo& method : family.methods)
      std::cout << "  " << method.name << "  on: " << listed(method.domains) << "\n      "
                << method.summary << "\n      " << method.reference << "\n";
  }
}

void print_markdown(const std::string& title, const std::vector<MethodInfo>& all) {
  std::cout << "# " << title << "\n\n";
  std::cout << "| method | runs on | what it computes | paper |\n|---|---|---|---|\n";
  for (const MethodInfo& method : all)
    std::cout << "| `" << method.name << "` | " << listed(method.domains) << " | " << method.summary
              << " | " << method.reference << " |\n";
  for (const MethodInfo& method : all) {
    if (method.options.empty()) continue;
    std::cout << "\n## Options of `" << method.name
              << "`\n\n| option | range | default | unit | |\n|---|---|---|---|---|\n";
    for (const OptionInfo& info : method.options)
      std::cout << "| `--" << info.name << "` | " << info.range() << " | " << info.fallback << " | "
                << info.unit << " | " << info.help << " |\n";
  }
}

void print_all_markdown() {
  bool first = true;
  for (const MethodFamily& family : method_families()) {
    if (!first) std::cout << "\n";
    first = false;
    print_markdown(family.title, family.methods);
  }
}

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

}  // namespace

void add_methods(CLI::App& program, Session& session) {
  CLI::App* verb = program.add_subcommand("methods", "which methods there are, and for what");
  auto markdown = std::make_shared<bool>(false);
  add_json_option(*verb, session);
  verb->add_flag("--markdown", *markdown, "as tables for the documentation, with all options");
  verb->callback([markdown, &session] {
    session.job = [markdown, &session] {
      if (session.json)
        std::cout << methods_json(method_families()) << "\n";
      else
        *markdown ? print_all_markdown() : print_table();
    };
  });
}

void add_formats(CLI::App& program, Session& session) {
  CLI::App* verb = program.add_subcommand("formats", "which files are read and written");
  auto markdown = std::make_shared<bool>(false);
  verb->add_flag("--markdown", *markdown, "as a table for the documentation");
  verb->callback([markdown, &session] {
    session.job = [markdown] {
      std::cout << (*markdown ? io::formats_markdown() : io::formats_text());
    };
  });
}

void add_help(CLI::App& program, Session& session) {
  CLI::App* verb = program.add_subcommand("help", "all verbs, or one with its options");
  auto markdown = std::make_shared<bool>(false);
  auto name = std::make_shared<std::string>();
  verb->add_option("VERB", *name, "the verb to explain")->type_name("");
  verb->add_flag("--markdown", *markdown, "with their options, as tables for the documentation");
  verb->callback([=, &program, &session] {
    session.job = [=, &program] {
      if (*markdown)
        print_verbs(program);
      else if (name->empty())
        std::cout << program.help("", CLI::AppFormatMode::Normal);
      else
        std::cout << help_text(program, verb_named(program, *name).get_name(), false);
    };
  });
}

}  // namespace littoral::cli
