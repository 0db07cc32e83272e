#pragma once
// Quadratic-order distance on a mesh in one call, from the layers below the API.

#include <algorithm>
#include <cmath>

#include "domain/intrinsic/intrinsic_triangulation.h"
#include "methods/quadratic/quadratic.h"
#include "sources/surface/p2_sources.h"
#include "sources/surface/pieces.h"

namespace littoral::test {

inline QuadraticField<2> quadratic(const SurfaceMesh& mesh, const Sources& sources,
                                   const Quadratic& options, Report& report) {
  const IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
  const auto points = p2_sources(mesh, T, place_sources(mesh, sources, report), options.spacing);
  const QuadraticSolver<2> method(std::make_shared<const P2Elements<2>>(p2_elements(T)));
  return method.solve(points, options, {}, report);
}

inline Sources point_source(const SurfacePoint& p) {
  Sources sources;
  sources.points.push_back(p);
  return sources;
}

/// Largest difference of squared distances at corners, edge midpoints and near centres. (Next to a
/// source the root of a tiny error is not tiny.)
template <class Exact>
double largest_squared_error(const SurfaceMesh& mesh, const QuadraticField<2>& field, Exact exact) {
  double worst = 0;
  for (int f = 0; f < mesh.n_faces(); ++f)
    for (const Vec3& b : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(0.5, 0.5, 0),
                          Vec3(0.5, 0, 0.5), Vec3(0, 0.5, 0.5), Vec3(0.3, 0.3, 0.4)})
      worst = std::max(worst,
                       std::abs(field.distance(f, b) -
                                exact(mesh.position(SurfacePoint::in_face(f, b[0], b[1], b[2])))));
  return worst;
}

}  // namespace littoral::test
