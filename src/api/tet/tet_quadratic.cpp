// Quadratic-order distance through tets, as an entry of the registry.

#include <map>
#include <memory>

#include "api/tet/tet_domain.h"
#include "domain/mesh/triangulate.h"
#include "littoral/error.h"
#include "methods/quadratic/quadratic.h"
#include "operators/p2_tets.h"
#include "spatial/triangle_bvh.h"

namespace littoral {

namespace {

using Shape = P2Shape<3>;

Shape::Point local_node(int i) {
  return i < Shape::corners ? Shape::corner(i) : Shape::middle(i - Shape::corners);
}

/// Each of the vertices in the first element that has it.
std::vector<P2Source<3>> at_vertices(const P2Elements<3>& E, const std::vector<int>& vertices) {
  std::vector<char> wanted(static_cast<std::size_t>(E.n_vertices), 0);
  for (const int v : vertices) wanted[static_cast<std::size_t>(v)] = 1;
  std::vector<P2Source<3>> out;
  for (int e = 0; e < E.n_elements(); ++e)
    for (int k = 0; k < Shape::corners; ++k) {
      char& missing = wanted[static_cast<std::size_t>(E.node[static_cast<std::size_t>(e)][k])];
      if (missing != 0) out.push_back({{{e, Shape::corner(k)}}, false, 0});
      missing = 0;
    }
  return out;
}

/// The nodes of the elements that hold the surface, with their distance to it.
std::vector<P2Source<3>> around(const TetProblem& problem, const P2Tets& P) {
  const TetMesh& mesh = *problem.mesh;
  const PolygonSoup soup = triangulate(problem.surface);
  const TriangleBvh tree(soup.points, triangles_of(soup));
  std::map<int, P2Source<3>> at_node;
  for (const int t : problem.tets_with_sources()) {
    const int e = P.element_of_tet[static_cast<std::size_t>(t)];
    for (int i = 0; i < Shape::nodes; ++i) {
      const int node = P.elements.node[static_cast<std::size_t>(e)][static_cast<std::size_t>(i)];
      if (at_node.count(node) != 0) continue;
      const Shape::Point b = local_node(i);
      Vec3 x = Vec3::Zero();
      for (int k = 0; k < Shape::corners; ++k) x += b[k] * mesh.points.row(mesh.tets(t, k));
      at_node[node] = {{{e, b}}, true, tree.closest_point(x).distance};
    }
  }
  std::vector<P2Source<3>> out;
  for (auto& [node, source] : at_node) out.push_back(std::move(source));
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
  const auto sources =
      from_vertices ? at_vertices(E.tets.elements, problem.vertices) : around(problem, E.tets);
  if (sources.empty()) throw InputError("no source vertex belongs to a tet");
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
      [](const std::shared_ptr<const TetDiscretization>& on, const TetQuadratic&) {
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
