// littoral methods: which methods there are, for what, and with which options.

#include <iostream>
#include <memory>

#include "api/report_json.h"
#include "cli/verbs/verbs.h"
#include "littoral/methods.h"

namespace littoral::cli {

namespace {

std::string joined(const std::vector<std::string>& words) {
  std::string out;
  for (const auto& word : words) out += (out.empty() ? "" : ", ") + word;
  return out;
}

void print_table() {
  for (const MethodFamily& family : method_families()) {
    std::cout << family.title << ":\n";
    for (const MethodInfo& method : family.methods)
      std::cout << "  " << method.name << "  on: " << joined(method.domains) << "\n      "
                << method.summary << "\n      " << method.reference << "\n";
  }
}

void print_markdown(const std::string& title, const std::vector<MethodInfo>& all) {
  std::cout << "# " << title << "\n\n";
  std::cout << "| method | runs on | what it computes | paper |\n|---|---|---|---|\n";
  for (const MethodInfo& method : all)
    std::cout << "| `" << method.name << "` | " << joined(method.domains) << " | " << method.summary
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

}  // namespace littoral::cli
