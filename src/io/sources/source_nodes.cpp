#include "io/sources/source_nodes.h"

#include <algorithm>
#include <cmath>

#include "littoral/error.h"
#include "sources/surface/surface_points.h"

namespace littoral::io {

void NodeMaker::fail(const std::string& text) const {
  throw InputError(where_() + ": " + text, "bad-file");
}

int NodeMaker::in_range(std::int64_t index, int base, int count, const char* what) const {
  if (index < base || index - base >= count) {
    fail(std::string("node refers to ") + what + " " + std::to_string(index) + ", the mesh has " +
         std::to_string(count) + " (counted from " + std::to_string(base) + ")");
  }
  return static_cast<int>(index - base);
}

void NodeMaker::check_parameter(double t) const {
  if (!(t >= 0 && t <= 1)) fail("the parameter along an edge must be in [0, 1]");
}

void NodeMaker::check_finite(int vertex) const {
  if (!mesh_.point(vertex).allFinite()) {
    fail("node at vertex " + std::to_string(vertex) + " (counted from 0), which is not finite");
  }
}

SurfacePoint NodeMaker::vertex(std::int64_t index, int base) const {
  const int v = in_range(index, base, mesh_.n_vertices(), "vertex");
  check_finite(v);
  return SurfacePoint::at_vertex(v);
}

SurfacePoint NodeMaker::edge(std::int64_t index, double t, int base) const {
  const int e = in_range(index, base, mesh_.n_edges(), "edge");
  check_parameter(t);
  return SurfacePoint::on_edge(e, t);
}

SurfacePoint NodeMaker::edge(std::int64_t i, std::int64_t j, double t, int base) const {
  const int a = in_range(i, base, mesh_.n_vertices(), "vertex");
  const int b = in_range(j, base, mesh_.n_vertices(), "vertex");
  check_parameter(t);
  const int e = mesh_.find_edge(a, b);
  if (e < 0) {
    fail("the mesh has no edge between vertices " + std::to_string(i) + " and " +
         std::to_string(j));
  }
  SurfacePoint point = SurfacePoint::on_edge(e, t);
  if (mesh_.edges()(e, 0) != a) std::swap(point.b[0], point.b[1]);
  return point;
}

int NodeMaker::whole_face(std::int64_t index, int base) const {
  return in_range(index, base, mesh_.n_faces(), "face");
}

SurfacePoint NodeMaker::face(std::int64_t index, std::array<double, 3> b, int base) const {
  const int f = in_range(index, base, mesh_.n_faces(), "face");
  if (mesh_.face(f).size() != 3) {
    fail("face " + std::to_string(index) + " has " + std::to_string(mesh_.face(f).size()) +
         " corners; nodes inside faces need a triangle");
  }
  const auto written = SurfacePoint::in_face(static_cast<int>(index), b[0], b[1], b[2]);
  if (const std::string fault = barycentric_fault(written); !fault.empty()) fail(fault);
  for (double& x : b) x = std::max(x, 0.0);
  const double total = b[0] + b[1] + b[2];
  return SurfacePoint::in_face(f, b[0] / total, b[1] / total, b[2] / total);
}

std::vector<std::vector<int>> chain(std::span<const Segment> segments, int n_points) {
  constexpr int none = -1, several = -2;
  const auto count = std::size_t(n_points);
  std::vector<int> next(count, none), ends(count, 0);  // the segment that begins at a point
  for (std::size_t s = 0; s < segments.size(); ++s) {
    int& slot = next[segments[s].first];
    slot = slot == none ? static_cast<int>(s) : several;
    ++ends[segments[s].second];
  }
  const auto passes = [&](int point) { return next[point] >= 0 && ends[point] == 1; };
  std::vector<bool> done(segments.size(), false);
  std::vector<std::vector<int>> lines;
  const auto walk = [&](std::size_t s) {
    std::vector<int> line{segments[s].first};
    while (!done[s]) {
      done[s] = true;
      line.push_back(segments[s].second);
      if (!passes(line.back())) break;
      s = std::size_t(next[line.back()]);
    }
    lines.push_back(std::move(line));
  };
  // Open lines begin where one cannot pass; what is left after them are loops.
  for (std::size_t s = 0; s < segments.size(); ++s) {
    if (!passes(segments[s].first)) walk(s);
  }
  for (std::size_t s = 0; s < segments.size(); ++s) {
    if (!done[s]) walk(s);
  }
  return lines;
}

}  // namespace littoral::io
