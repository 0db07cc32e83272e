#pragma once
// What a run would do, before it does it: --dry-run, and a word before long runs.

#include <string>
#include <utility>
#include <vector>

#include "api/method.h"
#include "api/space/csg.h"
#include "cli/plan/run_costs.h"
#include "cli/session.h"

namespace littoral::cli {

struct RunPlan {
  std::string method;  // empty: the library's choice
  std::string domain;
  std::vector<MethodInfo> methods;  // of the domain, the default first
  std::vector<std::pair<std::string, double>> sizes;
  double elements = 0;    // that the cost depends on
  double share = 1;       // of the work on all of them
  std::string like{};     // the verb that costs as much; empty: the one that runs
  SurfaceWork work{};     // of distance in space
  std::string shorter{};  // what would take less, as is said before long runs
};

/// Of methods on a surface or tet mesh.
template <class D>
RunPlan plan_on(const AnyMethod& method, const D& domain) {
  const auto& mesh = *domain.mesh;
  RunPlan plan{method.name(), domain.kind(), Registry<D>::instance().infos(), {}, 0};
  plan.elements = static_cast<double>(mesh.n_vertices());
  plan.sizes = {{"vertices", plan.elements}};
  if constexpr (requires { mesh.n_tets(); }) {
    plan.sizes.emplace_back("tets", static_cast<double>(mesh.n_tets()));
    plan.like = "tets";  // no row: what lies in sight of what decides, not how much there is
  } else
    plan.sizes.emplace_back("faces", static_cast<double>(mesh.n_faces()));
  return plan;
}
/// Of methods in space, at so many points. thorough: free edges are counted in inputs of any size.
RunPlan plan_in_space(const CsgShapes& shapes, double points, bool thorough);
/// On a grid, with its spacing.
RunPlan plan_in_space(const CsgShapes& shapes, const Grid& grid, bool thorough);

/// Adds --dry-run.
void add_plan_option(CLI::App& verb, Session& session);

/// To be called when the input is read and checked, before the work. True where the plan was asked
/// for and printed: nothing else is to be done then. Otherwise says how long it will take where
/// that is over half a minute.
bool planned(const RunPlan& plan, Session& session);

}  // namespace littoral::cli
