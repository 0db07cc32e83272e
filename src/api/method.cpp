#include "api/method.h"

#include <algorithm>

#include "base/option_table.h"

namespace littoral {

void check_has_option(const MethodInfo& method, const std::string& option) {
  for (const OptionInfo& info : method.options)
    if (info.name == option) return;
  throw InputError("method " + method.name + " has no option '" + option + "'" +
                       instead_of(option, method.options, "it has"),
                   "unknown-name");
}

void check_options_of_default(const MethodInfo& fallback, const AnyMethod& choice,
                              const std::vector<MethodInfo>& all) {
  const auto has = [](const MethodInfo& method, const std::string& option) {
    return std::any_of(method.options.begin(), method.options.end(),
                       [&](const OptionInfo& info) { return info.name == option; });
  };
  for (const auto& [option, text] : choice.values()) {
    if (has(fallback, option)) continue;
    std::vector<std::string> having;
    for (const MethodInfo& method : all)
      if (has(method, option)) having.push_back(method.name);
    if (!having.empty())
      throw InputError("method " + fallback.name + ", the default here, has no option '" + option +
                           "'; option method may name one that has: " + listed(having),
                       "unknown-name");
  }
}

namespace {

bool runs_on(const MethodInfo& method, const std::string& kind) {
  return std::find(method.domains.begin(), method.domains.end(), kind) != method.domains.end();
}

}  // namespace

void refuse_different_values(const MethodInfo& method, const std::string& kind,
                             const std::vector<MethodInfo>& all) {
  std::vector<std::string> able;
  for (const MethodInfo& m : all)
    if (m.different_values && runs_on(m, kind)) able.push_back(m.name);
  throw UnsupportedError(
      "method " + method.name + " measures from sources of one value, and these have several" +
      (able.empty() ? "" : "; on a " + kind + " these take them: ") + listed(able));
}

void check_domain(const MethodInfo& method, const std::string& kind,
                  const std::vector<MethodInfo>& all) {
  if (runs_on(method, kind)) return;
  std::vector<std::string> others;
  for (const MethodInfo& m : all)
    if (runs_on(m, kind)) others.push_back(m.name);
  const std::string on =
      listed(method.domains, [](const std::string& domain) { return "a " + domain; });
  throw UnsupportedError("method " + method.name + " runs on " + on + ", not on a " + kind +
                         (others.empty() ? "" : ", on which there are: " + listed(others)));
}

}  // namespace littoral
