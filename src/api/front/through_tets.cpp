#include "littoral/through_tets.h"

#include <utility>

#include "api/front/running.h"
#include "api/space/filling.h"
#include "api/space/space_input.h"
#include "api/tet/tet_domain.h"
#include "base/option_table.h"
#include "contour/isosurface.h"
#include "littoral/error.h"

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

TetMesh tets_around(const PolygonSoup& input, const GridOptions& options, const Context& context) {
  return run(context, [&](Task task) {
    const Grid grid = Grid::around(input, options);
    const Frame frame(box_on_grid(input, grid));
    const Grid local = frame.local(grid);
    const bool bare_points = input.n_faces() == 0 && input.normals.rows() == 0;
    Report unread;
    const SpaceInput source =
        make_input({input, false, bare_points}, frame, local.spacing.minCoeff(), task, unread);
    TetMesh tets = filled(source, local, {}, task, unread);
    tets.points = frame.global(tets.points);
    return tets;
  });
}

Mesh isosurface(const TetField& field, double level, const Context& context) {
  return run(context, [&](const Task& task) {
    Report unread;
    PolygonSoup surface = isosurface(field.mesh, field.values, level, unread, task);
    if (surface.n_faces() == 0)
      throw InputError("isosurface: no tet takes the value " + rounded_text(level),
                       "nothing-there");
    return Mesh(std::move(surface));
  });
}

}  // namespace littoral
