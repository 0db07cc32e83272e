#include "sources/surface/source_values.h"

#include <algorithm>
#include <functional>
#include <map>
#include <queue>
#include <sstream>
#include <utility>
#include <vector>

#include "base/counted.h"
#include "base/index.h"
#include "base/option_table.h"

namespace littoral {

namespace {

class RangeOfValues {
 public:
  void add(double value) {
    range_.low = std::min(range_.low, value);
    range_.high = std::max(range_.high, value);
  }
  ValueRange range() const { return range_.low <= range_.high ? range_ : ValueRange{}; }

 private:
  ValueRange range_{infinity, -infinity};
};

/// Of a point of a triangle from its corners.
std::array<double, 3> from_corners(const IntrinsicTriangulation& T, const PointInFace& p) {
  const TriangleShape t = T.shape(p.face);
  std::array<double, 3> out;
  for (int k = 0; k < 3; ++k) out[k] = std::abs(t.p[k] - t.at(p.b));
  return out;
}

}  // namespace

ValueRange value_range(const Sources& sources) {
  RangeOfValues all;
  for (const Curve& curve : sources.curves) all.add(curve.value);
  for (const SpaceCurve& curve : sources.space_curves) all.add(curve.value);
  for (std::size_t i = 0; i < sources.points.size(); ++i) all.add(sources.point_value(i));
  return all.range();
}

ValueRange signed_value_range(const Sources& sources) {
  RangeOfValues all;
  for (const Curve& curve : sources.curves)
    if (curve.is_signed) all.add(curve.value);
  for (const SpaceCurve& curve : sources.space_curves)
    if (curve.is_signed) all.add(curve.value);
  return all.range();
}

Sources shifted_values(const Sources& sources, double shift) {
  Sources out = sources;
  for (Curve& curve : out.curves) curve.value += shift;
  for (SpaceCurve& curve : out.space_curves) curve.value += shift;
  out.point_values.resize(out.points.size(), 0);
  for (double& value : out.point_values) value += shift;
  return out;
}

EdgePaths::EdgePaths(int n_vertices)
    : around_(n_vertices), start_(VecX::Constant(n_vertices, infinity)) {}

void EdgePaths::add_edge(int a, int b, double length) {
  around_[a].emplace_back(b, length);
  around_[b].emplace_back(a, length);
}

void EdgePaths::start(int vertex, double value) {
  start_[vertex] = std::min(start_[vertex], value);
}

VecX EdgePaths::lengths() const {
  VecX reach = start_;
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  for (int v = 0; v < reach.size(); ++v)
    if (reach[v] < infinity) queue.emplace(reach[v], v);
  while (!queue.empty()) {
    const auto [at, v] = queue.top();
    queue.pop();
    if (at > reach[v]) continue;
    for (const auto& [w, length] : around_[v]) {
      if (!(at + length < reach[w])) continue;
      reach[w] = at + length;
      queue.emplace(reach[w], w);
    }
  }
  return reach;
}

VecX reach_along_edges(const IntrinsicTriangulation& T, const TriangleSources& sources) {
  EdgePaths paths(T.n_vertices);
  for (int f = 0; f < T.n_faces(); ++f)
    for (int k = 0; k < 3; ++k)
      paths.add_edge(T.faces(f, k), T.faces(f, (k + 1) % 3), T.length(f, k));
  for (const auto* points : {&sources.nodes, &sources.isolated}) {
    for (std::size_t i = 0; i < points->vertices.size(); ++i)
      paths.start(points->vertices[i], sources.value_of(points->vertex_source[i]));
    for (std::size_t i = 0; i < points->inside.size(); ++i) {
      const auto far = from_corners(T, points->inside[i]);
      for (int k = 0; k < 3; ++k)
        paths.start(T.faces(points->inside[i].face, k),
                    sources.value_of(points->inside_source[i]) + far[k]);
    }
  }
  return paths.lengths();
}

void warn_of_shadowed(const IntrinsicTriangulation& T, const TriangleSources& sources,
                      const PlacedSources& placed, int n_curves, const VecX& reach,
                      Report& report) {
  const int n_pieces = static_cast<int>(placed.pieces.size());
  std::map<std::pair<bool, int>, double> excess;  // (point or curve, number) -> largest
  const auto look = [&](int source, double reached) {
    const double value = sources.value_of(source), over = value - reached;
    if (!(over > 1e-9 * (std::abs(value) + std::abs(reached) + T.mean_edge_length))) return;
    const bool is_point = source >= n_pieces;
    if (!is_point && placed.pieces[source].curve >= n_curves) return;
    double& most = excess[{is_point, is_point ? source - n_pieces : placed.pieces[source].curve}];
    most = std::max(most, over);
  };
  for (const auto* points : {&sources.nodes, &sources.isolated}) {
    for (std::size_t i = 0; i < points->vertices.size(); ++i)
      look(points->vertex_source[i], reach[points->vertices[i]]);
    for (std::size_t i = 0; i < points->inside.size(); ++i) {
      const auto far = from_corners(T, points->inside[i]);
      double least = infinity;
      for (int k = 0; k < 3; ++k)
        least = std::min(least, reach[T.faces(points->inside[i].face, k)] + far[k]);
      look(points->inside_source[i], least);
    }
  }
  std::vector<std::pair<std::string, double>> named;
  for (const auto& [which, most] : excess)
    named.emplace_back(
        (which.first ? "point source " : "curve ") + std::to_string(which.second + 1),
        most * T.unit);
  warn_of_shadowed(named, report);
}

void warn_of_shadowed(const std::vector<std::pair<std::string, double>>& excess, Report& report) {
  constexpr std::size_t shown = 8;
  std::size_t n = 0;
  for (const auto& [name, most] : excess) {
    if (++n > shown) break;
    report.warn("source-shadowed",
                name + " has a value " + rounded_text(most) +
                    " above what other sources give there: it is shadowed. Values may differ by no "
                    "more than the distance between their sources");
  }
  if (excess.size() > shown)
    report.warn("source-shadowed",
                counted(excess.size() - shown, "more source is", "more sources are") + " shadowed");
}

void warn_of_shadowed(const SurfaceMesh& mesh, const IntrinsicTriangulation& T,
                      const PlacedSources& placed, Report& report) {
  const TriangleSources sources = triangle_sources(mesh, T, placed);
  if (std::all_of(sources.value.begin(), sources.value.end(),
                  [&](double c) { return c == sources.value.front(); }))
    return;
  warn_of_shadowed(T, sources, placed, placed.n_curves, reach_along_edges(T, sources), report);
}

}  // namespace littoral
