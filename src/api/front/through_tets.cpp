#include "littoral/through_tets.h"

#include <utility>

#include "api/front/running.h"
#include "api/tet/tet_domain.h"

namespace littoral {

struct TetDistanceSolver::Prepared {
  TetDomain domain;
  Report report;
  std::shared_ptr<const Solver<TetDomain>> solver;
};

TetDistanceSolver::TetDistanceSolver(TetMesh mesh, const AnyMethod& method,
                                     const Context& context) {
  prepared_ = run(context, [&](const Task& task) {
    auto prepared = std::make_shared<Prepared>();
    prepared->domain.mesh = std::make_shared<const TetMesh>(std::move(mesh));
    prepared->solver =
        prepare(method, prepared->domain, SolveHint::many_rhs, task, prepared->report);
    return prepared;
  });
}

TetField TetDistanceSolver::solve(const TetSources& sources, const Context& context) const {
  return run(context, [&](const Task& task) {
    TetField out{*prepared_->domain.mesh, {}, prepared_->report};
    out.report.timings.clear();  // of the preparation
    out.values = prepared_->solver->solve(sources, task, out.report);
    return out;
  });
}

TetField distance(const TetMesh& mesh, const TetSources& sources, const AnyMethod& method,
                  const Context& context) {
  return run(context, [&](const Task& task) {
    TetField out{mesh, {}, {}};
    const TetDomain domain{std::make_shared<const TetMesh>(mesh)};
    out.values = solve_once<TetDomain>(method, domain, sources, task, out.report);
    return out;
  });
}

}  // namespace littoral
