#include "api/surface/pairs.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <mutex>
#include <numeric>

#include "api/solve_many.h"
#include "base/component_values.h"
#include "base/counted.h"
#include "base/index.h"
#include "base/platform/memory.h"
#include "base/stopwatch.h"
#include "domain/intrinsic/lengthened_sides.h"
#include "methods/geodesic/exact_polyhedral.h"
#include "operators/triangles.h"
#include "sources/surface/surface_points.h"
#include "sources/surface/triangle_sources.h"

namespace littoral {

namespace {

/// The faces of one component, and the vertices they use.
std::pair<PolygonSoup, std::vector<int>> component_of(const SurfaceMesh& mesh, int component) {
  std::vector<int> vertices, number(std::size_t(mesh.n_vertices()), -1);
  for (int v = 0; v < mesh.n_vertices(); ++v)
    if (mesh.vertex_component()[v] == component) {
      number[v] = static_cast<int>(vertices.size());
      vertices.push_back(v);
    }
  PolygonSoup soup;
  soup.points.resize(index(vertices.size()), 3);
  for (std::size_t i = 0; i < vertices.size(); ++i)
    soup.points.row(index(i)) = mesh.point(vertices[i]);
  for (int f = 0; f < mesh.n_faces(); ++f) {
    const auto face = mesh.face(f);
    if (mesh.vertex_component()[face[0]] != component) continue;
    std::vector<int> corners;
    for (int v : face) corners.push_back(number[v]);
    soup.add_face(corners);
  }
  return {std::move(soup), std::move(vertices)};
}

/// What solves on several components say: sums of iterations, the worst of residuals, also each
/// one's, and of sizes the largest.
void merge_components(const std::vector<std::pair<int, Report>>& of, Report& report) {
  const auto gather = [&](auto list, auto put) {
    std::vector<std::pair<std::string, ComponentValues>> named;
    for (const auto& [c, one] : of)
      for (const auto& [name, value] : one.*list) {
        const auto known =
            std::find_if(named.begin(), named.end(),
                         [&sought = name](const auto& entry) { return entry.first == sought; });
        ComponentValues& values = known != named.end()
                                      ? known->second
                                      : named.emplace_back(name, ComponentValues(name)).second;
        values.add(c, value);
      }
    for (const auto& [name, values] : named) put(name, values);
  };
  gather(&Report::iterations,
         [&](const std::string&, const ComponentValues& v) { v.report_sum(report.iterations); });
  gather(&Report::residuals,
         [&](const std::string&, const ComponentValues& v) { v.report_worst(report.residuals); });
  gather(&Report::sizes, [&](const std::string& name, const ComponentValues& v) {
    report.sizes.emplace_back(name, v.worst());
  });
  for (const auto& [c, one] : of) {
    for (const auto& [code, text] : one.warnings)
      report.warn(code, of.size() > 1 ? "component " + std::to_string(c) + ": " + text : text);
    if (one.status != "converged") report.status = one.status;
  }
}

bool has_triangle(const SurfaceMesh& mesh) {
  for (int f = 0; f < mesh.n_faces(); ++f)
    if (mesh.has_distinct_corners(f)) return true;
  return false;
}

// At the default alpha 10 of 11 meshes of 6 to 1,202 vertices have 0.02 to 0.084, and one of 71
// vertices whose features are as small as its edges has 0.18.
constexpr double far_from_exact = 0.1;
constexpr int exact_rows = 8;

/// Says how far some rows (vertices x vertices) are from exact distance.
void compare_with_exact(const SurfaceMesh& mesh, const IntrinsicTriangulation& T, const MatX& U,
                        const Task& task, Report& report) {
  const Stopwatch watch(report, "check");
  double difference = 0, rows = 0;
  for (int i = 0; i < std::min(exact_rows, mesh.n_vertices()); ++i) {
    const int v = i * mesh.n_vertices() / std::min(exact_rows, mesh.n_vertices());
    if (T.component[v] < 0) continue;
    PlacedSources from;
    from.points.push_back(SurfacePoint::at_vertex(v));
    Report quiet;
    const VecX d = exact_polyhedral(T, triangle_sources(mesh, T, from), task, quiet).distance;
    double sum = 0, n = 0, largest = 0;
    for (int w = 0; w < d.size(); ++w)
      if (std::isfinite(d[w]) && std::isfinite(U(v, w))) {
        sum += std::abs(U(v, w) - d[w]);
        largest = std::max(largest, d[w]);
        n += 1;
      }
    if (!(largest > 0)) continue;
    difference += sum / n / largest;
    rows += 1;
  }
  if (rows == 0) return;
  const double mean = difference / rows;
  report.residuals.emplace_back("mean difference from exact distance", mean);
  if (mean > far_from_exact)
    report.warn("far-from-exact",
                "distances are " + number_text(std::round(1000 * mean) / 10) +
                    " % of the largest away from exact ones in the mean of " + number_text(rows) +
                    " rows: smoothing, or triangles as large as what they show. Method exact "
                    "measures exactly; a smaller option alpha smooths less");
}

/// All rows, component by component (Alg. 2).
MatX symmetric(const SurfaceMesh& mesh, const Symmetric& options, Task& task, Report& report) {
  MatX D = MatX::Constant(mesh.n_vertices(), mesh.n_vertices(), infinity);
  D.diagonal().setZero();
  const Stopwatch watch(report, "solve");
  std::vector<std::pair<int, Report>> of_components;
  int without = 0;
  for (int c = 0; c < mesh.n_components(); ++c) {
    auto [soup, vertices] = component_of(mesh, c);
    const SurfaceMesh part(std::move(soup));
    if (!has_triangle(part)) {
      ++without;
      continue;
    }
    Report& one = of_components.emplace_back(c, Report()).second;
    const auto T =
        std::make_shared<const IntrinsicTriangulation>(intrinsic_triangulation(part, one));
    const Operators ops = triangle_operators(*without_needles(T, one));
    const double share = static_cast<double>(vertices.size()) / mesh.n_vertices();
    const MatX U = all_pairs(ops, options, task.stage(share, "all pairs"), one);
    compare_with_exact(part, *T, U, task, one);
    for (std::size_t j = 0; j < vertices.size(); ++j)
      for (std::size_t i = 0; i < vertices.size(); ++i)
        D(vertices[i], vertices[j]) = U(index(i), index(j));
  }
  merge_components(of_components, report);
  if (of_components.empty())
    throw InputError("the mesh has no face with three different vertices", "empty-input");
  if (without > 0)
    report.warn("component-unreached",
                counted(without, "component has", "components have") +
                    " no face with three different vertices; distances there are infinite");
  return D;
}

double area_of(const SurfaceMesh& mesh) {
  double area = 0;
  for (int f = 0; f < mesh.n_faces(); ++f) {
    const auto face = mesh.face(f);
    Vec3 twice = Vec3::Zero();
    for (std::size_t k = 2; k < face.size(); ++k)
      twice += (mesh.point(face[k - 1]) - mesh.point(face[0]))
                   .cross(mesh.point(face[k]) - mesh.point(face[0]));
    area += 0.5 * twice.norm();
  }
  return area;
}

/// Throws IoError unless `rows` rows of distances to all vertices fit into memory, for a matrix
/// that has n of them.
void check_matrix(std::size_t n, Eigen::Index columns, double rows) {
  check_memory(8 * rows * static_cast<double>(columns),
               "a matrix of " + std::to_string(n) + " x " + std::to_string(columns) + " distances",
               "simplify the mesh or measure from fewer vertices");
}

void add_statistics(const SurfaceMesh& mesh, PairsAnswer& answer, const Task& task,
                    Report& report) {
  const Stopwatch watch(report, "statistics");
  answer.statistics = pair_statistics(answer.distances, area_of(mesh), task);
  report.residuals.emplace_back("asymmetry over root of area, largest",
                                answer.statistics->largest_asymmetry);
  report.residuals.emplace_back("asymmetry over root of area, mean",
                                answer.statistics->mean_asymmetry);
  report.residuals.emplace_back("share of triplets against the triangle inequality",
                                answer.statistics->violations);
  report.residuals.emplace_back("triangle inequality over root of area, largest violation",
                                answer.statistics->largest_violation);
}

}  // namespace

std::string PairsDomain::kind() const { return domain_of(*mesh).kind(); }

template <>
std::vector<Method<PairsDomain>> library_methods() {
  return {make_method<PairsDomain>(
      {Symmetric::method,
       "Distance between all pairs of vertices at once, smooth and the same in both directions.",
       {"triangle mesh"},
       {},
       "Edelstein, Guillen, Solomon, Ben-Chen: A Convex Optimization Framework for Regularized "
       "Geodesic Distances (2023), section 6"},
      all_pairs_options(),
      [](const PairsDomain& domain, const Symmetric&, SolveHint, const Task&, Report&) {
        return [domain](const std::vector<int>& rows, const Symmetric& options, Task& task,
                        Report& report) -> MatX {
          return symmetric(*domain.mesh, options, task, report)(rows, Eigen::all);
        };
      })};
}

std::vector<MethodInfo> pair_methods() {
  std::vector<MethodInfo> out = Registry<SurfaceDomain>::instance().infos();
  for (MethodInfo& info : Registry<PairsDomain>::instance().infos()) out.push_back(std::move(info));
  return out;
}

void check_pairs_method(const AnyMethod& method) {
  if (Registry<PairsDomain>::instance().has(method.name()))
    check_method<PairsDomain>(method);
  else
    check_method<SurfaceDomain>(method);
}

MatX distance_rows(const Solver<SurfaceDomain>& solver, const SurfaceDomain& domain,
                   const std::vector<SurfacePoint>& points, Task task, Report& report,
                   const KeptOfRow& kept) {
  const SurfaceMesh& mesh = *domain.mesh;
  const auto n = points.size();
  const Eigen::Index columns = kept.of ? kept.size : mesh.n_vertices();
  check_matrix(n, columns, static_cast<double>(n));
  MatX D(index(n), columns);
  const Stopwatch watch(report, "solve");
  if (n == 0) return D;
  const auto put_row = [&](std::size_t i, VecX& values) {
    const SurfacePoint& p = points[i];
    if (p.on == SurfacePoint::On::vertex) values[p.element] = 0;
    if (kept.of) values = kept.of(values);
  };
  std::vector<Sources> sources;
  std::vector<std::size_t> row;  // of D for each of them
  for (std::size_t i = 0; i < n; ++i) {
    const SurfacePoint& p = points[i];
    if (p.on == SurfacePoint::On::vertex && mesh.n_faces() > 0 &&
        mesh.vertex_component()[p.element] < 0) {  // in no face
      VecX none = VecX::Constant(mesh.n_vertices(), infinity);
      put_row(i, none);
      D.row(index(i)) = none;
    } else {
      sources.emplace_back(p);
      row.push_back(i);
    }
  }
  std::mutex mutex;
  int unconverged = 0;
  Report said;  // by the first, what all would say
  const auto put = [&](std::size_t first, std::vector<Solved<SurfaceDomain>>& some) {
    std::vector<std::pair<Eigen::Index, const double*>> rows;
    for (std::size_t i = 0; i < some.size(); ++i) {
      put_row(row[first + i], some[i].answer.values);
      rows.emplace_back(index(row[first + i]), some[i].answer.values.data());
    }
    for (Eigen::Index v = 0; v < columns; ++v) {  // rows of a column lie together
      double* to = D.col(v).data();
      for (const auto& [r, values] : rows) to[r] = values[v];
    }
    const std::lock_guard lock(mutex);
    for (const auto& one : some) unconverged += one.report.status != "converged";
    if (first == 0) said = std::move(some[0].report);
  };
  solve_many<SurfaceDomain>(solver, sources, 8 * static_cast<double>(D.size()),
                            task.stage(1, "distance"), put);
  said.status = report.status;
  said.timings.clear();
  report.merge(said);
  if (unconverged > 0) {
    report.status = "not converged";
    report.warn("not-converged",
                std::to_string(unconverged) + " of " + counted(n, "solve", "solves") +
                    " did not converge to option tolerance: raise it, or option max-iterations");
  }
  return D;
}

PairsAnswer pair_distances(const SurfaceDomain& domain, const std::vector<int>& vertices,
                           const AnyMethod& method, Task task, Report& report) {
  check_pairs_method(method);
  const SurfaceMesh& mesh = *domain.mesh;
  if (mesh.n_vertices() == 0) throw InputError("the mesh has no vertices", "empty-input");
  for (int v : vertices)
    if (v < 0 || v >= mesh.n_vertices())
      throw InputError("there is no vertex " + std::to_string(v) +
                           " to measure from; the mesh has " +
                           counted(mesh.n_vertices(), "vertex", "vertices") + ", counted from 0",
                       "no-such-element");
  std::vector<int> rows = vertices;
  if (rows.empty()) {
    rows.resize(std::size_t(mesh.n_vertices()));
    std::iota(rows.begin(), rows.end(), 0);
  }
  const bool all = vertices.empty();
  const auto n = static_cast<double>(mesh.n_vertices());
  report.sizes.emplace_back("vertices", n);
  report.sizes.emplace_back("faces", mesh.n_faces());
  report.sizes.emplace_back("source_points", static_cast<double>(rows.size()));
  const auto checked = static_cast<double>(all ? statistics_nodes(mesh.n_vertices()) : 0);
  check_matrix(rows.size(), mesh.n_vertices(), static_cast<double>(rows.size()) + checked);
  PairsAnswer answer;
  if (Registry<PairsDomain>::instance().has(method.name())) {
    answer.distances =
        solve_once<PairsDomain>(method, {domain.mesh}, rows, task.stage(0.85, "all pairs"), report);
  } else {
    const auto solver =
        prepare(method, domain, SolveHint::many_rhs, task.stage(0.1, "preparing"), report);
    std::vector<SurfacePoint> points;
    for (int v : rows) points.push_back(SurfacePoint::at_vertex(v));
    Report rest;
    answer.distances = distance_rows(*solver, domain, points, task.stage(0.75, "distance"), rest);
    rest.sizes.clear();  // of one source
    report.merge(rest);
  }
  if (all && mesh.n_faces() > 0)
    add_statistics(mesh, answer, task.stage(1, "triangle inequality"), report);
  return answer;
}

}  // namespace littoral
