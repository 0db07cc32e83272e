#include "domain/volume/voxels.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "base/parallel.h"
#include "littoral/error.h"

namespace littoral {

namespace {

using Index3 = std::array<int, 3>;

struct Voxels {
  const Grid& grid;
  const std::vector<unsigned char>& inside;
  bool operator()(int i, int j, int k) const {
    const auto& n = grid.n;
    return i >= 0 && j >= 0 && k >= 0 && i < n[0] && j < n[1] && k < n[2] &&
           inside[grid.node(i, j, k)] != 0;
  }
  bool operator()(const Index3& v) const { return (*this)(v[0], v[1], v[2]); }
};

void check_box(const Grid& grid) {
  const Vec3 far = grid.point(grid.n[0], grid.n[1], grid.n[2]);
  if (grid.spacing.minCoeff() > 0 && grid.spacing.allFinite() && grid.origin.allFinite() &&
      far.allFinite())
    return;
  throw InputError("voxels: the grid's spacing must be positive, its box finite", "option-value");
}

/// A quad: the voxel inside it and the direction that leads out.
struct Surfel {
  Index3 voxel;
  int axis, sign;
};

std::vector<Surfel> find_surfels(const Voxels& voxels) {
  std::vector<Surfel> out;
  const auto& n = voxels.grid.n;
  for (int k = 0; k < n[2]; ++k)
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i) {
        if (!voxels(i, j, k)) continue;
        for (int axis = 0; axis < 3; ++axis)
          for (int sign : {-1, 1}) {
            Index3 next{i, j, k};
            next[axis] += sign;
            if (!voxels(next)) out.push_back({{i, j, k}, axis, sign});
          }
      }
  if (out.empty()) throw InputError("the volume has no voxel that is set", "no-inside");
  if (out.size() > 200'000'000)
    throw InputError("the volume has more than 200 million boundary quads", "too-large");
  return out;
}

/// The corrected normal at a surfel, never further than about 87 degrees from the surfel's own.
Vec3 corrected_normal(const Voxels& voxels, const Surfel& s, double radius) {
  // In the shortest spacing, so that the ball holds the same voxels in any unit.
  const Vec3 h = voxels.grid.spacing / voxels.grid.spacing.minCoeff();
  Vec3 centre(s.voxel[0], s.voxel[1], s.voxel[2]);
  centre[s.axis] += 0.5 * s.sign;
  const int r = static_cast<int>(std::ceil(radius)) + 1;
  Vec3 sum = Vec3::Zero();
  for (int k = s.voxel[2] - r; k <= s.voxel[2] + r; ++k)
    for (int j = s.voxel[1] - r; j <= s.voxel[1] + r; ++j)
      for (int i = s.voxel[0] - r; i <= s.voxel[0] + r; ++i) {
        const Vec3 d = h.cwiseProduct(Vec3(i, j, k) - centre);
        if (d.squaredNorm() <= radius * radius && voxels(i, j, k)) sum -= d;
      }
  const Vec3 own = s.sign * Vec3::Unit(s.axis);
  Vec3 n = sum.squaredNorm() > 0 ? Vec3(sum.normalized()) : own;
  constexpr double least = 0.05;
  if (n.dot(own) < least) n = (n + (least - n.dot(own)) * own).normalized();
  return n;
}

}  // namespace

VoxelSurface boundary_of_voxels(const Grid& grid, const std::vector<unsigned char>& inside) {
  check_box(grid);
  const Voxels voxels{grid, inside};
  const std::vector<Surfel> surfels = find_surfels(voxels);
  PolygonSoup soup;
  std::unordered_map<std::size_t, int> number;
  std::vector<Vec3> points;
  auto corner = [&](const Index3& c) {  // the low corner of voxel c
    const std::size_t key =
        c[0] + std::size_t(grid.n[0] + 1) * (c[1] + std::size_t(grid.n[1] + 1) * c[2]);
    const auto [it, added] = number.try_emplace(key, points.size());
    if (added)
      points.emplace_back(grid.origin +
                          grid.spacing.cwiseProduct(Vec3(c[0] - 0.5, c[1] - 0.5, c[2] - 0.5)));
    return it->second;
  };
  Index3 low = surfels[0].voxel, high = low;
  for (const Surfel& s : surfels) {
    for (int d = 0; d < 3; ++d) {
      low[d] = std::min(low[d], s.voxel[d]);
      high[d] = std::max(high[d], s.voxel[d]);
    }
    Index3 c = s.voxel;
    if (s.sign > 0) ++c[s.axis];
    const int u = (s.axis + 1) % 3, v = (s.axis + 2) % 3;
    int quad[4];
    for (int q = 0; q < 4; ++q) {
      Index3 at = c;
      at[u] += q == 1 || q == 2;
      at[v] += q >= 2;
      quad[s.sign > 0 ? q : 3 - q] = corner(at);
    }
    soup.add_face(quad);
  }
  soup.points.resize(points.size(), 3);
  for (std::size_t i = 0; i < points.size(); ++i) soup.points.row(i) = points[i];

  int extent = 1;
  for (int d = 0; d < 3; ++d) extent = std::max(extent, high[d] - low[d] + 1);
  const double radius = std::clamp(0.5 * std::pow(extent, 2.0 / 3.0), 2.5, 10.0);
  MatX3 normals(surfels.size(), 3);
  parallel_for(surfels.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s)
      normals.row(s) = corrected_normal(voxels, surfels[s], radius);
  });
  return {SurfaceMesh(std::move(soup)), std::move(normals)};
}

}  // namespace littoral
