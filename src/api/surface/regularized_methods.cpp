// Regularized geodesic distance as an entry of the registry.

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "api/surface/regularized_method.h"
#include "api/surface/subdivided.h"
#include "api/surface/surface_method.h"
#include "api/surface/translated.h"
#include "base/error.h"
#include "domain/intrinsic/intrinsic_triangulation.h"
#include "io/surface/read_directions.h"
#include "methods/regularized/regularized.h"
#include "operators/curved_hessian.h"
#include "operators/line_field.h"
#include "operators/triangles.h"
#include "sources/p2_sources.h"
#include "sources/triangle_source_terms.h"

namespace littoral {

namespace {

/// exp(-d^2 / (2 sigma^2)) with d the distance, without regularization, from the given faces (4.1).
void localise(VecX& V, const std::vector<std::pair<int, Complex>>& given, double width,
              std::shared_ptr<const Operators> ops, const IntrinsicTriangulation& T,
              const Task& task) {
  const Calculus& C = ops->scalar;
  Triplets entries;
  for (std::size_t i = 0; i < given.size(); ++i)
    for (int k = 0; k < 3; ++k)
      entries.emplace_back(static_cast<int>(i), T.faces(given[i].first, k), 1.0 / 3);
  SpMat rows(static_cast<Eigen::Index>(given.size()), T.n_vertices);
  rows.setFromTriplets(entries.begin(), entries.end());
  RegularizedOptions options;
  options.alpha = 0;
  AdmmState state;
  const VecX d = Regularized(std::move(ops), Regularizer::dirichlet, {}, task)
                     .minimize(rows, options, state, task)
                     .u;
  const double sigma = width * std::sqrt(C.A.sum());
  for (int f = 0; f < T.n_faces(); ++f) {
    const double mean = (d[T.faces(f, 0)] + d[T.faces(f, 1)] + d[T.faces(f, 2)]) / 3;
    V.segment<2>(2 * f) *= std::exp(-mean * mean / (2 * sigma * sigma));
  }
}

VecX field(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
           const std::shared_ptr<const Operators>& ops, const RegularizedOptions& options,
           const Task& task, Report& report) {
  if (options.field.empty())
    throw InputError("--regularizer align needs directions: name --field FILE");
  const io::FaceDirections read = io::read_directions(options.field, mesh.n_faces());
  if (read.all.rows() > 0) {
    VecX V(2 * T.n_faces());
    int without = 0;
    for (int f = 0; f < mesh.n_faces(); ++f) {
      const int t = T.triangle_of_face[f];
      if (t < 0) continue;
      const Complex v = tangent_part(mesh, T, f, read.all.row(f));
      V[2 * t] = v.real();
      V[2 * t + 1] = v.imag();
      if (!(std::abs(v) > 0)) ++without;
    }
    if (without)
      report.warn(std::to_string(without) +
                  " faces have no direction in their plane; nothing is aligned there");
    return V;
  }
  std::vector<std::pair<int, Complex>> given;
  for (const auto& [f, v] : read.sparse) {
    const int t = T.triangle_of_face[f];
    const Complex z = t < 0 ? 0 : tangent_part(mesh, T, f, v);
    if (!(std::abs(z) > 1e-9 * v.norm()))
      throw InputError(options.field + ": the direction at face " + std::to_string(f) +
                       " is perpendicular to the face");
    given.emplace_back(t, z);
  }
  VecX V = interpolate_line_field(T, given, task);
  if (options.field_width > 0) localise(V, given, options.field_width, ops, T, task);
  return V;
}

/// Only the Hessian needs more than the scalar operators.
std::shared_ptr<const Operators> operators_for(const IntrinsicTriangulation& T,
                                               const P2Elements<2>* elements, bool vectors) {
  if (vectors) return std::make_shared<const Operators>(triangle_operators(T));
  Operators ops;
  ops.domain = "triangle mesh";
  ops.unit = T.unit;
  ops.scalar = elements ? p2_calculus(*elements)
                        : triangle_calculus(std::make_shared<const IntrinsicTriangulation>(T));
  return std::make_shared<const Operators>(std::move(ops));
}

/// Rows u = 0 at points of quadratic elements.
SourceTerms quadratic_terms(const P2Elements<2>& E, const std::vector<P2Source<2>>& sources) {
  std::vector<P2Point<2>> points;
  SourceTerms terms;
  terms.reached.assign(static_cast<std::size_t>(E.n_components), 0);
  for (const P2Source<2>& source : sources) {
    points.push_back(source.where.front());
    terms.reached[E.component[E.node[points.back().element][0]]] = 1;
  }
  terms.A = p2_interpolation<2>(E, points);
  return terms;
}

}  // namespace

RegularizedSurface::RegularizedSurface(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                                       const RegularizedOptions& options, const Task& task,
                                       Report& report)
    : mesh_(mesh), T_(T) {
  const Stopwatch watch(report, "factor");
  const auto regularizer =
      options.alpha > 0 ? static_cast<Regularizer>(options.regularizer) : Regularizer::dirichlet;
  if (static_cast<Elements>(options.elements) == Elements::quadratic) {
    if (regularizer != Regularizer::dirichlet)
      throw UnsupportedError(
          "quadratic elements have the Dirichlet energy only: leave out --elements quadratic");
    elements_ = std::make_shared<const P2Elements<2>>(p2_elements(T));
  }
  const auto ops = operators_for(T, elements_.get(), regularizer == Regularizer::hessian);
  RegularizerData data;
  if (regularizer == Regularizer::align) data.V = field(mesh, T, ops, options, task, report);
  if (regularizer == Regularizer::hessian) data.W = curved_hessian(T, ops->vector);
  if (regularizer == Regularizer::max_norm) data.frames = face_frames(mesh, T);
  method_ = std::make_unique<const Regularized>(ops, regularizer, std::move(data), task);
}

VecX RegularizedSurface::solve(const PreparedSources& sources, const RegularizedOptions& options,
                               const Task& task, Report& report) const {
  const SourceTerms terms = elements_
                                ? quadratic_terms(*elements_, p2_sources(mesh_, T_, sources, 0.5))
                                : source_terms(mesh_, T_, sources);
  return method_->solve(terms, options, task, report);
}

namespace {

SurfaceResult on_triangles(const SurfaceProblem& problem, const RegularizedOptions& options,
                           Task& task, Report& report) {
  const PreparedSources prepared = prepared_sources(problem, task, report);
  task.checkpoint();
  const IntrinsicTriangulation T = intrinsic_triangulation(problem.mesh, report);
  const RegularizedSurface method(problem.mesh, T, options, task.stage(0.3, "factoring"), report);
  const Stopwatch watch(report, "solve");
  const VecX u =
      method.solve(prepared, options, task.stage(0.65, "alternating directions"), report);
  SurfaceResult result{u.head(problem.mesh.n_vertices()), {}};
  const int n = static_cast<int>(options.subdivide);
  const P2Elements<2>* E = method.quadratic();
  if (E && n > 1)
    result.shown = subdivided(problem.mesh, T, n, result.values, [&](int triangle, const Vec3& b) {
      const double d = E->value(u, triangle, b);
      return std::isfinite(d) ? std::max(0.0, d) : std::numeric_limits<double>::infinity();
    });
  return result;
}

/// Polygon meshes, point clouds, voxel surfaces: functions of values at nodes all the same.
SurfaceResult on_nodes(const SurfaceProblem& problem, const RegularizedOptions& options, Task& task,
                       Report& report) {
  if (static_cast<Elements>(options.elements) == Elements::quadratic)
    throw UnsupportedError("quadratic elements need a triangle mesh, not a " + problem.domain());
  const auto regularizer = static_cast<Regularizer>(options.regularizer);
  if (options.alpha > 0 && regularizer != Regularizer::dirichlet)
    throw UnsupportedError("on a " + problem.domain() +
                           " there is the regularizer dirichlet only; the others need a triangle "
                           "mesh: littoral convert --triangulate");
  const Translated on = translate_nodes(problem, task, report);
  const Regularized method(on.ops, Regularizer::dirichlet, {}, task.stage(0.3, "factoring"));
  const Stopwatch watch(report, "solve");
  return at_input(
      problem, on.faces.get(),
      method.solve(on.terms, options, task.stage(0.65, "alternating directions"), report));
}

SurfaceResult regularized(const SurfaceProblem& problem, RegularizedOptions& options, Task& task,
                          Report& report) {
  return problem.domain() == "triangle mesh" ? on_triangles(problem, options, task, report)
                                             : on_nodes(problem, options, task, report);
}

SurfaceResult belyaev_fayolle(const SurfaceProblem& problem, RegularizedOptions& options,
                              Task& task, Report& report) {
  options.alpha = 0;
  return regularized(problem, options, task, report);
}

}  // namespace

std::vector<SurfaceMethod> regularized_methods() {
  return {
      surface_method(
          {"regularized",
           "Unsigned distance that is smooth at the cut locus, aligned to directions, or "
           "unaffected by boundaries.",
           all_surfaces(),
           {},
           "Edelstein, Guillen, Solomon, Ben-Chen: A Convex Optimization Framework for Regularized "
           "Geodesic Distances (2023)"},
          regularized_options(), regularized),
      surface_method({"belyaev-fayolle",
                      "Unsigned distance as the largest function of slope at most 1.",
                      all_surfaces(),
                      {},
                      "Belyaev, Fayolle: An ADMM-based scheme for distance function approximation "
                      "(2020)"},
                     constrained_options(), belyaev_fayolle)};
}

}  // namespace littoral
