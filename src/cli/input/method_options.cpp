#include "cli/input/method_options.h"

#include <algorithm>

#include "api/registry.h"

namespace littoral::cli {

namespace {

std::string option_help(const OptionInfo& info) {
  return info.help + " [" + (info.unit.empty() ? "" : info.unit + "; ") + option_range_text(info) +
         "; default " + info.fallback + "]";
}

}  // namespace

void add_method_options(CLI::App& verb, GivenOptions& given,
                        const std::vector<MethodInfo>& methods) {
  std::map<std::string, std::string> help;
  std::vector<OptionInfo> all;
  for (const MethodInfo& method : methods) {
    for (const OptionInfo& info : method.options) {
      if (help.count(info.name) == 0) all.push_back(info);
      std::string& text = help[info.name];
      text += (text.empty() ? "" : "\n") + method.name + ": " + option_help(info);
    }
  }
  for (const OptionInfo& info : all) {
    const auto keep = [&given, name = info.name](const std::string& text) { given[name] = text; };
    CLI::Option* option =
        info.is_switch
            ? verb.add_flag_function(
                  "--" + info.name, [keep](std::int64_t on) { keep(on > 0 ? "on" : "off"); },
                  help[info.name])
            : verb.add_option_function<std::string>("--" + info.name, keep, help[info.name]);
    if (!info.is_switch)
      option->type_name(info.is_text ? "TEXT" : info.choices.empty() ? "X" : "WORD");
    option->group("Options of methods");
  }
}

std::vector<std::string> with_words(int argc, char** argv) {
  std::map<std::string, std::vector<std::string>> may_stand_alone;
  for (const MethodInfo& method : methods())
    for (const OptionInfo& info : method.options)
      if (std::find(info.choices.begin(), info.choices.end(), "on") != info.choices.end())
        may_stand_alone["--" + info.name] = info.choices;
  std::vector<std::string> out;
  for (int i = 1; i < argc; ++i) {
    out.emplace_back(argv[i]);
    const auto found = may_stand_alone.find(out.back());
    if (found == may_stand_alone.end()) continue;
    const std::vector<std::string>& words = found->second;
    const bool given =
        i + 1 < argc && std::find(words.begin(), words.end(), argv[i + 1]) != words.end();
    out.back() += "=" + std::string(given ? argv[++i] : "on");
  }
  return out;
}

void add_method_options(CLI::App& verb, GivenOptions& given) {
  add_method_options(verb, given, methods());
}

void add_method_option(CLI::App& verb, std::string& name, const std::vector<MethodInfo>& methods) {
  std::string names;
  for (const MethodInfo& method : methods) names += (names.empty() ? "" : ", ") + method.name;
  verb.add_option("--method", name, names + " [default " + methods.front().name + "]")
      ->type_name("NAME");
}

void use_method_options(const GivenOptions& given, DistanceRequest& request) {
  const MethodInfo& method = find_method(request.method);
  for (const auto& [name, text] : given) {
    check_has_option(method, name);
    request.options.emplace_back(name, text);
  }
  check_request(request);
}

}  // namespace littoral::cli
