// Quadratic-order distance through tets, as an entry of the registry.

#include <memory>
#include <vector>

#include "api/tet/tet_domain.h"
#include "littoral/error.h"
#include "methods/quadratic/quadratic.h"
#include "operators/p2_tets.h"

namespace littoral {

namespace {

using Shape = P2Shape<3>;

Shape::Point local_node(int i) {
  return i < Shape::corners ? Shape::corner(i) : Shape::middle(i - Shape::corners);
}

/// Vertices of the source, or the nodes of the elements that hold it with their distance to it.
std::vector<P2Source<3>> sources_of(const TetProblem& problem, const P2Tets& P) {
  std::vector<Shape::Point> local;
  for (int i = 0; i < Shape::nodes; ++i) local.push_back(local_node(i));
  const auto element = [&](int t) { return P.element_of_tet[t]; };
  const auto node_of = [&](int t, int i) {
    const auto e = std::size_t(element(t));
    return P.elements.node[e][i];
  };
  const auto known = problem.known(local, node_of, Around::alone);
  std::vector<P2Source<3>> out;
  for (const auto& [node, at] : known)
    out.push_back({{{element(at.tet), at.b}}, problem.vertices.empty(), at.distance});
  return out;
}

/// Elements of a mesh and, once a source has been solved for, its symbolic factorizations.
struct Elements3 {
  P2Tets tets;
  QuadraticSolver<3> method;

  explicit Elements3(const TetDiscretization& on)
      : tets(p2_elements(*on.mesh(), *on.operators())),
        method(std::make_shared<const P2Elements<3>>(tets.elements)) {}
};

VecX quadratic(const Elements3& E, const TetProblem& problem, const Quadratic& options, Task& task,
               Report& report) {
  const bool from_vertices = !problem.vertices.empty();
  if (!from_vertices && problem.surface.n_faces() == 0)
    throw UnsupportedError(
        "quadratic distance through tets is from vertices or a surface with faces, not from a "
        "cloud");
  const auto sources = sources_of(problem, E.tets);
  if (sources.empty()) throw InputError("no source vertex belongs to a tet", "nothing-there");
  return E.method.solve(sources, options, task.stage(0.9, "distance"), report).at_vertices();
}

}  // namespace

std::vector<Method<TetDomain>> quadratic_tet_methods() {
  return {make_tet_method(
      {TetQuadratic::method,
       "Distance from vertices, or from a surface without sign, of quadratic order.",
       {},
       {},
       "Ruan, Chern, Li, Subr, Vaxman: Quadratic-Order Geodesics on Meshes"},
      tet_quadratic_options(),
      [](const std::shared_ptr<const TetDiscretization>& on, const TetQuadratic&, SolveHint) {
        return [E = std::make_shared<const Elements3>(*on)](const TetProblem& problem,
                                                            const TetQuadratic& options, Task& task,
                                                            Report& report) {
          const Quadratic all{.tolerance = options.tolerance,
                              .max_iterations = options.max_iterations,
                              .source_radius = options.source_radius,
                              .insert_samples = options.insert_samples};
          return quadratic(*E, problem, all, task, report);
        };
      })};
}

}  // namespace littoral
