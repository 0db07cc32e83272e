#include "api/method.h"

#include <algorithm>

namespace littoral {

void check_has_option(const MethodInfo& method, const std::string& option) {
  std::string known;
  for (const OptionInfo& info : method.options) {
    if (info.name == option) return;
    known += (known.empty() ? "" : ", ") + info.name;
  }
  throw InputError("method " + method.name + " has no option '" + option +
                   "'; it has: " + (known.empty() ? "none" : known));
}

bool has_options(const MethodInfo& method, const AnyMethod& choice) {
  return std::all_of(choice.values().begin(), choice.values().end(), [&](const auto& given) {
    return std::any_of(method.options.begin(), method.options.end(),
                       [&](const OptionInfo& info) { return info.name == given.first; });
  });
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
