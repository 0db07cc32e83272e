// The module littoral_vdb: OpenVDB level sets.

#include "io/volume/vdb_module.h"

#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Prune.h>

#include <cmath>
#include <exception>
#include <string>

#include "base/index.h"

namespace {

using littoral::Volume;

openvdb::GridBase::Ptr level_set(const Volume& volume, double band) {
  const littoral::Grid& g = volume.grid;
  const double largest = g.spacing.maxCoeff();
  const double background = (band > 0 ? band : 3) * largest;
  auto grid = openvdb::FloatGrid::create(static_cast<float>(background));
  grid->setName(volume.name);
  grid->setGridClass(openvdb::GRID_LEVEL_SET);
  using openvdb::math::ScaleTranslateMap;
  grid->setTransform(
      openvdb::math::Transform::Ptr(new openvdb::math::Transform(ScaleTranslateMap::Ptr(
          new ScaleTranslateMap(openvdb::Vec3d(g.spacing[0], g.spacing[1], g.spacing[2]),
                                openvdb::Vec3d(g.origin[0], g.origin[1], g.origin[2]))))));
  auto accessor = grid->getAccessor();
  Eigen::Index v = 0;
  for (int k = 0; k < g.n[2]; ++k) {
    for (int j = 0; j < g.n[1]; ++j) {
      for (int i = 0; i < g.n[0]; ++i, ++v) {
        const double value = volume.values[v];
        if (band > 0 && !(std::abs(value) < background)) {
          if (value < 0) accessor.setValueOff({i, j, k}, static_cast<float>(-background));
        } else {
          accessor.setValueOn({i, j, k}, static_cast<float>(value));
        }
      }
    }
  }
  if (band > 0) openvdb::tools::pruneInactive(grid->tree());
  return grid;
}

std::string write(std::ostream& out, const Volume& volume, double band) {
  try {
    openvdb::initialize();
    const openvdb::GridPtrVec grids{level_set(volume, band)};
    openvdb::io::Stream(out).write(grids);
    return "";
  } catch (const std::exception& e) {
    return e.what();
  }
}

/// The box of a grid along x, y and z; nothing where its axes run otherwise.
bool box_of(const openvdb::math::Transform& transform, const openvdb::CoordBBox& box,
            littoral::Grid& grid) {
  if (!transform.isLinear()) return false;
  const openvdb::Vec3d origin = transform.indexToWorld(box.min().asVec3d());
  for (int k = 0; k < 3; ++k) {
    openvdb::Vec3d next = box.min().asVec3d();
    next[k] += 1;
    const openvdb::Vec3d side = transform.indexToWorld(next) - origin;
    for (int j = 0; j < 3; ++j)
      if (j == k ? !(side[j] > 0) : std::abs(side[j]) > 1e-12 * std::abs(side[k])) return false;
    grid.origin[k] = origin[k];
    grid.spacing[k] = side[k];
    grid.n[k] = box.dim()[k];
  }
  return true;
}

template <class GridType>
std::string dense(const GridType& grid, double most, Volume& volume) {
  const openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
  if (box.empty()) return "the grid '" + grid.getName() + "' has no active voxels";
  const openvdb::Coord size = box.dim();
  const double nodes = double(size[0]) * double(size[1]) * double(size[2]);
  if (nodes > most)
    return "the box of the grid '" + grid.getName() + "' has " + std::to_string(size[0]) + " x " +
           std::to_string(size[1]) + " x " + std::to_string(size[2]) +
           " nodes, too many for a volume that holds them all";
  if (!box_of(grid.transform(), box, volume.grid))
    return "the axes of the grid '" + grid.getName() + "' do not run along x, y and z";
  volume.values.resize(index(volume.grid.n_nodes()));
  const auto accessor = grid.getConstAccessor();
  Eigen::Index v = 0;
  for (int k = box.min()[2]; k <= box.max()[2]; ++k)
    for (int j = box.min()[1]; j <= box.max()[1]; ++j)
      for (int i = box.min()[0]; i <= box.max()[0]; ++i)
        volume.values[v++] = static_cast<double>(accessor.getValue({i, j, k}));
  return "";
}

std::string read(std::istream& in, const std::string& field, double most, Volume& volume) {
  try {
    openvdb::initialize();
    openvdb::io::Stream stream(in, false);
    openvdb::GridBase::Ptr chosen;
    std::string names;
    int scalars = 0;
    const openvdb::GridPtrVecPtr grids = stream.getGrids();
    for (const openvdb::GridBase::Ptr& grid : *grids) {
      if (!grid->isType<openvdb::FloatGrid>() && !grid->isType<openvdb::DoubleGrid>()) continue;
      const std::string name = grid->getName();
      names += (names.empty() ? "" : ", ") + name;
      ++scalars;
      if (!chosen || name == (field.empty() ? "distance" : field)) chosen = grid;
    }
    if (!chosen) return "there is no grid of floating-point numbers";
    const std::string name = chosen->getName();
    if (!field.empty() && name != field)
      return "there is no grid '" + field + "'; it has: " + names;
    if (field.empty() && scalars > 1 && name != "distance")
      return "it has the grids " + names + ": choose one with option field";
    volume.name = name.empty() ? "distance" : name;
    if (const auto singles = openvdb::gridPtrCast<openvdb::FloatGrid>(chosen))
      return dense(*singles, most, volume);
    return dense(*openvdb::gridPtrCast<openvdb::DoubleGrid>(chosen), most, volume);
  } catch (const std::exception& e) {
    return e.what();
  }
}

}  // namespace

extern "C" __attribute__((visibility("default"))) const littoral::io::VdbModule*
littoral_vdb_module() {
  static const littoral::io::VdbModule module{LITTORAL_VERSION, &write, &read};
  return &module;
}
