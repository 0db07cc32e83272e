// OpenVDB level sets, where the library is there.

#include "littoral/base/error.h"
#include "littoral/io/volume_formats.h"

#ifdef LITTORAL_OPENVDB
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Prune.h>

#include <cmath>
#endif

namespace littoral::io {

#ifdef LITTORAL_OPENVDB

bool has_openvdb() { return true; }

void write_vdb(std::ostream& out, const VolumeField& volume, const VolumeWriteOptions& options) {
  openvdb::initialize();
  const Grid& g = volume.grid;
  const double largest = g.spacing.maxCoeff();
  const double background = (options.band > 0 ? options.band : 3) * largest;
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
        if (options.band > 0 && !(std::abs(value) < background)) {
          if (value < 0) accessor.setValueOff({i, j, k}, static_cast<float>(-background));
        } else {
          accessor.setValueOn({i, j, k}, static_cast<float>(value));
        }
      }
    }
  }
  if (options.band > 0) openvdb::tools::pruneInactive(grid->tree());
  openvdb::GridPtrVec grids{grid};
  openvdb::io::Stream(out).write(grids);
}

#else

bool has_openvdb() { return false; }

void write_vdb(std::ostream&, const VolumeField&, const VolumeWriteOptions&) {
  throw UnsupportedError("this build has no OpenVDB");
}

#endif

}  // namespace littoral::io
