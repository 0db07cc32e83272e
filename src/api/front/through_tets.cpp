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
  const Running running(context);
  auto prepared = std::make_shared<Prepared>();
  prepared->domain.mesh = std::make_shared<const TetMesh>(std::move(mesh));
  prepared->solver =
      prepare(method, prepared->domain, SolveHint::many_rhs, running.task, prepared->report);
  prepared_ = std::move(prepared);
}

TetField TetDistanceSolver::solve(const TetSources& sources, const Context& context) const {
  const Running running(context);
  TetField out{*prepared_->domain.mesh, {}, prepared_->report};
  out.report.timings.clear();  // of the preparation
  out.values = prepared_->solver->solve(sources, running.task, out.report);
  return out;
}

TetField distance(const TetMesh& mesh, const TetSources& sources, const AnyMethod& method,
                  const Context& context) {
  const Running running(context);
  TetField out{mesh, {}, {}};
  const TetDomain domain{std::make_shared<const TetMesh>(mesh)};
  out.values = solve_once<TetDomain>(method, domain, sources, running.task, out.report);
  return out;
}

}  // namespace littoral
