#include "methods/quadratic/quadratic.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/component_values.h"
#include "base/counted.h"
#include "base/index.h"
#include "base/option_table.h"
#include "base/stopwatch.h"
#include "methods/quadratic/quadratic_program.h"

namespace littoral {

namespace {

/// What there is on every kind of element.
template <class S>
OptionTable<S> on_every_element(OptionTable<S> table) {
  return table
      .number(&S::tolerance, "tolerance", "of the integral of squared distance", 1e-10, 1e-1,
              "Duality gap at which the solver stops.")
      .integer(&S::max_iterations, "max-iterations", "", 1, 1000,
               "Interior-point iterations for each component of the mesh.")
      .number(&S::source_radius, "source-radius", "mean edge lengths", 1e-7, 1,
              "Distance allowed at a source.")
      .toggle(&S::insert_samples, "insert-samples",
              "Adds sample points where the constraint is violated between the usual ones.");
}

}  // namespace

const OptionTable<Quadratic>& quadratic_options() {
  using O = Quadratic;
  static const OptionTable<O> table =
      on_every_element(OptionTable<O>())
          .number(&O::spacing, "spacing", "mean edge lengths, 0 = none", 0, 100,
                  "Distance between samples on curves, at least 0.001; 0 knows the distance around "
                  "them instead.")
          .toggle(&O::is_signed, "signed",
                  "Takes the sign, and curves that fill gaps, from the signed heat method.")
          .integer(
              &O::subdivide, "subdivide", "", 1, 64,
              "Writes and draws a mesh with every side cut into this many parts, which shows the "
              "field between the vertices.");
  return table;
}

const OptionTable<TetQuadratic>& tet_quadratic_options() {
  static const OptionTable<TetQuadratic> table = on_every_element(OptionTable<TetQuadratic>());
  return table;
}

template <int D>
double QuadraticField<D>::distance(int element, const typename P2Shape<D>::Point& b) const {
  const auto local = elements->gather(u, element);
  if (!local.allFinite()) return infinity;
  const double length = unit[elements->component[elements->node[element][0]]];
  return length * std::sqrt(std::max(0.0, P2Shape<D>::values(b).dot(local)));
}

template <int D>
VecX QuadraticField<D>::at_vertices() const {
  VecX d = u.head(elements->n_vertices).cwiseMax(0.0).cwiseSqrt();
  for (Eigen::Index v = 0; v < d.size(); ++v)
    if (const int c = elements->component[v]; c >= 0) d[v] *= unit[c];
  return d;
}

template <int D>
struct QuadraticSolver<D>::Part {
  using Solver = ParaboloidSolver<P2Shape<D>::nodes, D>;

  QuadraticPart<D> part;

  explicit Part(QuadraticPart<D> p) : part(std::move(p)) {}

  /// Analysed when first needed.
  std::shared_ptr<const Solver> solver(const Task& task) {
    const std::lock_guard lock(mutex_);
    if (!solver_)
      solver_ = std::make_shared<const Solver>(int_size(part.nodes), part.local_node, task);
    return solver_;
  }

 private:
  std::mutex mutex_;
  std::shared_ptr<const Solver> solver_;
};

template <int D>
QuadraticSolver<D>::QuadraticSolver(std::shared_ptr<const P2Elements<D>> elements)
    : elements_(std::move(elements)) {
  for (auto& part : quadratic_parts(*elements_))
    parts_.push_back(std::make_unique<Part>(std::move(part)));
}

template <int D>
QuadraticSolver<D>::~QuadraticSolver() = default;

template <int D>
QuadraticField<D> QuadraticSolver<D>::solve(const std::vector<P2Source<D>>& sources,
                                            const Quadratic& options, Task task,
                                            Report& report) const {
  const P2Elements<D>& E = *elements_;
  QuadraticField<D> field;
  field.elements = elements_;
  field.u = VecX::Constant(E.n_nodes(), infinity);
  if (E.mollified > 0)
    report.warn("degenerate-faces",
                counted(E.mollified, "nearly degenerate element", "nearly degenerate elements") +
                    " had their sides lengthened minimally");
  std::vector<std::vector<P2Source<D>>> of_part(parts_.size());
  for (const P2Source<D>& source : sources)
    of_part[E.component[E.node[source.where.at(0).element][0]]].push_back(source);
  double total = 0;
  for (std::size_t c = 0; c < parts_.size(); ++c)
    if (!of_part[c].empty()) total += static_cast<double>(parts_[c]->part.elements.size());

  field.unit.resize(index(parts_.size()));
  for (std::size_t c = 0; c < parts_.size(); ++c)
    field.unit[index(c)] = parts_[c]->part.scale * E.unit;
  ComponentValues iterations("interior point"), gap("duality gap"), residual("constraints"),
      dual("dual constraints");
  double samples = 0, missing = 0;
  bool converged = true;
  for (std::size_t c = 0; c < parts_.size(); ++c) {
    if (of_part[c].empty()) {
      report.unreachable_components.push_back(c);
      continue;
    }
    const QuadraticPart<D>& part = parts_[c]->part;
    Task stage = task.stage(static_cast<double>(part.elements.size()) / total, "squared distance");
    const auto solver = [&] {
      const Stopwatch watch(report, "analyse");
      return parts_[c]->solver(stage.stage(0.1, "analysing"));
    }();
    const Stopwatch watch(report, "solve");
    const QuadraticProgram<D> program(E, part, of_part[c], options.source_radius * part.h);
    typename Part::Solver::Inserter insert;
    if (options.insert_samples)
      insert = [&](const VecX& u, double share) {
        return program.violated(u, share * 100 * options.tolerance);
      };
    const ParaboloidResult result = solver->solve(program.program(), program.start(),
                                                  {options.tolerance, options.max_iterations},
                                                  insert, stage.stage(0.9, "interior point"));
    for (std::size_t i = 0; i < part.nodes.size(); ++i) field.u[part.nodes[i]] = result.x[i];
    converged = converged && result.converged;
    const int component = c;
    iterations.add(component, result.iterations);
    gap.add(component, result.gap);
    residual.add(component, result.primal_residual);
    dual.add(component, result.dual_residual);
    samples += static_cast<double>(result.samples);
    missing += static_cast<double>(result.missing);
  }
  iterations.report_sum(report.iterations);
  gap.report_worst(report.residuals);
  residual.report_worst(report.residuals);
  dual.report_worst(report.residuals);
  report.sizes.emplace_back("samples", samples);
  if (!converged) {
    report.status = "not converged";
    if (missing > 0)
      report.warn("not-converged",
                  "between samples the constraint is still violated at " +
                      counted(static_cast<std::int64_t>(missing), "point", "points") +
                      ", after the last round of insertion");
    report.warn("not-converged", "the solver stopped at a relative duality gap of " +
                                     rounded_text(gap.worst()) + " and residuals of " +
                                     rounded_text(std::max(residual.worst(), dual.worst())) +
                                     ". Raise option max-iterations or option tolerance");
  }
  return field;
}

template class QuadraticSolver<2>;
template class QuadraticSolver<3>;
template struct QuadraticField<2>;
template struct QuadraticField<3>;

}  // namespace littoral
