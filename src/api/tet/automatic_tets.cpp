// Straight ways first: the default for distance through tets.
//
// The nearest point of the source is the end of the shortest way wherever it is in sight. Other
// ways bend at the boundary. Which side of a surface is which shows where a way meets it; where
// that contradicts itself, the surface is completed by the zero set of the signed heat method.

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "api/tet/tet_domain.h"
#include "base/counted.h"
#include "base/index.h"
#include "base/parallel.h"
#include "base/stopwatch.h"
#include "contour/isosurface.h"
#include "domain/tet/tet_sight.h"
#include "methods/geodesic/tet_paths.h"
#include "methods/implicit/settled_sides.h"
#include "sources/space/surface_in_tets.h"
#include "spatial/boundary_edges.h"
#include "spatial/pseudonormals.h"
#include "spatial/triangulate.h"

namespace littoral {

namespace {

constexpr double near_source = 0.5;  // mean edges: the zero set there is the source itself
constexpr double longer = 1 + 1e-3;  // than a surface between two vertices allows: their distances
constexpr double contradicting = 0.01;  // share of the sign changes

/// A surface or cloud, as far as it tells the sides of its faces.
struct Sides {
  MatX3 points;
  MatX3i faces;
  TriangleBvh nearest;
  Pseudonormals normals;

  Sides(MatX3 at, MatX3i triangles)
      : points(std::move(at)),
        faces(std::move(triangles)),
        nearest(points, faces),
        normals(points, faces) {}

  /// The side of x, seen from q on the surface.
  double side(const Vec3& q, const Vec3& x) const {
    return normals.at(nearest.closest_point(q)).dot(x - q) < 0 ? -1 : 1;
  }
  /// Whether q is where that side is sure: on the surface, off its ends.
  bool tells(const Vec3& q) const {
    const NearestPoint foot = nearest.closest_point(q);
    return foot.distance < 1e-9 && !normals.at_end(foot);
  }
};

class AutomaticThroughTets {
 public:
  explicit AutomaticThroughTets(std::shared_ptr<const TetDiscretization> on)
      : on_(std::move(on)),
        mesh_(*on_->mesh()),
        ops_(*on_->operators()),
        sight_(mesh_, ops_.tet_faces, ops_.n_faces, ops_.gradients) {}

  /// [length]
  VecX solve(const TetSources& sources, Task& task, Report& report) const {
    const TetProblem problem =
        on_->problem(sources, task.stage(0.1, "placing the sources"), report);
    const std::vector<char> reached = problem.reached();
    for (int c = 0; c < ops_.n_components; ++c)
      if (reached[c] == 0) report.unreachable_components.push_back(c);
    const Stopwatch watch(report, "distance");
    VecX phi = problem.vertices.empty() ? from_surface(problem, sources.flip, task, report)
                                        : from_nodes(problem, sources, task, report);
    return (phi * on_->unit()).array() + problem.value;  // adding 0 leaves no -0
  }

 private:
  int component_of_tet(int t) const { return ops_.component[mesh_.tets(t, 0)]; }

  /// A point is a triangle whose corners are one.
  VecX from_nodes(const TetProblem& problem, const TetSources& sources, Task& task,
                  Report& report) const {
    VecX phi = VecX::Constant(mesh_.n_vertices(), infinity);
    int bent = 0;
    const auto measure = [&](const MatX3i& faces, bool all_seen, double value) {
      TetPathSources from{mesh_.points, faces, {}, true};
      for (const auto& f : faces.rowwise()) {
        int c = ops_.component[f[0]];
        for (const int v : f)
          if (ops_.component[v] < 0) c = -1;
        from.component.push_back(c);
      }
      const TetPathResult found = paths(
          from, all_seen, [](int, const Vec3&, const Vec3&) { return 1.0; },
          task.stage(0.5, "distance"));
      phi = phi.cwiseMin((found.distance.array() + value).matrix());
      bent = std::max(bent, found.bent);
    };
    const auto value_of = [&](std::size_t i) {
      return problem.values.empty() ? 0 : sources.values[i] / on_->unit();
    };
    if (sources.boundary) measure(boundary_faces(mesh_), true, value_of(sources.vertices.size()));
    std::map<double, std::vector<int>> by_value;
    for (std::size_t i = 0; i < sources.vertices.size(); ++i)
      by_value[value_of(i)].push_back(sources.vertices[i]);
    for (const auto& [value, vertices] : by_value) {
      MatX3i points(index(vertices.size()), 3);
      for (Eigen::Index i = 0; i < points.rows(); ++i) points.row(i).setConstant(vertices[i]);
      measure(points, false, value);
    }
    tell_bent(bent, report);
    return phi;
  }

  TetPathResult paths(const TetPathSources& from, bool all_seen, const SideOf& side,
                      const Task& task) const {
    return tet_paths(mesh_, sight_, ops_.component, from, all_seen, side, task);
  }

  void tell_bent(int bent, Report& report) const {
    if (bent == 0) return;
    if (const int folded = folded_tets(mesh_, sight_); folded > 0)
      report.warn("tets-folded", counted(folded, "pair of neighbouring tets lies",
                                         "pairs of neighbouring tets lie") +
                                     " on one side of the face they share, one folded over the "
                                     "other: ways round the boundary may be wrong near such tets");
    report.sizes.emplace_back("share of vertices out of sight",
                              static_cast<double>(bent) / mesh_.n_vertices());
  }

  VecX from_surface(const TetProblem& problem, bool flip, Task& task, Report& report) const {
    if (problem.surface.n_faces() == 0)
      return completed(problem, nullptr, {}, VecX(), task, report);
    const MatX3& points = problem.surface.points;
    MatX3i faces = triangles_of(problem.surface);
    const TetPathSources from = in_tets(problem, faces);
    std::optional<SettledSides> settled = settled_by_winding(points, faces, flip, task, report);
    if (settled && !settled->boundary.empty()) {
      faces = settled->faces;
      settled.reset();
    }
    const Sides sides(points, std::move(faces));
    TetPathResult found = paths(
        from, false,
        [&](int, const Vec3& q, const Vec3& x) { return settled ? 1.0 : sides.side(q, x); },
        task.stage(0.4, "distance"));
    if (settled) set_sides(*settled, found.side);
    const VecX phi = signed_by(found.side, found.distance);
    if (contradictions(phi).second > 0) return completed(problem, &sides, from, phi, task, report);
    tell_bent(found.bent, report);
    return problem.values.empty() ? phi : from_values(problem, found.side, task);
  }

  /// The least of c + d on positive sides, the largest of c - d on negative ones.
  VecX from_values(const TetProblem& problem, const VecX& side, Task& task) const {
    const std::set<double> values(problem.values.begin(), problem.values.end());
    VecX least = VecX::Constant(mesh_.n_vertices(), infinity), most = -least;
    for (const double c : values) {
      const TetProblem part = problem.of_value(c);
      if (part.places.empty()) continue;  // flat
      const VecX d = paths(
                         in_tets(part, triangles_of(part.surface)), false,
                         [](int, const Vec3&, const Vec3&) { return 1.0; },
                         task.stage(0.4 / static_cast<double>(values.size()), "distance"))
                         .distance;
      least = least.cwiseMin((c + d.array()).matrix());
      most = most.cwiseMax((c - d.array()).matrix());
    }
    return (side.array() < 0 && most.array() > -infinity).select(most, least);
  }

  /// Surfaces that are closed, or whose faces disagree in orientation, as in space; none of others.
  static std::optional<SettledSides> settled_by_winding(const MatX3& points, const MatX3i& faces,
                                                        bool flip, Task& task, Report& report) {
    const bool closed = boundary_edges(points, faces).empty();
    if (!closed && Pseudonormals(points, faces).oriented()) return {};
    Report found;  // inside is behind the normals, where these agree
    SettledSides settled =
        settled_sides(points, faces, closed || flip, task.stage(0.1, "orientation"), found);
    if (settled.boundary.empty()) report.merge(found);
    return settled;
  }

  /// Triangles of the source with the component they lie in: themselves, where there is one alone
  /// that holds all of them, otherwise what of them lies in each tet.
  TetPathSources in_tets(const TetProblem& problem, const MatX3i& faces) const {
    const auto is_in = [](const TetPoint& p) { return p.tet >= 0; };
    if (ops_.n_components == 1 && std::all_of(problem.places.begin(), problem.places.end(), is_in))
      return {problem.surface.points, faces, std::vector<int>(std::size_t(faces.rows()), 0), false};
    const SurfaceInTets cut = surface_in_tets(mesh_, sight_, problem.surface.points, faces,
                                              problem.samples.points, problem.places);
    TetPathSources from{cut.points, cut.faces, {}, false};
    for (const int t : cut.tet) from.component.push_back(component_of_tet(t));
    return from;
  }

  void set_sides(const SettledSides& settled, VecX& side) const {
    parallel_for(std::size_t(side.size()), 1024, [&](std::size_t begin, std::size_t end) {
      for (auto v = index(begin); v < index(end); ++v)
        side[v] = settled.inside(mesh_.points.row(v), WindingNumber::sign_accuracy) > 0 ? -1 : 1;
    });
  }

  static VecX signed_by(const VecX& side, const VecX& distance) {
    VecX phi = distance;
    for (Eigen::Index v = 0; v < phi.size(); ++v)
      if (std::isfinite(phi[v])) phi[v] *= side[v];
    return phi;
  }

  /// How many edges of tets the sign changes along, and along how many of them without anything
  /// between: the surface would be nearer to one end than both are to it together.
  std::pair<double, double> contradictions(const VecX& phi,
                                           std::vector<char>* open = nullptr) const {
    double changes = 0, wrong = 0;
    for (int t = 0; t < mesh_.n_tets(); ++t)
      for (int i = 0; i < 4 && ops_.volumes[t] > 0; ++i)
        for (int j = 0; j < i; ++j) {
          const int u = mesh_.tets(t, i), v = mesh_.tets(t, j);
          if (!(phi[u] * phi[v] < 0) || std::isinf(phi[u])) continue;
          ++changes;
          const double between = (mesh_.points.row(u) - mesh_.points.row(v)).norm();
          if (std::abs(phi[u]) + std::abs(phi[v]) <= longer * between) continue;
          ++wrong;
          if (open) (*open)[component_of_tet(t)] = 1;
        }
    return {changes, wrong};
  }

  /// Distance to the source and to the zero set of signed heat away from it, which gives the signs
  /// that the source does not tell, on components where `phi` contradicts itself; of a cloud, to
  /// the zero set alone.
  VecX completed(const TetProblem& problem, const Sides* sides, TetPathSources from, VecX phi,
                 Task& task, Report& report) const {
    if (!problem.values.empty())
      throw UnsupportedError(
          "surfaces in tets of different values that are clouds or do not bound, one by one, "
          "cannot "
          "be completed; method signed-heat takes them as level sets of one function");
    std::vector<char> open(std::size_t(ops_.n_components), sides ? 0 : 1);
    if (sides) contradictions(phi, &open);
    const VecX heat = by_heat(sides ? soup_of(sides->points, sides->faces) : problem.surface,
                              task.stage(0.6, "signed heat"), report);
    if (!sides) phi = heat;
    add_completion(problem, sides, heat, open, from, task.stage(0.2, "completing"), report);
    const auto sign_at = [&](int v) { return heat[v] < 0 ? -1.0 : 1.0; };
    const bool oriented = sides && sides->normals.oriented();
    const TetPathResult found = paths(
        from, false,
        [&](int, const Vec3& q, const Vec3& x) {
          return oriented && sides->tells(q) ? sides->side(q, x) : 0;
        },
        task.stage(0.5, "distance"));
    tell_bent(found.bent, report);
    for (int v = 0; v < phi.size(); ++v) {
      const int c = ops_.component[v];
      if (c < 0 || open[c] == 0 || std::isinf(found.distance[v])) continue;
      phi[v] = found.distance[v] * (found.side[v] != 0 ? found.side[v] : sign_at(v));
    }
    const auto [changes, wrong] = contradictions(phi);
    if (wrong > contradicting * changes) {
      report.status = "uncertain";
      report.warn("sign-uncertain",
                  "at " + percent_text(wrong / changes) +
                      " of the places where the sign changes there is neither input nor "
                      "completion: signs are uncertain there, as around faces that are reversed "
                      "or missing");
    }
    return phi;
  }

  /// In the problem's units, like all here.
  VecX by_heat(const PolygonSoup& surface, Task task, Report& report) const {
    const Stopwatch watch(report, "signed heat");
    Report quiet;  // mesh and sources have been spoken of
    return solve_once<TetDomain>(SpaceSignedHeat{}, TetDomain{on_->mesh()}, TetSources{surface, {}},
                                 std::move(task), quiet);
  }

  /// Whether the zero set at x is the source itself, not what lies in a gap.
  static bool is_source(const Sides& sides, const Vec3& x, double band) {
    const NearestPoint foot = sides.nearest.closest_point(x);
    if (sides.normals.oriented() && sides.normals.at_end(foot)) return false;
    return foot.distance < band;
  }

  void add_completion(const TetProblem& problem, const Sides* sides, const VecX& heat,
                      const std::vector<char>& open, TetPathSources& from, const Task& task,
                      Report& report) const {
    VecX finite = heat;
    for (int v = 0; v < finite.size(); ++v) {
      const int c = ops_.component[v];
      if (c < 0 || open[c] == 0 || !std::isfinite(heat[v])) finite[v] = 1;
    }
    Report quiet;
    const PolygonSoup zero = isosurface(mesh_, finite, 0, quiet, task);
    const MatX3i faces = triangles_of(zero);
    const double band = near_source * mean_edge(mesh_, problem.tets_with_sources());
    const TetLocator locator(mesh_);
    const auto first = static_cast<int>(from.points.rows());
    std::vector<std::array<int, 3>> added;
    double area = 0, given = problem.samples.areas.sum();
    for (const auto& f : faces.rowwise()) {
      const Vec3 a = zero.points.row(f[0]), b = zero.points.row(f[1]), c = zero.points.row(f[2]);
      const Vec3 centre = (a + b + c) / 3;
      if (sides && is_source(*sides, centre, band)) continue;
      const int t = locator.locate(centre).tet;
      if (t < 0) continue;
      added.push_back({first + f[0], first + f[1], first + f[2]});
      from.component.push_back(component_of_tet(t));
      area += (b - a).cross(c - a).norm() / 2;
    }
    MatX3 points(first + zero.n_vertices(), 3);
    points << from.points, zero.points;
    from.points = std::move(points);
    const Eigen::Index old = from.faces.rows();
    from.faces.conservativeResize(old + index(added.size()), 3);
    for (std::size_t i = 0; i < added.size(); ++i)
      for (int k = 0; k < 3; ++k) from.faces(old + index(i), k) = added[i][k];
    if (!sides) return;
    report.sizes.emplace_back("completed share of the zero set", area / (area + given));
    if (area > given)
      report.warn("completion-guessed",
                  "more of the zero set completes the surface than it makes up itself: which side "
                  "is which is a guess there");
  }

  std::shared_ptr<const TetDiscretization> on_;
  const TetMesh& mesh_;
  const TetOperators& ops_;
  TetSight sight_;
};

}  // namespace

std::vector<Method<TetDomain>> automatic_tet_methods() {
  static const OptionTable<TetAutomatic> none;
  return {make_method<TetDomain>(
      {TetAutomatic::method,
       "Signed distance from surfaces that may be broken, unsigned from vertices and the boundary; "
       "exact where the nearest point is in sight.",
       {"tet mesh"},
       {},
       "signs: Baerentzen, Aanaes (2005) and Feng, Crane (2024)"},
      none,
      [](const TetDomain& domain, const TetAutomatic&, SolveHint, const Task& task,
         Report& report) {
        const auto on = std::make_shared<const TetDiscretization>(*domain.mesh, task, report);
        return [on, method = std::make_shared<const AutomaticThroughTets>(on)](
                   const TetSources& sources, TetAutomatic&, Task& t, Report& r) -> VecX {
          return method->solve(sources, t, r);
        };
      })};
}

}  // namespace littoral
