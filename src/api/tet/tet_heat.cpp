// Signed heat through tets that are given.

#include <memory>
#include <utility>

#include "api/tet/tet_domain.h"
#include "base/index.h"
#include "base/lazy.h"
#include "base/option_table.h"
#include "methods/heat/sharpen.h"
#include "methods/heat/signed_heat_tets.h"
#include "methods/heat/time_scale.h"
#include "sources/space/parts_of_samples.h"
#include "sources/space/tet_source_values.h"

namespace littoral {

VecX sharpened_on_tets(const std::shared_ptr<const TetOperators>& ops, const std::string& domain,
                       const SpMat& rows, const VecX& phi, const Task& task, Report& report) {
  Operators in_space;
  in_space.domain = domain;
  in_space.scalar = tet_calculus(ops);
  return sharpen_in_space(in_space, rows, phi, SharpenSolver::admm, task, report);
}

namespace {

constexpr double held_to = 3e-3;  // mean edges, root mean square, where values are held at zero

/// One connected part of a mesh, with numbers of its own.
struct Part {
  std::vector<int> vertices;  // of the part -> of the mesh
  std::vector<int> number;    // of the mesh -> of the part, -1 in another or none
  std::vector<int> tets;      // the same
  std::shared_ptr<const TetMesh> mesh;
  std::shared_ptr<const TetHeatSolver> heat;
};

Part part_of(const TetMesh& mesh, const TetOperators& ops, int component, SolveHint hint) {
  Part part;
  part.number.assign(std::size_t(mesh.n_vertices()), -1);
  for (int v = 0; v < mesh.n_vertices(); ++v) {
    if (ops.component[v] != component) continue;
    part.number[v] = static_cast<int>(part.vertices.size());
    part.vertices.push_back(v);
  }
  std::vector<int> corners;
  int n = 0;
  for (int t = 0; t < mesh.n_tets(); ++t) {
    const bool here = ops.volumes[t] > 0 && part.number[mesh.tets(t, 0)] >= 0;
    part.tets.push_back(here ? n++ : -1);
    for (int k = 0; k < 4 && here; ++k) corners.push_back(part.number[mesh.tets(t, k)]);
  }
  part.mesh = std::make_shared<const TetMesh>(
      TetMesh{mesh.points(part.vertices, Eigen::all),
              Eigen::Map<const Rows<int, 4>>(corners.data(), n, 4)});
  part.heat = std::make_shared<const TetHeatSolver>(
      std::make_shared<const TetOperators>(tet_operators(*part.mesh)), hint);
  return part;
}

/// Sources of the whole mesh on one part of it.
TetProblem problem_on(const Part& part, std::shared_ptr<const TetOperators> ops,
                      const TetProblem& whole) {
  TetProblem problem = whole;
  problem.mesh = part.mesh;
  problem.ops = std::move(ops);
  problem.vertices.clear();
  if (!whole.vertices.empty()) problem.values.clear();
  for (std::size_t i = 0; i < whole.vertices.size(); ++i) {
    const int n = part.number[whole.vertices[i]];
    if (n < 0) continue;
    problem.vertices.push_back(n);
    if (!whole.values.empty()) problem.values.push_back(whole.values[i]);
  }
  merge_vertices(problem.vertices, problem.values);
  for (TetPoint& p : problem.places)
    if (p.tet >= 0) p.tet = part.tets[p.tet];
  return problem;
}

VecX solve_on(const TetHeatSolver& heat, const TetProblem& problem, const SpaceSignedHeat& options,
              const Task& task, Report& report) {
  const double edge = mean_edge(*problem.mesh, problem.tets_with_sources());
  const double tolerance = held_to * edge;
  return problem.vertices.empty()
             ? heat.signed_distance(problem.terms(), std::max(problem.h, edge), tolerance, options,
                                    task, report)
             : heat.unsigned_distance(problem.terms(), edge, tolerance, options, task, report);
}

/// On meshes of the data that are fine enough for their sources up to a fifth was seen, with mean
/// errors of 7 % of the largest distance; with half of the volume 6 to 11 %.
void warn_off_unit_volume(const Calculus& C, const VecX& phi, Report& report) {
  constexpr double remarkable = 0.3;
  const double share = off_unit_fraction(C, phi);
  report.residuals.emplace_back("volume fraction with gradient off unit length", share);
  if (share > remarkable)
    report.warn("gradient-off-unit",
                "the gradient of the distance is more than a quarter off unit length on " +
                    percent_text(share) +
                    " of the volume: the tets are too coarse, or too uneven, for heat from these "
                    "sources; method auto or quadratic measures better");
}

/// Each component is a problem of its own.
class HeatThroughTets {
 public:
  HeatThroughTets(std::shared_ptr<const TetDiscretization> on, SolveHint hint)
      : on_(std::move(on)), hint_(hint) {}

  VecX solve(const TetProblem& problem, const SpaceSignedHeat& options, Task& task,
             Report& report) const {
    const TetMesh& mesh = *problem.mesh;
    const TetOperators& ops = *problem.ops;
    const std::vector<char> reached = problem.reached();
    Task solving = task.stage(options.sharpen ? 0.4 : 0.9, "distance");
    VecX phi = VecX::Constant(mesh.n_vertices(), infinity);
    for (int c = 0; c < ops.n_components; ++c) {
      const Task stage = solving.stage(1.0 / ops.n_components, "distance");
      if (reached[c] == 0) {
        report.unreachable_components.push_back(c);
      } else if (ops.n_components == 1) {
        const auto heat = whole_.get(
            [&] { return std::make_shared<const TetHeatSolver>(on_->operators(), hint_); });
        phi = solve_on(*heat, problem, options, stage, report);
      } else {
        const auto part = parts_.get(c, [&] { return part_of(mesh, ops, c, hint_); });
        const auto own = std::shared_ptr<const TetOperators>(part, &part->heat->operators());
        phi(part->vertices) =
            solve_on(*part->heat, problem_on(*part, own, problem), options, stage, report);
      }
    }
    if (options.sharpen)
      phi = sharpened_on_tets(problem.ops, "tet mesh", problem.terms().A, phi,
                              task.stage(0.5, "sharpening"), report);
    warn_off_unit_volume(tet_calculus(problem.ops), phi, report);
    return phi;
  }

 private:
  std::shared_ptr<const TetDiscretization> on_;
  SolveHint hint_;
  Kept<TetHeatSolver> whole_;
  KeptByKey<int, Part> parts_;
};

}  // namespace

std::vector<Method<TetDomain>> heat_tet_methods() {
  return {make_tet_method(
      {SpaceSignedHeat::method,
       "Signed distance from surfaces, unsigned distance from vertices.",
       {},
       {},
       "Feng, Crane: A Heat Method for Generalized Signed Distance (2024), section 8.1"},
      space_heat_options(),
      [](const std::shared_ptr<const TetDiscretization>& on, const SpaceSignedHeat&,
         SolveHint hint) {
        return
            [heat = std::make_shared<const HeatThroughTets>(on, hint)](
                const TetProblem& problem, SpaceSignedHeat& options, Task& task, Report& report) {
              options = settled(options, true);
              check_level_sets(options, !problem.values.empty());
              if (options.constraint != SpaceConstraint::level_sets)
                return heat->solve(problem, options, task, report);
              TetProblem with_parts = problem;
              with_parts.part = parts_of_samples(problem.surface, problem.samples);
              return heat->solve(with_parts, options, task, report);
            };
      })};
}

}  // namespace littoral
