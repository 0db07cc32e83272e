#include "littoral/api/registry.h"

#include "littoral/base/error.h"
#include "littoral/methods/signed_heat.h"
#include "littoral/methods/unsigned_heat.h"

namespace littoral {

const std::vector<MethodInfo>& methods() {
  static const std::vector<MethodInfo> all = {
      {"signed-heat",
       "Signed distance to curves that may be broken, unsigned to points and unsigned curves.",
       {"triangle mesh"},
       signed_heat_options().infos(),
       "Feng, Crane: A Heat Method for Generalized Signed Distance (2024)"},
      {"unsigned-heat",
       "Unsigned distance to curves and points.",
       {"triangle mesh"},
       unsigned_heat_options().infos(),
       "Crane, Weischedel, Wardetzky: Geodesics in Heat (2013)"},
  };
  return all;
}

const MethodInfo& find_method(const std::string& name) {
  std::string known;
  for (const MethodInfo& method : methods()) {
    if (method.name == name) return method;
    known += (known.empty() ? "" : ", ") + method.name;
  }
  throw InputError("unknown method '" + name + "'; known: " + known);
}

void check_has_option(const MethodInfo& method, const std::string& option) {
  std::string known;
  for (const OptionInfo& info : method.options) {
    if (info.name == option) return;
    known += (known.empty() ? "" : ", ") + info.name;
  }
  throw InputError("method " + method.name + " has no option '" + option + "'; it has: " + known);
}

}  // namespace littoral
