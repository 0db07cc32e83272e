// Regularized geodesic distance as an entry of the registry.

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "api/surface/discretization.h"
#include "api/surface/subdivided.h"
#include "base/counted.h"
#include "base/index.h"
#include "base/stopwatch.h"
#include "domain/intrinsic/intrinsic_delaunay.h"
#include "domain/intrinsic/lengthened_sides.h"
#include "io/surface/read_directions.h"
#include "littoral/error.h"
#include "methods/regularized/regularized.h"
#include "operators/curved_hessian.h"
#include "operators/line_field.h"
#include "operators/p2.h"
#include "operators/triangles.h"
#include "sources/surface/known_distances.h"

namespace littoral {

namespace {

/// exp(-d^2 / (2 sigma^2)) with d the distance, without regularization, from the given faces (4.1).
void localise(VecX& V, const std::vector<std::pair<int, Complex>>& given, double width,
              std::shared_ptr<const Operators> ops, const IntrinsicTriangulation& T,
              const Task& task) {
  const Calculus& C = ops->scalar;
  constexpr double third = 1.0 / 3;
  TriangleSources middles;
  for (const auto& [f, direction] : given)
    middles.isolated.inside.push_back({f, {third, third, third}});
  const KnownDistances known = known_distances(T, middles, TriangleNodes::corners);
  Regularized options;
  options.alpha = 0;
  AdmmState state;
  const VecX d =
      RegularizedSolver(std::move(ops), Regularizer::dirichlet, {}, task, SolveHint::single_rhs)
          .minimize(known, options, state, task)
          .u;
  const double sigma = width * std::sqrt(C.A.sum());
  for (int f = 0; f < T.n_faces(); ++f) {
    const double mean = (d[T.faces(f, 0)] + d[T.faces(f, 1)] + d[T.faces(f, 2)]) / 3;
    V.segment<2>(2 * f) *= std::exp(-mean * mean / (2 * sigma * sigma));
  }
}

VecX field(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
           const std::shared_ptr<const Operators>& ops, const Regularized& options,
           const Task& task, Report& report) {
  if (options.field.empty())
    throw InputError("regularizer align needs directions: option field names their file",
                     "nothing-given");
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
      report.warn("direction-missing",
                  counted(without, "face has", "faces have") +
                      " no direction in the plane of the face; nothing is aligned there");
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

// On 40 meshes, error against exact distance on their own triangles beside Delaunay ones:
// docs/measurements/regularized.md. Above, most have less on the latter, up to half; below there is
// little difference.
constexpr double most_not_delaunay = 0.075;  // of the edges

/// Where functions live, and what solves there.
struct OnTriangles {
  std::shared_ptr<const IntrinsicTriangulation> T;
  std::shared_ptr<const RegularizedSolver> method;
};

/// The edges of the surface that sources run along, marked, if one of them is no edge of `flipped`;
/// else empty. Vertices have the same numbers in both.
std::vector<char> lost_edges(const IntrinsicTriangulation& given,
                             const IntrinsicTriangulation& flipped, const PlacedSources& placed) {
  struct Edge {
    int e;
    double length;
  };
  std::map<std::pair<int, int>, Edge> wanted;  // by its ends
  const auto ends = [](const IntrinsicTriangulation& T, int f, int k) {
    return std::minmax({T.faces(f, k), T.faces(f, (k + 1) % 3)});
  };
  for (const CurvePiece& piece : placed.pieces) {
    const int f = given.triangle_of_face[piece.face];
    for (int k = 0; k < 3 && f >= 0; ++k)
      if (piece.edge >= 0 && given.side_edge(f, k) == piece.edge)
        wanted.emplace(ends(given, f, k), Edge{piece.edge, given.length(f, k)});
  }
  if (wanted.empty()) return {};
  std::vector<char> along(given.n_edges(), 0);
  for (const auto& [between, edge] : wanted) along[edge.e] = 1;
  for (int f = 0; f < flipped.n_faces() && !wanted.empty(); ++f)
    for (int k = 0; k < 3; ++k) {
      const auto at = wanted.find(ends(flipped, f, k));  // several edges may join two vertices
      if (at == wanted.end()) continue;
      const double length = flipped.length(f, k);
      if (std::abs(length - at->second.length) <= 1e-6 * length) wanted.erase(at);
    }
  return wanted.empty() ? std::vector<char>() : along;
}

/// How much over 1 the largest gradient at a corner is: the limit holds at the middles of sides.
double longest_at_corners(const P2Elements<2>& E, const VecX& u) {
  double longest = 1;
  for (int f = 0; f < E.n_elements(); ++f)
    for (int k = 0; k < 3; ++k) {
      const double slope = E.gradient(u, f, P2Shape<2>::corner(k)).norm() / E.unit;
      if (std::isfinite(slope)) longest = std::max(longest, slope);
    }
  return longest - 1;
}

/// Triangle meshes: directions read and interpolated, elements, one factorization.
class RegularizedTriangles {
 public:
  RegularizedTriangles(SurfaceDomain domain, const Regularized& options, SolveHint hint,
                       const Task& task, Report& report)
      : domain_(std::move(domain)),
        hint_(hint),
        given_(without_needles(triangulation_of(domain_, report), report)),
        used_{given_, nullptr} {
    const auto regularizer = options.alpha > 0 ? options.regularizer : Regularizer::dirichlet;
    const bool quadratic = options.elements == Elements::quadratic;
    if (quadratic && regularizer != Regularizer::dirichlet)
      throw UnsupportedError(
          "quadratic elements have the Dirichlet energy only: they do not go with option "
          "regularizer",
          "options-conflict");
    if (may_flip(quadratic || regularizer != Regularizer::dirichlet, options.triangulation)) {
      used_ = on_delaunay({}, task, report);
      return;
    }
    const Stopwatch watch(report, "factor");
    if (quadratic) elements_ = std::make_shared<const P2Elements<2>>(p2_elements(*given_));
    const auto ops = operators_for(*given_, elements_.get(), regularizer == Regularizer::hessian);
    RegularizerData data;
    if (regularizer == Regularizer::align)
      data.V = field(*domain_.mesh, *given_, ops, options, task, report);
    if (regularizer == Regularizer::hessian) data.W = curved_hessian(*given_, ops->vector);
    if (regularizer == Regularizer::max_norm) data.frames = face_frames(*domain_.mesh, *given_);
    used_.method =
        std::make_shared<const RegularizedSolver>(ops, regularizer, std::move(data), task, hint_);
  }

  SurfaceAnswer solve(const Sources& sources, const Regularized& options, Task& task,
                      Report& report) const {
    const SurfaceMesh& mesh = *domain_.mesh;
    const PlacedSources placed =
        place_sources(domain_, sources, task.stage(0.02, "placing the sources"), report);
    // Flips leave vertices where they are, and so what is known there.
    const KnownDistances known =
        known_distances(*given_, triangle_sources(mesh, *given_, placed),
                        elements_ ? TriangleNodes::corners_and_middles : TriangleNodes::corners);
    OnTriangles used = used_;
    if (used.T != given_)
      if (const auto keep = lost_edges(*given_, *used.T, placed); !keep.empty())
        used = on_delaunay(keep, task, report);
    const Stopwatch watch(report, "solve");
    const VecX u =
        used.method->solve(known, options, task.stage(0.98, "alternating directions"), report);
    if (elements_)
      report.residuals.emplace_back("largest gradient over 1, at corners",
                                    longest_at_corners(*elements_, u));
    SurfaceAnswer answer{u.head(mesh.n_vertices()), {}};
    if (elements_ && options.subdivide > 1)
      answer.shown = subdivided(mesh, *given_, options.subdivide, answer.values,
                                [&](int triangle, const Vec3& b) {
                                  const double d = elements_->value(u, triangle, b);
                                  return std::isfinite(d) ? std::max(0.0, d) : infinity;
                                });
    return answer;
  }

 private:
  /// Are functions to live on other triangles? needs_given: they are of a kind that cannot.
  bool may_flip(bool needs_given, Triangles asked) const {
    if (needs_given && asked == Triangles::delaunay)
      throw UnsupportedError(
          "option triangulation: Delaunay triangles go with linear elements and the Dirichlet "
          "energy or none, not with other elements or regularizers",
          "options-conflict");
    if (needs_given || asked == Triangles::as_is) return false;
    return asked == Triangles::delaunay || share_not_delaunay(*given_) > most_not_delaunay;
  }

  /// Intrinsic Delaunay triangles with the same vertices; edges that are marked in `keep` stay.
  OnTriangles on_delaunay(const std::vector<char>& keep, const Task& task, Report& report) const {
    OnTriangles out;
    {
      const Stopwatch watch(report, "triangulation");
      RefineOptions flips;
      flips.smallest_angle = 0;
      flips.keep = keep;
      auto fine = intrinsic_delaunay(*domain_.mesh, *given_, {}, flips, report, task);
      out.T = without_needles(std::make_shared<const IntrinsicTriangulation>(std::move(fine.T)),
                              report);
    }
    const Stopwatch watch(report, "factor");
    out.method = std::make_shared<const RegularizedSolver>(operators_for(*out.T, nullptr, false),
                                                           Regularizer::dirichlet,
                                                           RegularizerData{}, task, hint_);
    return out;
  }

  SurfaceDomain domain_;
  SolveHint hint_;
  std::shared_ptr<const IntrinsicTriangulation> given_;
  OnTriangles used_;  // on the given triangles, or on others with the same vertices
  std::shared_ptr<const P2Elements<2>> elements_;
};

/// Polygon meshes, point clouds, voxel surfaces: functions of values at nodes all the same.
class RegularizedNodes {
 public:
  RegularizedNodes(const SurfaceDomain& domain, const Regularized& options, SolveHint hint,
                   Task task, Report& report)
      : surface_((check(domain.kind(), options), domain), task.stage(0.5, "operators"), report,
                 nullptr, Needles::thicker) {
    const Stopwatch watch(report, "factor");
    method_ = std::make_shared<const RegularizedSolver>(surface_.operators(),
                                                        Regularizer::dirichlet, RegularizerData{},
                                                        task.stage(0.5, "factoring"), hint);
  }

  SurfaceAnswer solve(const Sources& sources, const Regularized& options, Task& task,
                      Report& report) const {
    const KnownDistances known =
        surface_.known(sources, task.stage(0.02, "placing the sources"), report);
    const Stopwatch watch(report, "solve");
    return surface_.at_input(
        method_->solve(known, options, task.stage(0.98, "alternating directions"), report));
  }

 private:
  static void check(const std::string& kind, const Regularized& options) {
    if (options.triangulation == Triangles::delaunay)
      throw UnsupportedError(
          "option triangulation: Delaunay triangles need a triangle mesh, not a " + kind);
    if (options.elements == Elements::quadratic)
      throw UnsupportedError("quadratic elements need a triangle mesh, not a " + kind);
    if (options.alpha > 0 && options.regularizer != Regularizer::dirichlet)
      throw UnsupportedError("on a " + kind +
                             " there is the regularizer dirichlet only; the others need a triangle "
                             "mesh: cut the polygons into triangles first");
  }
  SurfaceDiscretization surface_;
  std::shared_ptr<const RegularizedSolver> method_;
};

using SolveRegularized =
    std::function<SurfaceAnswer(const Sources&, const Regularized&, Task&, Report&)>;

SolveRegularized regularized(const SurfaceDomain& domain, const Regularized& options,
                             SolveHint hint, const Task& task, Report& report) {
  const auto with = [](auto method) -> SolveRegularized {
    return [method](const Sources& sources, const Regularized& o, Task& t, Report& r) {
      return method->solve(sources, o, t, r);
    };
  };
  if (domain.kind() == "triangle mesh")
    return with(std::make_shared<const RegularizedTriangles>(domain, options, hint, task, report));
  return with(std::make_shared<const RegularizedNodes>(domain, options, hint, task, report));
}

/// The regularized method without smoothing (eq. 1).
Regularized without_smoothing(const BelyaevFayolle& options) {
  Regularized out;
  out.alpha = 0;
  out.tolerance = options.tolerance;
  out.gap = options.gap;
  out.max_iterations = options.max_iterations;
  out.elements = options.elements;
  out.triangulation = options.triangulation;
  out.subdivide = options.subdivide;
  return out;
}

}  // namespace

std::vector<Method<SurfaceDomain>> regularized_methods() {
  return {
      make_method<SurfaceDomain>(
          {Regularized::method,
           "Unsigned distance that is smooth at the cut locus, aligned to directions, or "
           "unaffected by boundaries.",
           all_surfaces(),
           {},
           "Edelstein, Guillen, Solomon, Ben-Chen: A Convex Optimization Framework for Regularized "
           "Geodesic Distances (2023)"},
          regularized_options(),
          [](const SurfaceDomain& domain, const Regularized& options, SolveHint hint,
             const Task& task,
             Report& report) { return regularized(domain, options, hint, task, report); }),
      make_method<SurfaceDomain>(
          {BelyaevFayolle::method,
           "Unsigned distance as the largest function of gradient at most 1.",
           all_surfaces(),
           {},
           "Belyaev, Fayolle: An ADMM-based scheme for distance function approximation (2020)"},
          belyaev_fayolle_options(),
          [](const SurfaceDomain& domain, const BelyaevFayolle& options, SolveHint hint,
             const Task& task, Report& report) {
            return [solve = regularized(domain, without_smoothing(options), hint, task, report)](
                       const Sources& sources, const BelyaevFayolle& o, Task& t, Report& r) {
              return solve(sources, without_smoothing(o), t, r);
            };
          })};
}

}  // namespace littoral
