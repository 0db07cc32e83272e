// littoral methods and formats: what there is, also as pages of the documentation.

#include <iostream>
#include <memory>

#include "api/report_json.h"
#include "base/option_table.h"
#include "cli/verbs/verbs.h"
#include "io/formats.h"
#include "littoral/methods.h"

namespace littoral::cli {

namespace {

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

}  // namespace littoral::cli
