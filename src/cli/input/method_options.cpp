#include "cli/input/method_options.h"

#include <algorithm>

#include "base/option_table.h"
#include "littoral/methods.h"

namespace littoral::cli {

namespace {

std::string option_help(const OptionInfo& info) {
  return info.help + " [" + (info.unit.empty() ? "" : info.unit + "; ") + info.range() +
         "; default " + info.fallback + "]";
}

}  // namespace

void add_method_options(CLI::App& verb, GivenOptions& given,
                        const std::vector<MethodInfo>& methods) {
  std::map<std::string, std::string> help;
  std::map<std::string, std::vector<std::string>> choices;
  std::vector<OptionInfo> all;
  for (const MethodInfo& method : methods) {
    for (const OptionInfo& info : method.options) {
      if (help.count(info.name) == 0) all.push_back(info);
      std::string& text = help[info.name];
      text += (text.empty() ? "" : "\n") + method.name + ": " + option_help(info);
      std::vector<std::string>& words = choices[info.name];
      for (const std::string& word : info.choices)
        if (std::find(words.begin(), words.end(), word) == words.end()) words.push_back(word);
    }
  }
  for (const OptionInfo& info : all) {
    using Kind = OptionInfo::Kind;
    const auto keep = [&given, name = info.name](const std::string& text) { given[name] = text; };
    CLI::Option* option =
        info.kind == Kind::toggle
            ? verb.add_flag_function(
                  "--" + info.name, [keep](std::int64_t on) { keep(on > 0 ? "on" : "off"); },
                  help[info.name])
            : verb.add_option_function<std::string>("--" + info.name, keep, help[info.name]);
    if (info.kind != Kind::toggle)
      option->type_name(info.kind == Kind::text     ? "TEXT"
                        : info.kind == Kind::choice ? "WORD"
                                                    : "X");
    if (!choices[info.name].empty()) option->check(among(choices[info.name]));
    option->group(method_options_group);
  }
}

void add_methods(CLI::App& verb, MethodArguments& arguments, const std::vector<MethodInfo>& methods,
                 const std::string& fallback) {
  std::vector<std::string> names;
  for (const MethodInfo& method : methods) names.push_back(method.name);
  verb.add_option(
          "--method", arguments.name,
          listed(names) + " [default " + (fallback.empty() ? methods.front().name : fallback) + "]")
      ->check(among(names))
      ->type_name("NAME");
  add_method_options(verb, arguments.options, methods);
}

std::vector<MethodInfo> joined(std::vector<MethodInfo> methods,
                               const std::vector<MethodInfo>& more) {
  for (const MethodInfo& info : more) {
    const auto same = std::find_if(methods.begin(), methods.end(),
                                   [&](const MethodInfo& m) { return m.name == info.name; });
    if (same == methods.end()) {
      methods.push_back(info);
      continue;
    }
    for (const OptionInfo& option : info.options)
      if (std::none_of(same->options.begin(), same->options.end(),
                       [&](const OptionInfo& o) { return o.name == option.name; }))
        same->options.push_back(option);
  }
  return methods;
}

}  // namespace littoral::cli
