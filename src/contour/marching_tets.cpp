#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "base/counted.h"
#include "contour/isosurface.h"
#include "contour/rough_surface.h"

namespace littoral {

namespace {

using Edge = std::pair<int, int>;  // vertex below or at the level, vertex above

void check(const TetMesh& mesh, const VecX& values, double level) {
  if (values.size() != mesh.n_vertices()) {
    throw InputError("isosurface: " + std::to_string(values.size()) + " values for " +
                         counted(mesh.n_vertices(), "vertex", "vertices"),
                     "sizes-differ");
  }
  if (!std::isfinite(level))
    throw InputError("isosurface: the level must be a finite number", "option-value");
  for (int t = 0; t < mesh.n_tets(); ++t) {
    for (int k = 0; k < 4; ++k) {
      const int v = mesh.tets(t, k);
      const auto refuse = [&](const std::string& what) {
        throw InputError("isosurface: tet " + std::to_string(t) + " has vertex " +
                         std::to_string(v) + ", " + what);
      };
      if (v < 0 || v >= mesh.n_vertices())
        refuse("the mesh has " + std::to_string(mesh.n_vertices()));
      if (!mesh.points.row(v).allFinite()) refuse("which is not finite");
      if (!std::isfinite(values[v])) refuse("whose value is not finite");
    }
  }
}

// Corners of the tet, reordered by an even permutation (so that its orientation stays) such that
// those at most at the level come first; `below` says how many.
std::array<int, 4> sorted_corners(const TetMesh& mesh, const VecX& values, double level, int t,
                                  int& below) {
  std::array<int, 4> v;
  for (int k = 0; k < 4; ++k) v[k] = mesh.tets(t, k);
  const auto low = [&](int k) { return values[v[k]] <= level; };
  below = 0;
  bool odd = false;
  for (int k = 0; k < 4; ++k) {
    if (!low(k)) continue;
    if (k != below) {
      std::swap(v[k], v[below]);
      odd = !odd;
    }
    ++below;
  }
  if (odd) {
    if (below <= 2) {
      std::swap(v[2], v[3]);
    } else {
      std::swap(v[0], v[1]);
    }
  }
  return v;
}

double orientation(const TetMesh& mesh, const std::array<int, 4>& v) {
  Eigen::Matrix3d sides;
  for (int k = 0; k < 3; ++k) sides.row(k) = mesh.points.row(v[k + 1]) - mesh.points.row(v[0]);
  return sides.determinant();
}

}  // namespace

PolygonSoup isosurface(const TetMesh& mesh, const VecX& values, double level, Report& report,
                       Task task) {
  check(mesh, values, level);
  const Task march = task.stage(0.7, "marching tetrahedra");
  constexpr int often = 4096;
  std::vector<std::array<Edge, 3>> triangles;
  for (int t = 0; t < mesh.n_tets(); ++t) {
    if (t % often == 0) march.checkpoint(0.5 * t / mesh.n_tets());
    int below = 0;
    const std::array<int, 4> v = sorted_corners(mesh, values, level, t, below);
    if (below == 0 || below == 4) continue;
    const bool mirrored = orientation(mesh, v) < 0;
    const auto add = [&](Edge a, Edge b, Edge c) {
      if (mirrored) std::swap(b, c);
      triangles.push_back({a, b, c});
    };
    if (below == 1) {
      add({v[0], v[1]}, {v[0], v[2]}, {v[0], v[3]});
    } else if (below == 3) {
      add({v[0], v[3]}, {v[1], v[3]}, {v[2], v[3]});
    } else {
      // The diagonal joins opposite edges, so it lies on no face.
      add({v[0], v[2]}, {v[0], v[3]}, {v[1], v[3]});
      add({v[0], v[2]}, {v[1], v[3]}, {v[1], v[2]});
    }
  }
  std::vector<Edge> edges;
  edges.reserve(3 * triangles.size());
  for (const auto& t : triangles) edges.insert(edges.end(), t.begin(), t.end());
  march.checkpoint(0.6);
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  check_count(std::max(edges.size(), triangles.size()));
  march.checkpoint(0.8);

  RoughSurface rough;
  rough.points.resize(edges.size());
  rough.separated_points.resize(edges.size());
  rough.node.resize(edges.size());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto [low, high] = edges[e];
    const double a = 0.5 * values[low] - 0.5 * level, b = 0.5 * values[high] - 0.5 * level;
    const double s = a == b ? 0.5 : std::clamp(a / (a - b), 0.0, 1.0);
    const Vec3 p = mesh.points.row(low), q = mesh.points.row(high);
    place_crossing(rough, e, s, s < 0.5 ? low : high, [&](double u) {
      return u == 0 ? p : u == 1 ? q : Vec3((1 - u) * p + u * q);
    });
  }
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (t % often == 0) march.checkpoint(0.9);
    std::array<int, 3> corners;
    for (int k = 0; k < 3; ++k) {
      const auto at = std::lower_bound(edges.begin(), edges.end(), triangles[t][k]);
      corners[k] = at - edges.begin();
    }
    rough.triangles.push_back(corners);
  }
  PolygonSoup surface = merge_close_points(std::move(rough), task.stage(0.3, "joining points"));
  report_boundary(surface, level, report);
  return surface;
}

}  // namespace littoral
