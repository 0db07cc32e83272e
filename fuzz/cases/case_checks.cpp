#include "case_checks.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <functional>
#include <numeric>
#include <queue>

#include "api/space/space_domain.h"
#include "api/surface/pairs.h"
#include "api/surface/surface_domain.h"
#include "api/surface/winding.h"
#include "api/tet/tet_domain.h"
#include "base/index.h"
#include "base/task.h"
#include "littoral/distance.h"
#include "littoral/space.h"
#include "littoral/through_tets.h"
#include "spatial/grid_values.h"

namespace littoral::fuzz {

namespace {

/// A context whose call is stopped when it has used up its processor time or its checkpoints: a
/// clock on the wall would blame the call for what else the machine does.
class Budget {
 public:
  explicit Budget(double seconds) {
    const double end = spent() + seconds;
    context_.threads = 1;
    context_.progress = [token = context_.cancel, end, count = 0L](double,
                                                                   const std::string&) mutable {
      constexpr long most = 2'000'000;
      if (++count > most || spent() > end) token.cancel();
    };
  }
  const Context& context() const { return context_; }

 private:
  static double spent() { return double(std::clock()) / CLOCKS_PER_SEC; }
  Context context_;
};

class Failures {
 public:
  void require(bool holds, const std::string& what) {
    if (!holds) list.push_back(what);
  }
  std::vector<std::string> list;
};

std::string number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", x);
  return text;
}

double residual(const Report& report, const std::string& name) {
  for (const auto& [key, value] : report.residuals)
    if (key == name) return value;
  return 0;
}

double option(const MethodCase& given, const std::string& name, double fallback) {
  for (const auto& [key, value] : given.options)
    if (key == name) return std::atof(value.c_str());
  return fallback;
}

bool has_option(const MethodCase& given, const std::string& name, const std::string& value) {
  return std::find(given.options.begin(), given.options.end(), std::pair(name, value)) !=
         given.options.end();
}

void check_report(const MethodCase& given, const Report& report, Failures& out) {
  if (report.status == "converged") {
    for (const auto& [name, value] : report.residuals)
      out.require(std::isfinite(value), "converged with " + name + " " + number(value));
    // Ten times the tolerance is what the methods promise where residuals stop them.
    const double tolerance = option(given, "tolerance", given.method == "quadratic" ? 1e-5 : 2e-3);
    const double gap = std::max(10 * tolerance, option(given, "gap", 0));
    out.require(!(residual(report, "duality gap") > gap * 1.001),
                "converged with a gap of " + number(residual(report, "duality gap")));
  } else {
    const bool known = report.status == "not converged" || report.status == "uncertain";
    out.require(known && !report.warnings.empty(),
                "status " + report.status + " without a warning");
  }
}

// ---- distance on surfaces

bool is_sound(std::span<const int> face) {
  std::vector<int> sorted(face.begin(), face.end());
  std::sort(sorted.begin(), sorted.end());
  return std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end();
}

/// Length of the shortest way along edges of sound faces from the sources (vertices); +inf where
/// there is none. Points on edges and in faces reach the corners of their faces straight.
VecX along_edges(const Mesh& mesh, const Sources& sources) {
  const PolygonSoup& soup = mesh.soup();
  std::vector<std::vector<std::pair<int, double>>> beside(soup.points.rows());
  bool all_sound = true;
  for (int f = 0; f < soup.n_faces(); ++f) {
    const auto face = soup.face(f);
    all_sound = all_sound && is_sound(face);
    if (!is_sound(face)) continue;
    for (std::size_t k = 0; k < face.size(); ++k) {
      const int a = face[k], b = face[(k + 1) % face.size()];
      const double length = (soup.points.row(a) - soup.points.row(b)).stableNorm();
      beside[a].emplace_back(b, length);
      beside[b].emplace_back(a, length);
    }
  }
  VecX d = VecX::Constant(soup.points.rows(), infinity);
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  const auto reach = [&](int v, double at) {
    if (at < d[v]) queue.emplace(d[v] = at, v);
  };
  const auto start = [&](const SurfacePoint& p) {
    if (p.on == SurfacePoint::On::vertex) {
      if (!beside[p.element].empty()) reach(p.element, 0);
      return;
    }
    if (p.on != SurfacePoint::On::face || !is_sound(soup.face(p.element))) return;
    const Vec3 x = mesh.position(p);
    for (const int v : soup.face(p.element))
      reach(v, (soup.points.row(v) - x.transpose()).stableNorm());
  };
  for (const SurfacePoint& p : sources.points) start(p);
  for (const Curve& curve : sources.curves) {
    double length = 0;
    for (std::size_t i = 1; i < curve.nodes.size(); ++i)
      length += (mesh.position(curve.nodes[i]) - mesh.position(curve.nodes[i - 1])).stableNorm();
    // Pieces in faces that repeat a vertex are left out with these.
    for (std::size_t i = 0; i < curve.nodes.size() && length > 0 && all_sound; ++i)
      start(curve.nodes[i]);
  }
  while (!queue.empty()) {
    const auto [at, v] = queue.top();
    queue.pop();
    if (at > d[v]) continue;
    for (const auto& [w, length] : beside[v]) reach(w, at + length);
  }
  return d;
}

bool is_unsigned(const Sources& sources) {
  return sources.space_curves.empty() &&
         std::none_of(sources.curves.begin(), sources.curves.end(),
                      [](const Curve& curve) { return curve.is_signed; });
}

bool at_vertices(const Sources& sources) {
  return sources.curves.empty() && sources.space_curves.empty() &&
         std::all_of(sources.points.begin(), sources.points.end(),
                     [](const SurfacePoint& p) { return p.on == SurfacePoint::On::vertex; });
}

/// By how much a method may exceed the way along edges [length], given the longest such way and the
/// longest edge; +inf where no bound is promised.
double excess_of(const MethodCase& given, const Report& report, double longest, double edge) {
  if (report.status != "converged" || report.domain != "triangle mesh") return infinity;
  if (given.method == "exact") return 1e-6 * longest;
  if (given.method == "auto" && !has_option(given, "metric", "fast-marching") &&
      !has_option(given, "metric", "heat"))
    return 1e-6 * longest;
  // Fronts of first order start from the corners of the faces that hold a source.
  if (given.method == "fast-marching")
    return 1e-6 * longest + (at_vertices(given.sources) ? 0 : edge);
  // The gradient is at most 1 and what is reported. Between nodes the mean of a source is held.
  if (given.method == "regularized" || given.method == "belyaev-fayolle") {
    const double tolerance = option(given, "tolerance", 2e-3);
    return (5 * tolerance + residual(report, "largest gradient over 1")) * longest +
           (at_vertices(given.sources) ? 0 : edge);
  }
  if (given.method == "quadratic" && option(given, "spacing", 0) > 0) return infinity;  // gaps
  if (given.method == "quadratic")
    return 0.05 * longest + (1e-3 + option(given, "source-radius", 1e-4)) * edge;
  return infinity;
}

/// What faces of no extent may add to a way: sides of a millionth of the mesh's mean edge are
/// given to them where a method needs any [length].
double lent_to_points(const Mesh& mesh) {
  double sum = 0;
  int sides = 0, without = 0;
  for (int f = 0; f < mesh.n_faces(); ++f) {
    const auto face = mesh.soup().face(f);
    if (!is_sound(face)) continue;
    double longest = 0;
    for (std::size_t k = 0; k < face.size(); ++k, ++sides) {
      const int v = face[k], w = face[(k + 1) % face.size()];
      const double side = (mesh.points().row(v) - mesh.points().row(w)).stableNorm();
      longest = std::max(longest, side);
      sum += side;
    }
    if (!(longest > 0)) ++without;
  }
  return without ? 2e-6 * without * sum / sides : 0;
}

void check_values(const MethodCase& given, const Mesh& mesh, const VecX& values,
                  const Report& report, Failures& out) {
  out.require(values.size() == mesh.n_vertices(), "not one value for each vertex");
  out.require(!values.array().isNaN().any(), "a value that is not a number");
  if (!out.list.empty() || mesh.n_faces() == 0) return;
  const VecX bound = along_edges(mesh, given.sources);
  double size = 0, edge = 0;
  for (int f = 0; f < mesh.n_faces(); ++f) {
    const auto face = mesh.soup().face(f);
    for (std::size_t k = 0; k < face.size(); ++k)
      if (const int v = face[k], w = face[(k + 1) % face.size()];
          std::isfinite(bound[v]) && std::isfinite(bound[w]))
        edge = std::max(edge, (mesh.points().row(v) - mesh.points().row(w)).stableNorm());
  }
  size = edge;
  for (const double b : bound)
    if (std::isfinite(b)) size = std::max(size, b);
  const bool is_positive = is_unsigned(given.sources);
  const bool leaves_curves_out = has_option(given, "bounding-only", "on");
  const double rounding = 1e-12 * mesh.points().cwiseAbs().maxCoeff();
  double excess = excess_of(given, report, size, edge) + lent_to_points(mesh);
  // Sides of needles are lengthened by up to a millionth there, and a way has fewer than vertices.
  if (given.method == "regularized" || given.method == "belyaev-fayolle")
    excess += 1e-6 * edge * static_cast<double>(mesh.n_vertices());
  for (Eigen::Index v = 0; v < values.size(); ++v) {
    const std::string at = " at vertex " + std::to_string(v);
    if (std::isfinite(bound[v]) && !leaves_curves_out)
      out.require(std::isfinite(values[v]), "infinite" + at + ", which a source reaches");
    if (is_positive && given.method != "signed-heat")
      out.require(values[v] >= 0, "negative without a signed curve: " + number(values[v]) + at);
    if (std::isfinite(bound[v]) && std::abs(values[v]) > bound[v] + excess)
      out.require(false, number(values[v]) + at + ", " + number(bound[v]) + " along edges");
    if (given.method == "exact" && given.sources.curves.empty() && is_positive) {
      double straight = infinity;
      for (const SurfacePoint& p : given.sources.points)
        straight =
            std::min(straight, (mesh.position(p) - mesh.points().row(v).transpose()).stableNorm());
      out.require(values[v] >= straight * (1 - 1e-6) - 1e-6 * size - rounding,
                  "shorter than the straight line" + at);
    }
    if (out.list.size() > 3) return;
  }
}

/// Values of a mesh twice, or 2^k times, as large are that many times those of the mesh.
void check_scale(const MethodCase& given, const VecX& values, const Budget& budget, int power,
                 Failures& out) {
  PolygonSoup soup = given.soup;
  soup.points *= std::exp2(power);
  const VecX scaled = distance(Mesh(soup), given.sources, given.choice(), budget.context()).values;
  for (Eigen::Index v = 0; v < values.size(); ++v)
    if (std::isfinite(values[v]) && scaled[v] != values[v] * std::exp2(power))
      return out.require(
          std::abs(scaled[v] * std::exp2(-power) - values[v]) <= 1e-9 * std::abs(values[v]),
          "scaled by 2^" + std::to_string(power) + ", " + number(values[v]) + " becomes " +
              number(scaled[v] * std::exp2(-power)));
}

/// The order of faces changes nothing that an exact method finds.
void check_order(const MethodCase& given, const VecX& values, const Budget& budget, Choices& choose,
                 Failures& out) {
  std::vector<int> order(static_cast<std::size_t>(given.soup.n_faces()));
  std::iota(order.begin(), order.end(), 0);
  for (std::size_t k = order.size(); k > 1; --k)
    std::swap(order[k - 1], order[choose.below(static_cast<int>(k))]);
  PolygonSoup soup = given.soup;
  soup.face_offsets = {0};
  soup.corners.clear();
  for (const int f : order) soup.add_face(given.soup.face(f));
  const VecX other = distance(Mesh(soup), given.sources, given.choice(), budget.context()).values;
  double size = 0;
  for (const double x : values)
    if (std::isfinite(x)) size = std::max(size, std::abs(x));
  for (Eigen::Index v = 0; v < values.size(); ++v)
    if (std::isfinite(values[v]) || std::isfinite(other[v]))
      if (!(std::abs(values[v] - other[v]) <= 1e-6 * size))
        return out.require(
            false, "faces in another order: " + number(values[v]) + " becomes " + number(other[v]));
}

void check_surface(const MethodCase& given, Choices& choose, double seconds, Failures& out) {
  const Mesh mesh(given.soup);
  const Budget budget(seconds);
  const Field field = distance(mesh, given.sources, given.choice(), budget.context());
  check_values(given, mesh, field.values, field.report, out);
  check_report(given, field.report, out);
  if (!out.list.empty() || mesh.n_faces() == 0) return;
  if (choose.chance(0.15) && given.sources.space_curves.empty())
    check_scale(given, field.values, budget, choose.pick<int>({-40, 40}), out);
  if (given.method == "exact" && at_vertices(given.sources) && choose.chance(0.3))
    check_order(given, field.values, budget, choose, out);
}

// ---- the other families

void check_pairs(const MethodCase& given, double seconds, Failures& out) {
  const Mesh mesh(given.soup);
  const Budget budget(seconds);
  std::vector<SurfacePoint> from;
  for (int v = 0; v < mesh.n_vertices(); ++v) from.push_back(SurfacePoint::at_vertex(v));
  const DistanceMatrix D = distance_matrix(mesh, from, given.choice(), budget.context());
  out.require(D.values.rows() == mesh.n_vertices() && D.values.cols() == mesh.n_vertices(),
              "not a row for each vertex");
  out.require(!D.values.array().isNaN().any(), "a value that is not a number");
  out.require(D.values == D.values.transpose(), "not symmetric");
  out.require((D.values.diagonal().array() == 0).all(), "not 0 from a vertex to itself");
  out.require((D.values.array() >= 0).all(), "negative");
  check_report(given, D.report, out);
}

void check_winding(const MethodCase& given, double seconds, Failures& out) {
  const Mesh mesh(given.soup);
  const Budget budget(seconds);
  Report report;
  const WindingAnswer answer =
      solve_once<WindingDomain>(given.choice(), {mesh.domain().mesh}, given.sources,
                                Task(budget.context().cancel, budget.context().progress), report);
  out.require(answer.region.size() == mesh.n_faces(), "not one region for each face");
  for (const auto& [name, values] : answer.shown.scalars)
    out.require(values.allFinite(), name + " that is not finite");
  check_report(given, report, out);
}

void check_tets(const MethodCase& given, double seconds, Failures& out) {
  const Budget budget(seconds);
  const TetField field = distance(given.tets, given.tet_sources, given.choice(), budget.context());
  out.require(field.values.size() == given.tets.n_vertices(), "not one value for each vertex");
  out.require(!field.values.array().isNaN().any(), "a value that is not a number");
  if (!given.tet_sources.vertices.empty() && given.method != "signed-heat") {
    double least = given.tet_sources.values.empty() ? 0 : infinity;
    for (const double value : given.tet_sources.values) least = std::min(least, value);
    out.require((field.values.array() >= least - 1e-9).all(),
                "from vertices less than the least value");
  }
  check_report(given, field.report, out);
}

void check_space(const MethodCase& given, double seconds, Failures& out) {
  const Budget budget(seconds);
  const std::vector<double>& counted = given.space_values;
  const Sdf sdf = signed_distance(given.soup, counted, given.choice(), {}, budget.context());
  const Volume volume = sdf.sample(given.grid, budget.context());
  out.require(static_cast<std::size_t>(volume.values.size()) == given.grid.n_nodes(),
              "not one value for each node");
  out.require(volume.values.allFinite(), "a value that is not finite");
  const auto [low, high] = std::minmax_element(counted.begin(), counted.end());
  if (counted.empty() || *low == *high || given.method == "signed-heat") return;
  const VecX d = sdf.closest(grid_points(given.grid), budget.context()).distances;
  for (Eigen::Index i = 0; i < d.size(); ++i) {
    const double phi = volume.values[i], off = 1e-9 * (1 + d[i]);
    const bool up = phi > *low + d[i] - off && phi < *high + d[i] + off;
    const bool down = phi > *low - d[i] - off && phi < *high - d[i] + off;
    out.require(up || down, "not between the least and the greatest value, up or down");
    if (out.list.size() > 3) return;
  }
}

}  // namespace

std::vector<std::string> checked(const MethodCase& given, Choices& choose, double seconds) {
  Failures out;
  if (given.family == SurfaceDomain::title)
    check_surface(given, choose, seconds, out);
  else if (given.family == PairsDomain::title)
    check_pairs(given, seconds, out);
  else if (given.family == WindingDomain::title)
    check_winding(given, seconds, out);
  else if (given.family == TetDomain::title)
    check_tets(given, seconds, out);
  else if (given.family == SpaceDomain::title)
    check_space(given, seconds, out);
  else
    out.require(false, "nothing here calls the methods of " + given.family);
  return out.list;
}

}  // namespace littoral::fuzz
