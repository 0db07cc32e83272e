// Regularized geodesic distance as an entry of the registry.

#include <memory>

#include "littoral/api/regularized_method.h"
#include "littoral/api/surface_method.h"
#include "littoral/base/error.h"
#include "littoral/domain/intrinsic_triangulation.h"
#include "littoral/io/read_directions.h"
#include "littoral/methods/regularized.h"
#include "littoral/operators/curved_hessian.h"
#include "littoral/operators/line_field.h"
#include "littoral/operators/triangles.h"
#include "littoral/sources/triangle_source_terms.h"

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

}  // namespace

Regularized regularized_on(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                           const std::shared_ptr<const Operators>& ops,
                           const RegularizedOptions& options, const Task& task, Report& report) {
  const Stopwatch watch(report, "factor");
  const auto regularizer = static_cast<Regularizer>(options.regularizer);
  RegularizerData data;
  if (options.alpha > 0 && regularizer == Regularizer::align)
    data.V = field(mesh, T, ops, options, task, report);
  if (options.alpha > 0 && regularizer == Regularizer::hessian)
    data.W = curved_hessian(T, ops->vector);
  if (regularizer == Regularizer::max_norm) data.frames = face_frames(mesh, T);
  return Regularized(ops, options.alpha > 0 ? regularizer : Regularizer::dirichlet, std::move(data),
                     task);
}

namespace {

SurfaceResult regularized(const SurfaceProblem& problem, RegularizedOptions& options, Task& task,
                          Report& report) {
  const PreparedSources prepared = prepared_sources(problem, task, report);
  task.checkpoint();
  const IntrinsicTriangulation T = intrinsic_triangulation(problem.mesh, report);
  const auto ops = std::make_shared<const Operators>(triangle_operators(T));
  const SourceTerms terms = source_terms(problem.mesh, T, prepared);
  Task factoring = task.stage(0.3, "factoring");
  const Regularized method = regularized_on(problem.mesh, T, ops, options, factoring, report);
  const Stopwatch watch(report, "solve");
  return {method.solve(terms, options, task.stage(0.65, "alternating directions"), report), {}};
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
           "unaffected by "
           "boundaries.",
           {"triangle mesh"},
           {},
           "Edelstein, Guillen, Solomon, Ben-Chen: A Convex Optimization Framework for Regularized "
           "Geodesic Distances (2023)"},
          regularized_options(), regularized),
      surface_method({"belyaev-fayolle",
                      "Unsigned distance as the largest function of slope at most 1.",
                      {"triangle mesh"},
                      {},
                      "Belyaev, Fayolle: An ADMM-based scheme for distance function approximation "
                      "(2020)"},
                     constrained_options(), belyaev_fayolle)};
}

}  // namespace littoral
