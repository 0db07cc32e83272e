#pragma once
// Volumes in files: values at the nodes of a grid.

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "littoral/volume.h"

namespace littoral::io {

/// Reads a volume by extension (io/formats.h; any case). Values are kept even where they
/// are not finite. `field` names the one to use among several; without it "distance" or the only
/// one.
///   .vti   ImageData of one piece; ascii, binary and appended data, raw, base64 or zlib-compressed
///   NRRD   three axes along x, y and z; raw, ascii or gzip, in the same file
///   .npy   three dimensions, array[i, j, k] at x_i, y_j, z_k; the format has no place for the box,
///   so
///          the spacing is 1 and the origin 0
///   .vol   voxels of one byte; spacing 1, origin 0
/// Throws InputError naming the file and what is wrong, UnsupportedError for what the format allows
/// and this reader does not, IoError.
Volume read_volume(const std::filesystem::path& path, const std::string& field = "");

/// The same from memory. Allocates no more than a small multiple of the data that the bytes hold
/// (unpacked, where they are compressed).
Volume read_volume_bytes(std::string_view bytes, const std::string& extension,
                         const std::string& name, const std::string& field = "");

struct VolumeWriteOptions {
  /// More values at the same nodes, by name, where the format holds them (`more_values`).
  std::vector<std::pair<std::string, VecX>> more{};
  /// .vdb: half width of the band of values kept about zero, in the largest spacing; beyond it only
  /// the sign is stored. 0 keeps all values.
  double band = 0;
};

/// Writes a volume by extension. Reading double precision again gives the same numbers, exactly;
/// .vdb has single precision and is of class "level set", negative inside, with background 3
/// spacings or the band's half width. Throws UnsupportedError for other extensions and where the
/// module for .vdb is missing, InputError for a wrong number of values, IoError.
void write_volume(const std::filesystem::path& path, const Volume& volume,
                  const VolumeWriteOptions& options = {});

/// True if .vdb can be read and written: the module littoral_vdb is there (io/volume/vdb_module.h).
/// Loads it.
bool has_openvdb();

}  // namespace littoral::io
