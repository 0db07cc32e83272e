#include "api/surface/pairs.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <atomic>
#include <functional>
#include <limits>
#include <map>
#include <mutex>
#include <numeric>

#include "api/surface/distance.h"
#include "api/surface/regularized_method.h"
#include "base/error.h"
#include "base/parallel.h"
#include "base/platform/memory.h"
#include "methods/geodesic/exact_polyhedral.h"
#include "methods/geodesic/fast_marching.h"
#include "methods/heat/signed_heat.h"
#include "methods/heat/unsigned_heat.h"
#include "methods/quadratic/quadratic.h"
#include "operators/triangles.h"
#include "sources/p2_sources.h"
#include "sources/triangle_source_terms.h"
#include "sources/triangle_sources.h"

namespace littoral {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

const MethodInfo& symmetric_method() {
  static const MethodInfo info = {
      "symmetric",
      "Distance between all pairs of vertices at once, smooth and the same in both directions.",
      {"triangle mesh"},
      all_pairs_options().infos(),
      "Edelstein, Guillen, Solomon, Ben-Chen: A Convex Optimization Framework for Regularized "
      "Geodesic Distances (2023), section 6"};
  return info;
}

/// Distance from one vertex; from several threads.
using FromVertex = std::function<VecX(int vertex, const Task& task, Report& report)>;

/// One mesh, translated once.
struct Domain {
  const SurfaceMesh& mesh;
  IntrinsicTriangulation T;
  std::shared_ptr<const Operators> ops;

  PreparedSources at(int vertex) const {
    SurfaceSources sources;
    sources.points.push_back(SurfacePoint::at_vertex(vertex));
    Report unused;
    return prepare(mesh, sources, false, unused);
  }
  SourceTerms terms(int vertex) const { return source_terms(mesh, T, at(vertex)); }
};

template <class S>
S options_of(const OptionTable<S>& table, const OptionTexts& texts, Report& report) {
  S options;
  for (const auto& [name, text] : texts) table.set(options, name, text);
  report_options(table, options, report);
  return options;
}

void refuse_flips(bool intrinsic_delaunay) {
  if (intrinsic_delaunay)
    throw UnsupportedError(
        "pairs of vertices are measured on the mesh as it is: leave out --intrinsic-delaunay");
}

FromVertex from_vertex(const std::string& method, const std::shared_ptr<const Domain>& domain,
                       const OptionTexts& texts, int first, Task& task, Report& report) {
  const auto walk = [&](auto run) -> FromVertex {
    return [domain, run](int v, const Task& t, Report& r) {
      return run(domain->T, triangle_sources(domain->mesh, domain->T, domain->at(v)), t, r);
    };
  };
  Task factoring = task.stage(0.1, "factoring");
  if (method == "exact") return walk(exact_polyhedral);
  if (method == "fast-marching") return walk(fast_marching);
  if (method == "unsigned-heat") {
    const auto options = options_of(unsigned_heat_options(), texts, report);
    refuse_flips(options.intrinsic_delaunay);
    const auto heat = std::make_shared<const UnsignedHeat>(domain->ops, options, factoring);
    return [domain, heat](int v, const Task& t, Report& r) {
      return heat->solve(domain->terms(v), t, r);
    };
  }
  if (method == "signed-heat") {
    auto options = options_of(signed_heat_options(), texts, report);
    const SourceTerms terms = domain->terms(first);
    if (options.time_scale == 0) options.time_scale = automatic_time_scale(terms);
    if (options.discontinuous || options.bounding_only || options.sharpen != 0)
      throw UnsupportedError("pairs of vertices have no curves to tear, leave out or sharpen from");
    refuse_flips(options.intrinsic_delaunay);
    const auto heat = std::make_shared<const SignedHeat>(domain->ops, options.time_scale, factoring,
                                                         needed_diffusions(terms, options));
    return [domain, heat, options](int v, const Task& t, Report& r) {
      return heat->solve(domain->terms(v), options, t, r);
    };
  }
  if (method == "quadratic") {
    const auto options = options_of(quadratic_options(), texts, report);
    const auto quadratic = std::make_shared<const Quadratic<2>>(
        std::make_shared<const P2Elements<2>>(p2_elements(domain->T)));
    return [domain, quadratic, options](int v, const Task& t, Report& r) {
      return quadratic
          ->solve(p2_sources(domain->mesh, domain->T, domain->at(v), options.spacing), options, t,
                  r)
          .at_vertices();
    };
  }
  RegularizedOptions options;
  if (method == "regularized") {
    options = options_of(regularized_options(), texts, report);
  } else {
    options = options_of(constrained_options(), texts, report);
    options.alpha = 0;
  }
  const auto regularized = std::make_shared<const RegularizedSurface>(domain->mesh, domain->T,
                                                                      options, factoring, report);
  return [domain, regularized, options](int v, const Task& t, Report& r) {
    return VecX(regularized->solve(domain->at(v), options, t, r).head(domain->mesh.n_vertices()));
  };
}

/// Every source by itself, side by side.
MatX repeated(const SurfaceMesh& mesh, const PairsRequest& request, const std::vector<int>& sources,
              Task& task, Report& report) {
  IntrinsicTriangulation T = intrinsic_triangulation(mesh, report);
  auto ops = std::make_shared<const Operators>(triangle_operators(T));
  const auto domain = std::make_shared<const Domain>(Domain{mesh, std::move(T), std::move(ops)});
  const FromVertex solve =
      from_vertex(request.method, domain, request.options, sources.front(), task, report);
  MatX D(static_cast<Eigen::Index>(sources.size()), mesh.n_vertices());
  std::atomic<std::size_t> finished{0};
  std::mutex mutex;
  int unconverged = 0;
  const Stopwatch watch(report, "solve");
  parallel_for(sources.size(), 1, [&](std::size_t i, std::size_t) {
    task.checkpoint(static_cast<double>(finished) / static_cast<double>(sources.size()));
    Report one;
    const int v = sources[i];
    if (mesh.vertex_component()[v] < 0)  // in no face
      D.row(static_cast<Eigen::Index>(i)).setConstant(infinity);
    else
      D.row(static_cast<Eigen::Index>(i)) = solve(v, Task(), one);
    D(static_cast<Eigen::Index>(i), v) = 0;
    ++finished;
    const std::lock_guard lock(mutex);
    unconverged += one.status != "converged";
  });
  if (unconverged > 0) {
    report.status = "not converged";
    report.warn(std::to_string(unconverged) + " of " + std::to_string(sources.size()) +
                " solves did not converge");
  }
  return D;
}

/// The faces of one component, and the vertices they use.
std::pair<PolygonSoup, std::vector<int>> component_of(const SurfaceMesh& mesh, int component) {
  std::vector<int> vertices, number(static_cast<std::size_t>(mesh.n_vertices()), -1);
  for (int v = 0; v < mesh.n_vertices(); ++v)
    if (mesh.vertex_component()[v] == component) {
      number[v] = static_cast<int>(vertices.size());
      vertices.push_back(v);
    }
  PolygonSoup soup;
  soup.points.resize(static_cast<Eigen::Index>(vertices.size()), 3);
  for (std::size_t i = 0; i < vertices.size(); ++i)
    soup.points.row(static_cast<Eigen::Index>(i)) = mesh.point(vertices[i]);
  for (int f = 0; f < mesh.n_faces(); ++f) {
    const auto face = mesh.face(f);
    if (mesh.vertex_component()[face[0]] != component) continue;
    std::vector<int> corners;
    for (int v : face) corners.push_back(number[v]);
    soup.add_face(corners);
  }
  return {std::move(soup), std::move(vertices)};
}

MatX symmetric(const SurfaceMesh& mesh, const PairsRequest& request, Task& task, Report& report) {
  const auto options = options_of(all_pairs_options(), request.options, report);
  MatX D = MatX::Constant(mesh.n_vertices(), mesh.n_vertices(), infinity);
  D.diagonal().setZero();
  const Stopwatch watch(report, "solve");
  for (int c = 0; c < mesh.n_components(); ++c) {
    auto [soup, vertices] = component_of(mesh, c);
    const SurfaceMesh part(std::move(soup));
    const Operators ops = triangle_operators(intrinsic_triangulation(part, report));
    const double share = static_cast<double>(vertices.size()) / mesh.n_vertices();
    const MatX U = all_pairs(ops, options, task.stage(0.85 * share, "all pairs"), report);
    for (std::size_t j = 0; j < vertices.size(); ++j)
      for (std::size_t i = 0; i < vertices.size(); ++i)
        D(vertices[i], vertices[j]) = U(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  }
  return D;
}

}  // namespace

const std::vector<MethodInfo>& pair_methods() {
  static const std::vector<MethodInfo> all = [] {
    std::vector<MethodInfo> out{symmetric_method()};
    out.insert(out.end(), methods().begin(), methods().end());
    return out;
  }();
  return all;
}

void check_request(const PairsRequest& request) {
  if (request.method != symmetric_method().name)
    return check_request(DistanceRequest{request.method, request.options});
  AllPairsOptions unused;
  for (const auto& [name, text] : request.options) {
    check_has_option(symmetric_method(), name);
    all_pairs_options().set(unused, name, text);
  }
}

PairsAnswer pair_distances(const SurfaceMesh& mesh, const PairsRequest& request, Task task,
                           Report& report) {
  check_request(request);
  report.method = request.method;
  report.domain = "triangle mesh";
  if (!mesh.is_triangle_mesh())
    throw UnsupportedError(
        "pairs of vertices need a triangle mesh: littoral convert --triangulate");
  if (mesh.n_faces() == 0) throw InputError("the mesh has no faces");
  std::vector<int> sources = request.vertices;
  for (int v : sources)
    if (v < 0 || v >= mesh.n_vertices())
      throw InputError("there is no vertex " + std::to_string(v) + " to measure from");
  if (sources.empty()) {
    sources.resize(static_cast<std::size_t>(mesh.n_vertices()));
    std::iota(sources.begin(), sources.end(), 0);
  }
  const bool all = request.vertices.empty();
  const auto n = static_cast<double>(mesh.n_vertices());
  report.sizes.emplace_back("vertices", n);
  report.sizes.emplace_back("faces", mesh.n_faces());
  report.sizes.emplace_back("source_points", static_cast<double>(sources.size()));
  check_memory(8 * n * (static_cast<double>(sources.size()) + (all ? n : 0)),
               "a matrix of " + std::to_string(sources.size()) + " x " +
                   std::to_string(mesh.n_vertices()) + " distances",
               "simplify the mesh or measure from fewer vertices");
  PairsAnswer answer;
  if (request.method != symmetric_method().name) {
    answer.distances = repeated(mesh, request, sources, task, report);
  } else {
    answer.distances = symmetric(mesh, request, task, report);
    if (!all) answer.distances = MatX(answer.distances(sources, Eigen::all));
  }
  if (!all) return answer;
  const Stopwatch watch(report, "statistics");
  double area = 0;
  for (int f = 0; f < mesh.n_faces(); ++f) {
    const auto face = mesh.face(f);
    area += 0.5 * (mesh.point(face[1]) - mesh.point(face[0]))
                      .cross(mesh.point(face[2]) - mesh.point(face[0]))
                      .norm();
  }
  answer.statistics =
      pair_statistics(answer.distances, area, task.stage(0.1, "triangle inequality"));
  report.residuals.emplace_back("asymmetry over root of area, largest",
                                answer.statistics->largest_asymmetry);
  report.residuals.emplace_back("asymmetry over root of area, mean",
                                answer.statistics->mean_asymmetry);
  report.residuals.emplace_back("share of triplets against the triangle inequality",
                                answer.statistics->violations);
  report.residuals.emplace_back("triangle inequality over root of area, largest violation",
                                answer.statistics->largest_violation);
  return answer;
}

}  // namespace littoral
