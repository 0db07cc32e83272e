#include "api/method.h"

#include <algorithm>

namespace littoral {

void check_has_option(const MethodInfo& method, const std::string& option) {
  for (const OptionInfo& info : method.options)
    if (info.name == option) return;
  throw InputError("method " + method.name + " has no option '" + option + "'" +
                   instead_of(option, method.options, "it has"));
}

void check_options_of_default(const MethodInfo& fallback, const AnyMethod& choice,
                              const std::vector<MethodInfo>& all) {
  const auto has = [](const MethodInfo& method, const std::string& option) {
    return std::any_of(method.options.begin(), method.options.end(),
                       [&](const OptionInfo& info) { return info.name == option; });
  };
  for (const auto& [option, text] : choice.values()) {
    if (has(fallback, option)) continue;
    std::string having;
    for (const MethodInfo& method : all)
      if (has(method, option)) having += (having.empty() ? "" : ", ") + method.name;
    if (!having.empty())
      throw InputError("method " + fallback.name + ", the default here, has no option '" + option +
                       "'; option method may name one that has: " + having);
  }
}

void check_domain(const MethodInfo& method, const std::string& kind,
                  const std::vector<MethodInfo>& all) {
  const auto runs = [&](const MethodInfo& m) {
    return std::find(m.domains.begin(), m.domains.end(), kind) != m.domains.end();
  };
  if (runs(method)) return;
  std::string on, others;
  for (const std::string& d : method.domains) on += (on.empty() ? "a " : ", a ") + d;
  for (const MethodInfo& m : all)
    if (runs(m)) others += (others.empty() ? "" : ", ") + m.name;
  throw UnsupportedError("method " + method.name + " runs on " + on + ", not on a " + kind +
                         (others.empty() ? "" : ", on which there are: " + others));
}

}  // namespace littoral
