#pragma once
// Distance on a mesh in one call, from the layers below the API.

#include <algorithm>
#include <cmath>
#include <memory>

#include "domain/intrinsic/intrinsic_triangulation.h"
#include "methods/heat/signed_heat.h"
#include "methods/heat/unsigned_heat.h"
#include "operators/triangles.h"
#include "sources/surface/pieces.h"
#include "sources/systems/triangle_source_system.h"

namespace littoral::test {

struct Problem {
  IntrinsicTriangulation T;
  std::shared_ptr<const Operators> ops;
  SourceSystem terms;
};

inline Problem problem(const SurfaceMesh& mesh, const Sources& sources, Report& report) {
  Problem p{intrinsic_triangulation(mesh, report), nullptr, {}};
  p.ops = std::make_shared<const Operators>(triangle_operators(p.T));
  p.terms = source_system(mesh, p.T, place_sources(mesh, sources, report));
  return p;
}

inline VecX signed_heat(const SurfaceMesh& mesh, const Sources& sources, SignedHeat options,
                        Report& report) {
  const Problem p = problem(mesh, sources, report);
  if (options.time_scale == 0) options.time_scale = automatic_time_scale(p.terms);
  return SignedHeatSolver(p.ops, options.time_scale, {}, needed_diffusions(p.terms, options))
      .solve(p.terms, options, {}, report);
}

inline VecX unsigned_heat(const SurfaceMesh& mesh, const Sources& sources, Report& report) {
  const Problem p = problem(mesh, sources, report);
  return UnsignedHeatSolver(p.ops, {}).solve(p.terms, {}, report);
}

inline Sources space_curve(const MatX3& points, bool is_signed = true) {
  Sources sources;
  sources.space_curves.push_back({points, is_signed, "test"});
  return sources;
}

inline Sources vertex_points(std::initializer_list<int> vertices) {
  Sources sources;
  for (int v : vertices) sources.points.push_back(SurfacePoint::at_vertex(v));
  return sources;
}

/// A circle of given radius about (x, y, z) in a plane z = const, counter-clockwise from above.
inline MatX3 circle(double x, double y, double z, double radius, int n) {
  MatX3 points(n + 1, 3);
  const double turn = 2 * std::acos(-1.0);
  for (int i = 0; i <= n; ++i) {
    const double a = turn * (i % n) / n;
    points.row(i) << x + radius * std::cos(a), y + radius * std::sin(a), z;
  }
  return points;
}

}  // namespace littoral::test
