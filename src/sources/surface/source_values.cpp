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
#include "base/now_and_then.h"
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

EdgePaths::EdgePaths(int n_vertices, const std::vector<Edge>& edges)
    : first_(std::size_t(n_vertices) + 1, 0), neighbours_(2 * edges.size()) {
  for (const auto& [a, b, length] : edges) ++first_[a + 1], ++first_[b + 1];
  for (std::size_t v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
  std::vector<int> next(first_.begin(), first_.end() - 1);
  for (const auto& [a, b, length] : edges) {
    neighbours_[next[a]++] = {b, length};
    neighbours_[next[b]++] = {a, length};
  }
}

namespace {

std::vector<EdgePaths::Edge> sides_of(const IntrinsicTriangulation& T) {
  std::vector<EdgePaths::Edge> sides;
  sides.reserve(3 * std::size_t(T.n_faces()));
  for (int f = 0; f < T.n_faces(); ++f)
    for (int k = 0; k < 3; ++k)
      sides.push_back({T.faces(f, k), T.faces(f, (k + 1) % 3), T.length(f, k)});
  return sides;
}

}  // namespace

EdgePaths::EdgePaths(const IntrinsicTriangulation& T) : EdgePaths(T.n_vertices, sides_of(T)) {}

VecX EdgePaths::lengths(const std::vector<Start>& from, double limit, const Task& task) const {
  VecX d = VecX::Constant(index(first_.size()) - 1, infinity);
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  const auto reach = [&](int v, double at) {
    if (!(at < d[v]) || at > limit) return;
    d[v] = at;
    queue.emplace(at, v);
  };
  for (const Start& start : from) reach(start.vertex, start.value);
  for (int steps = 0; !queue.empty(); ++steps) {
    stop_now_and_then(steps, task);
    const auto [at, v] = queue.top();
    queue.pop();
    if (at > d[v]) continue;
    for (int i = first_[v]; i < first_[v + 1]; ++i)
      reach(neighbours_[i].first, at + neighbours_[i].second);
  }
  return d;
}

VecX reach_along_edges(const IntrinsicTriangulation& T, const TriangleSources& sources) {
  std::vector<EdgePaths::Start> from;
  for (const auto* points : {&sources.nodes, &sources.isolated}) {
    for (std::size_t i = 0; i < points->vertices.size(); ++i)
      from.push_back({points->vertices[i], sources.value_of(points->vertex_source[i])});
    for (std::size_t i = 0; i < points->inside.size(); ++i) {
      const auto far = from_corners(T, points->inside[i]);
      for (int k = 0; k < 3; ++k)
        from.push_back({T.faces(points->inside[i].face, k),
                        sources.value_of(points->inside_source[i]) + far[k]});
    }
  }
  return EdgePaths(T).lengths(from);
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
