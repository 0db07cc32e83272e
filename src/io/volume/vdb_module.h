#pragma once
// What the program and its module littoral_vdb share. OpenVDB is a module of its own, loaded where
// a .vdb is read or written: binding its symbols takes longer than everything else at the start of
// the program.

#include <istream>
#include <ostream>
#include <string>

#include "io/volume/volume.h"

namespace littoral::io {

/// What the module exports, under the name below.
struct VdbModule {
  const char* version;  // of littoral: the module must come from the same build
  /// Writes the volume; returns what went wrong, or nothing.
  std::string (*write)(std::ostream& out, const Volume& volume, double band);
  /// Reads the grid of this name, or "distance", or the only one, as the box of its active voxels;
  /// returns what is wrong, among it more than `most` nodes, or nothing.
  std::string (*read)(std::istream& in, const std::string& field, double most, Volume& volume);
};

/// The module's only symbol, a function that returns a VdbModule.
constexpr const char* vdb_module_symbol = "littoral_vdb_module";

}  // namespace littoral::io
