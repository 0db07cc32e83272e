#include "domain/mesh/face_orientation.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>

namespace littoral {

namespace {

struct Side {
  int face = -1, k = 0;
};

/// Do the faces run oppositely along every edge of two? Then all are right as given.
bool agrees_as_given(const SurfaceMesh& mesh) {
  std::vector<std::int8_t> count(mesh.n_edges(), 0), along(mesh.n_edges(), 0);
  for (int f = 0; f < mesh.n_faces(); ++f) {
    if (!mesh.has_distinct_corners(f)) continue;
    for (int k = 0; k < 3; ++k) {
      const int e = mesh.side_edge(f, k);
      count[e] = static_cast<std::int8_t>(std::min(count[e] + 1, 3));
      if (mesh.side_along(f, k) && along[e] < 3) ++along[e];
    }
  }
  for (int e = 0; e < mesh.n_edges(); ++e)
    if (count[e] == 2 && along[e] != 1) return false;
  return true;
}

/// The two sides at an edge of two faces with three different corners each.
struct Gluing {
  std::vector<std::array<Side, 2>> sides;
  std::vector<int> count;

  explicit Gluing(const SurfaceMesh& mesh) : sides(mesh.n_edges()), count(mesh.n_edges(), 0) {
    for (int f = 0; f < mesh.n_faces(); ++f) {
      if (!mesh.has_distinct_corners(f)) continue;
      for (int k = 0; k < 3; ++k) {
        const int e = mesh.side_edge(f, k);
        if (count[e] < 2) sides[e][count[e]] = {f, k};
        ++count[e];
      }
    }
  }
  Side across(int e, int f, int k) const {
    if (count[e] != 2) return {};
    const auto& [a, b] = sides[e];
    return a.face == f && a.k == k ? b : a;
  }
};

FaceOrientation find_orientation(const SurfaceMesh& mesh) {
  FaceOrientation out;
  if (agrees_as_given(mesh)) {
    out.sign.assign(mesh.n_faces(), 1);
    return out;
  }
  const double size = mesh.scale();
  const Gluing glued(mesh);
  out.sign.assign(mesh.n_faces(), 0);
  std::vector<int> patch;
  for (int seed = 0; seed < mesh.n_faces(); ++seed) {
    if (out.sign[seed]) continue;
    patch.assign(1, seed);
    out.sign[seed] = 1;
    bool orientable = true;
    double kept_area = 0, flipped_area = 0;
    for (std::size_t i = 0; i < patch.size(); ++i) {
      const int f = patch[i];
      const auto c = mesh.face(f);
      const Vec3 at = mesh.point(c[0]) / size;
      (out.sign[f] > 0 ? kept_area : flipped_area) +=
          (mesh.point(c[1]) / size - at).cross(mesh.point(c[2]) / size - at).norm();
      for (int k = 0; k < 3; ++k) {
        const Side to = glued.across(mesh.side_edge(f, k), f, k);
        if (to.face < 0) continue;
        const bool same_way = mesh.side_along(f, k) == mesh.side_along(to.face, to.k);
        const auto wanted = static_cast<std::int8_t>(same_way ? -out.sign[f] : out.sign[f]);
        if (!out.sign[to.face]) {
          out.sign[to.face] = wanted;
          patch.push_back(to.face);
        } else if (out.sign[to.face] != wanted) {
          orientable = false;
        }
      }
    }
    const bool reverse = flipped_area > kept_area;
    if (!orientable) out.orientable = false;
    for (int f : patch) {
      if (!orientable)
        out.sign[f] = 1;
      else if (reverse)
        out.sign[f] = static_cast<std::int8_t>(-out.sign[f]);
      if (out.sign[f] < 0) ++out.flipped;
    }
  }
  return out;
}

}  // namespace

const FaceOrientation& face_orientation(const SurfaceMesh& mesh) {
  return *mesh.kept_orientation().get([&] { return find_orientation(mesh); });
}

}  // namespace littoral
