// The module littoral_vdb: OpenVDB level sets.

#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Prune.h>

#include <cmath>
#include <exception>

#include "io/volume/vdb_module.h"

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

}  // namespace

extern "C" __attribute__((visibility("default"))) const littoral::io::VdbModule*
littoral_vdb_module() {
  static const littoral::io::VdbModule module{LITTORAL_VERSION, &write};
  return &module;
}
