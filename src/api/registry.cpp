#include "api/registry.h"

#include "api/space/space_method.h"
#include "api/surface/pairs.h"
#include "api/surface/surface_method.h"
#include "api/surface/winding.h"
#include "api/tet/tet_method.h"
#include "base/error.h"

namespace littoral {

const std::vector<SurfaceMethod>& surface_methods() {
  static const std::vector<SurfaceMethod> all = [] {
    auto out = all_of<SurfaceMethod>(
        {heat_methods, geodesic_methods, quadratic_methods, regularized_methods});
    for (SurfaceMethod& method : out)
      for (const TetMethod& on_tets : tet_methods())
        if (on_tets.name == method.info.name) method.info.domains.push_back("tet mesh");
    return out;
  }();
  return all;
}

const std::vector<MethodInfo>& methods() {
  static const std::vector<MethodInfo> all = [] {
    std::vector<MethodInfo> out;
    for (const SurfaceMethod& method : surface_methods()) out.push_back(method.info);
    return out;
  }();
  return all;
}

const std::vector<MethodInfo>& all_methods() {
  static const std::vector<MethodInfo> all = [] {
    std::vector<MethodInfo> out = methods();
    out.push_back(pair_methods().front());
    out.push_back(winding_method());
    for (MethodInfo& info : space_method_infos()) out.push_back(std::move(info));
    return out;
  }();
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
