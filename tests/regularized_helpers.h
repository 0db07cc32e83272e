#pragma once
// Regularized distance in one call.

#include "geodesic_helpers.h"
#include "methods/regularized/regularized.h"
#include "operators/curved_hessian.h"
#include "operators/line_field.h"
#include "shared_data.h"
#include "test_meshes.h"

namespace littoral::test {

/// The interval [0, 1] from 0 with the Dirichlet energy: u' = min(1, (1 - x) / alpha).
inline double from_one_end(double x, double alpha) {
  const double free = 1 - alpha;
  return x <= free ? x : 1 - alpha / 2 - (1 - x) * (1 - x) / (2 * alpha);
}

struct Solved {
  VecX u;
  Report report;
};

inline Regularized with_alpha(double alpha, double tolerance = 1e-4) {
  Regularized options;
  options.alpha = alpha;
  options.tolerance = tolerance;
  return options;
}

inline Solved solve(const SurfaceMesh& mesh, const Sources& sources, const Regularized& options,
                    Regularizer regularizer = Regularizer::dirichlet, VecX V = {}) {
  Solved out;
  const Problem p = problem(mesh, sources, out.report);
  const KnownDistances known =
      known_distances(p.T, triangle_sources(mesh, p.T, place_sources(mesh, sources, out.report)),
                      TriangleNodes::corners);
  RegularizerData data;
  data.V = std::move(V);
  if (regularizer == Regularizer::hessian) data.W = curved_hessian(p.T, p.ops->vector);
  if (regularizer == Regularizer::max_norm) data.frames = face_frames(mesh, p.T);
  out.u = RegularizedSolver(p.ops, regularizer, std::move(data), {})
              .solve(known, options, {}, out.report);
  return out;
}

/// Mean of |u - exact| over the nodes that `part` names.
template <class Exact, class Part>
double mean_error(const MatX3& points, const VecX& u, const Exact& exact, const Part& part) {
  double sum = 0, count = 0;
  for (Eigen::Index v = 0; v < points.rows(); ++v) {
    const Vec3 x = points.row(v);
    if (!part(x)) continue;
    sum += std::abs(u[v] - exact(x));
    ++count;
  }
  return sum / count;
}

inline double residual(const Report& report, const std::string& name) {
  for (const auto& [key, value] : report.residuals)
    if (key == name) return value;
  return -1;
}

}  // namespace littoral::test
