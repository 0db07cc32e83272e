#include "io/render/volume_scene.h"

#include <algorithm>
#include <cmath>

#include "base/index.h"
#include "base/option_table.h"
#include "contour/isosurface.h"
#include "littoral/error.h"

namespace littoral::io {

namespace {

constexpr int page_nodes = 256;  // along the longest axis

// Every node of fewer, spread over the same box.
Volume thinned(const Volume& volume) {
  const Grid& grid = volume.grid;
  Vec3 length;
  for (int a = 0; a < 3; ++a) length[a] = grid.spacing[a] * (grid.n[a] - 1);
  Volume thin{grid, {}, volume.name};
  for (int a = 0; a < 3; ++a) {
    const double wanted = 1 + std::ceil((page_nodes - 1) * (length[a] / length.maxCoeff()));
    thin.grid.n[a] = std::min(grid.n[a], std::max(2, static_cast<int>(wanted)));
    thin.grid.spacing[a] = length[a] / (thin.grid.n[a] - 1);
  }
  const auto& n = thin.grid.n;
  thin.values.resize(index(thin.grid.n_nodes()));
  Eigen::Index v = 0;
  for (int k = 0; k < n[2]; ++k) {
    for (int j = 0; j < n[1]; ++j) {
      for (int i = 0; i < n[0]; ++i) {
        Vec3 at(i, j, k);
        for (int a = 0; a < 3; ++a) at[a] *= (grid.n[a] - 1.0) / (n[a] - 1.0);
        thin.values[v++] = interpolate(volume, at);
      }
    }
  }
  return thin;
}

std::shared_ptr<SceneVolume> describe(const Volume& volume, const VolumeView& view) {
  const Grid& grid = volume.grid;
  if (view.axis < 0 || view.axis > 2)
    throw InputError("volume: the axis must be x, y or z", "option-value");
  for (int a = 0; a < 3; ++a)
    if (grid.n[a] < 2)
      throw InputError("volume: a grid needs two nodes along each axis", "option-value");
  auto known = std::make_shared<SceneVolume>();
  known->low = infinity;
  known->high = -known->low;
  for (Eigen::Index v = 0; v < volume.values.size(); ++v) {
    const double value = volume.values[v];
    if (std::isnan(value))
      throw InputError("volume: the value of node " + std::to_string(v) + " is NaN", "not-finite");
    if (!std::isfinite(value)) {
      known->infinite = true;
      continue;
    }
    known->low = std::min(known->low, value);
    known->high = std::max(known->high, value);
  }
  if (known->low > known->high) throw InputError("volume: no value is finite", "not-finite");
  const bool zero = known->low < 0 && known->high > 0;
  known->level = view.level.value_or(zero ? 0 : 0.5 * known->low + 0.5 * known->high);
  if (!std::isfinite(known->level))
    throw InputError("volume: the level must be a finite number", "option-value");
  known->isosurface = view.isosurface && !known->infinite;
  known->axis = view.axis;
  const double low = grid.origin[view.axis];
  const double step = grid.spacing[view.axis], steps = grid.n[view.axis] - 1;
  const double position = view.position.value_or(low + step * std::floor(0.5 * steps));
  if (!(position >= low && position <= low + step * steps))
    throw InputError("volume: the slice at " + number_text(position) + " is outside the box, " +
                         rounded_text(low) + " to " + rounded_text(low + step * steps),
                     "nothing-there");
  known->slice = static_cast<int>(std::lround((position - low) / step));
  known->position = known->slice / steps;
  known->thin = thinned(volume);
  return known;
}

// Triangles over points with values, appended to a scene.
class Builder {
 public:
  void add_slice(const Volume& volume, int axis, int slice) {
    const int u = (axis + 1) % 3, w = (axis + 2) % 3;
    const int nu = volume.grid.n[u], nw = volume.grid.n[w];
    const auto node = [&](int i, int j) {
      std::array<int, 3> at;
      at[axis] = slice;
      at[u] = i;
      at[w] = j;
      return at;
    };
    const int first = static_cast<int>(points_.size());
    for (int j = 0; j < nw; ++j) {
      for (int i = 0; i < nu; ++i) {
        const auto [x, y, z] = node(i, j);
        points_.push_back(volume.grid.point(x, y, z));
        values_.push_back(volume.values[index(volume.grid.node(x, y, z))]);
        if (i + 1 == nu || j + 1 == nw) continue;
        const int a = first + i + nu * j;
        triangles_.push_back({a, a + 1, a + 1 + nu});
        triangles_.push_back({a, a + 1 + nu, a + nu});
      }
    }
  }

  void add_surface(const PolygonSoup& surface, double value) {
    const int first = static_cast<int>(points_.size());
    for (int v = 0; v < surface.n_vertices(); ++v) {
      points_.emplace_back(surface.points.row(v));
      values_.push_back(value);
    }
    for (int f = 0; f < surface.n_faces(); ++f) {
      const auto face = surface.face(f);
      triangles_.push_back({first + face[0], first + face[1], first + face[2]});
    }
  }

  void put_into(Scene& scene) const {
    scene.points.resize(index(points_.size()), 3);
    scene.values.resize(index(points_.size()));
    for (std::size_t v = 0; v < points_.size(); ++v) {
      scene.points.row(index(v)) = points_[v].transpose();
      scene.values[index(v)] = values_[v];
    }
    scene.triangles.resize(index(triangles_.size()), 3);
    for (std::size_t t = 0; t < triangles_.size(); ++t)
      for (int k = 0; k < 3; ++k) scene.triangles(index(t), k) = triangles_[t][k];
  }

 private:
  std::vector<Vec3> points_;
  std::vector<double> values_;
  std::vector<std::array<int, 3>> triangles_;
};

// The part of a volume from a slice on.
Volume in_front(const Volume& volume, int axis, int slice) {
  Volume part{volume.grid, {}, volume.name};
  part.grid.n[axis] -= slice;
  part.grid.origin[axis] += slice * volume.grid.spacing[axis];
  std::array<int, 3> first{};
  first[axis] = slice;
  const auto& n = part.grid.n;
  part.values.resize(index(part.grid.n_nodes()));
  for (int k = 0; k < n[2]; ++k)
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i)
        part.values[index(part.grid.node(i, j, k))] =
            volume.values[index(volume.grid.node(first[0] + i, first[1] + j, first[2] + k))];
  return part;
}

}  // namespace

Scene make_volume_scene(const Volume& volume, const VolumeView& view) {
  const auto known = describe(volume, view);
  Builder builder;
  builder.add_slice(volume, known->axis, known->slice);
  if (known->isosurface && known->slice + 1 < volume.grid.n[known->axis]) {
    const Volume part = in_front(volume, known->axis, known->slice);
    Report unheard;  // it ends at the slice
    builder.add_surface(isosurface(part.grid, part.values, known->level, {}, unheard),
                        known->level);
  }
  Scene scene;
  builder.put_into(scene);
  scene.field_name = volume.name;
  const auto& n = volume.grid.n;
  scene.facts = {{"nodes", std::to_string(n[0]) + " x " + std::to_string(n[1]) + " x " +
                               std::to_string(n[2])}};
  scene.volume = known;
  return scene;
}

}  // namespace littoral::io
