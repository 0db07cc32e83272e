#include "contour/isolines.h"

#include <algorithm>
#include <cmath>

#include "base/counted.h"
#include "base/index.h"
#include "littoral/error.h"

namespace littoral {

namespace {

// A segment through a face runs from one edge to another with larger values on its left. Its two
// ends are numbered 2 s (start) and 2 s + 1 (finish).
struct Segments {
  std::vector<int> end_edge;  // ends
  std::vector<int> link;      // ends: the other segment end at the same crossing, or -1
  int count() const { return end_edge.size() / 2; }
};

class Tracer {
 public:
  Tracer(const SurfaceMesh& mesh, const VecX& values, double level)
      : mesh_(mesh), values_(values), level_(level) {
    for (int f = 0; f < mesh.n_faces(); ++f) cross_face(f);
    link_ends();
  }

  std::vector<Polyline> lines() {
    std::vector<Polyline> result;
    visited_.assign(segments_.count(), false);
    for (int s = 0; s < segments_.count(); ++s) {
      if (visited_[s]) continue;
      Polyline line = trace(s);
      if (line.nodes.size() > 1) result.push_back(std::move(line));
    }
    return result;
  }

 private:
  bool above(int v) const { return values_[v] > level_; }

  void cross_face(int f) {
    const auto corners = mesh_.face(f);
    const int n = corners.size();
    double mean = 0;
    for (int v : corners) {
      if (!std::isfinite(values_[v])) return;
      mean += values_[v] / n;
    }
    sides_.clear();
    for (int k = 0; k < n; ++k) {
      if (above(corners[k]) != above(corners[(k + 1) % n])) sides_.push_back(k);
    }
    // Crossings alternate between leaving and entering the part above. If the middle is above, each
    // run of corners below is cut off on its own: join a leaving side to the entering side after
    // it; otherwise to the one before it.
    const int crossings = sides_.size();
    const int step = mean > level_ ? 1 : crossings - 1;
    for (int i = 0; i < crossings; ++i) {
      if (!above(corners[sides_[i]])) continue;
      segments_.end_edge.push_back(mesh_.side_edge(f, sides_[i]));
      segments_.end_edge.push_back(mesh_.side_edge(f, sides_[(i + step) % crossings]));
    }
  }

  void link_ends() {
    std::vector<int> waiting(mesh_.n_edges(), -1);
    segments_.link.assign(segments_.end_edge.size(), -1);
    for (int end = 0; end < int_size(segments_.end_edge); ++end) {
      const int e = segments_.end_edge[end];
      if (mesh_.edge_faces(e).size() > 2) continue;
      if (waiting[e] < 0) {
        waiting[e] = end;
      } else {
        segments_.link[end] = waiting[e];
        segments_.link[waiting[e]] = end;
      }
    }
  }

  // From an end, across the crossing, to the far end of the neighbouring segment; -1 at a line's
  // end.
  int beyond(int end) const {
    const int next = segments_.link[end];
    return next < 0 ? -1 : (next ^ 1);
  }

  Polyline trace(int seed) {
    Polyline line;
    int first = 2 * seed;  // the outer end of the line's first segment
    for (int end = beyond(first); end >= 0; end = beyond(end)) {
      if (end == 2 * seed) {
        line.closed = true;
        first = 2 * seed;
        break;
      }
      first = end;
    }
    int along = 0, against = 0;
    append(line, segments_.end_edge[first]);
    for (int end = first ^ 1; end >= 0; end = beyond(end)) {
      if (visited_[end / 2]) break;
      visited_[end / 2] = true;
      ++((end & 1) ? along : against);
      append(line, segments_.end_edge[end]);
    }
    if (line.closed) {
      while (line.nodes.size() > 1 && same(line.nodes.front(), line.nodes.back())) {
        line.nodes.pop_back();
      }
    }
    if (against > along) std::reverse(line.nodes.begin(), line.nodes.end());
    return line;
  }

  // All crossings beside a vertex at the level are that vertex: consecutive ones become one node.
  void append(Polyline& line, int e) const {
    const SurfacePoint node = crossing(e);
    if (line.nodes.empty() || !same(line.nodes.back(), node)) line.nodes.push_back(node);
  }

  static bool same(const SurfacePoint& a, const SurfacePoint& b) {
    return a.on == b.on && a.element == b.element;
  }

  SurfacePoint crossing(int e) const {
    const int a = mesh_.edges()(e, 0), b = mesh_.edges()(e, 1);
    if (values_[a] == level_) return SurfacePoint::at_vertex(a);
    if (values_[b] == level_) return SurfacePoint::at_vertex(b);
    // Halved, so that the difference of two huge numbers stays finite.
    const double low = 0.5 * values_[a], high = 0.5 * values_[b];
    const double t = high == low ? 0.5 : (0.5 * level_ - low) / (high - low);
    return SurfacePoint::on_edge(e, std::clamp(t, 0.0, 1.0));
  }

  const SurfaceMesh& mesh_;
  const VecX& values_;
  const double level_;
  Segments segments_;
  std::vector<int> sides_;
  std::vector<bool> visited_;
};

}  // namespace

std::vector<Polyline> isolines(const SurfaceMesh& mesh, const VecX& values, double level) {
  if (values.size() != mesh.n_vertices()) {
    throw InputError("isolines: " + std::to_string(values.size()) + " values for " +
                         counted(mesh.n_vertices(), "vertex", "vertices"),
                     "sizes-differ");
  }
  if (!std::isfinite(level))
    throw InputError("isolines: the level must be a finite number", "option-value");
  return Tracer(mesh, values, level).lines();
}

MatX3 polyline_points(const SurfaceMesh& mesh, const Polyline& line) {
  const Eigen::Index n = line.nodes.size();
  MatX3 points(n + (line.closed ? 1 : 0), 3);
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    points.row(i) = mesh.position(line.nodes[i % n]).transpose();
  }
  return points;
}

double polyline_length(const SurfaceMesh& mesh, const Polyline& line) {
  const MatX3 points = polyline_points(mesh, line);
  double length = 0;
  for (Eigen::Index i = 1; i < points.rows(); ++i) {
    length += (points.row(i) - points.row(i - 1)).stableNorm();
  }
  return length;
}

}  // namespace littoral
