#include "methods/heat/finalize.h"

#include <algorithm>
#include <string>

#include "base/counted.h"
#include "base/index.h"

namespace littoral {

void set_near(const Calculus& C, const SourceSystem& system, VecX& Y) {
  if (system.near.empty()) return;
  const VecX g = C.G.apply(system.d0);
  for (int c : system.near) Y.segment<2>(2 * c) = g.segment<2>(2 * c);
}

void shift_to_mean_zero(const Calculus& C, const SourceSystem& system, VecX& phi) {
  VecX sum = VecX::Zero(C.n_components), length = VecX::Zero(C.n_components);
  const Eigen::SparseMatrix<double, Eigen::RowMajor> mean = system.mean;
  for (int r = 0; r < mean.rows(); ++r) {
    for (Eigen::SparseMatrix<double, Eigen::RowMajor>::InnerIterator it(mean, r); it; ++it) {
      const int c = C.component[it.col()];
      if (c < 0) continue;
      sum[c] += system.mean_weight[r] * it.value() * (phi[it.col()] - system.mean_value[r]);
      length[c] += system.mean_weight[r] * it.value();
    }
  }
  for (Eigen::Index i = 0; i < phi.size(); ++i) {
    const int c = C.component[i];
    if (c >= 0 && length[c] > 0) phi[i] -= sum[c] / length[c];
  }
}

namespace {

void list_unreached(const std::vector<char>& reached, Report& report) {
  for (std::size_t c = 0; c < reached.size(); ++c)
    if (!reached[c]) report.unreachable_components.push_back(c);
}

void set_unreached(VecX& phi, const std::vector<int>& component, const std::vector<char>& reached) {
  for (Eigen::Index i = 0; i < phi.size(); ++i) {
    const int c = component[i];
    if (c < 0 || !reached[c]) phi[i] = infinity;
  }
}

}  // namespace

void set_unreached(VecX& phi, const std::vector<int>& component, const std::vector<char>& reached,
                   Report& report) {
  set_unreached(phi, component, reached);
  list_unreached(reached, report);
}

void report_unreached(const std::vector<int>& component, int n_components,
                      const std::vector<char>& reached, Eigen::Index nodes, Report& report) {
  list_unreached(reached, report);
  if (!report.unreachable_components.empty())
    report.warn("component-unreached",
                std::to_string(report.unreachable_components.size()) + " of " +
                    counted(n_components, "component", "components") +
                    (report.unreachable_components.size() == 1 ? " holds" : " hold") +
                    " no source; the distance is infinite there");
  const auto isolated = std::count(component.begin(), component.begin() + nodes, -1);
  if (isolated > 0)
    report.warn("isolated-vertices", counted(isolated, "vertex belongs", "vertices belong") +
                                         " to no face; the distance is infinite there");
}

VecX finalize_field(const Operators& ops, const SourceSystem& system, const VecX& phi,
                    Report& report) {
  return finalize_field(ops.scalar.component, ops.scalar.n_components, ops.unit, system.reached,
                        phi, report);
}

VecX finalize_field(const std::vector<int>& component, int n_components, double unit,
                    const std::vector<char>& reached, const VecX& phi, Report& report) {
  VecX out = phi * unit;
  set_unreached(out, component, reached);
  report_unreached(component, n_components, reached, out.size(), report);
  return out;
}

}  // namespace littoral
