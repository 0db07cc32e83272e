// The choice of a volume format.

#include <array>
#include <fstream>

#include "io/read.h"
#include "io/text_scan.h"
#include "io/volume/read_voxels.h"
#include "io/volume/volume_formats.h"
#include "io/write.h"
#include "littoral/error.h"

namespace littoral::io {

Volume read_volume_bytes(std::string_view bytes, const std::string& extension,
                         const std::string& name, const std::string& field) {
  const std::string format = lower_case(extension);
  if (format == ".vti") return read_vti(bytes, name, field);
  Volume volume;
  if (format == ".nrrd") {
    volume = read_nrrd(bytes, name);
  } else if (format == ".npy") {
    volume = read_npy_volume(bytes, name);
  } else if (format == ".vol") {
    const VoxelMask mask = read_vol_bytes(bytes, name);
    const Eigen::Map<const Eigen::Matrix<unsigned char, Eigen::Dynamic, 1>> inside(
        mask.inside.data(), static_cast<Eigen::Index>(mask.inside.size()));
    volume = {mask.grid, inside.cast<double>(), "voxel"};
  } else if (format == ".vdb") {
    throw UnsupportedError(name +
                           ": .vdb is written, not read; .vti, .nrrd, .npy and .vol are read");
  } else {
    throw InputError(name + ": unknown volume format " + in_quotes(extension) +
                     "; .vti, .nrrd, .npy and .vol are read");
  }
  if (!field.empty() && field != volume.name)
    throw InputError(name + ": there is no field " + in_quotes(field) + ", only " + volume.name);
  return volume;
}

Volume read_volume(const std::filesystem::path& path, const std::string& field) {
  return read_volume_bytes(read_bytes(path), path.extension().string(), path.string(), field);
}

bool is_volume(const std::filesystem::path& path) {
  const std::string format = lower_case(path.extension().string());
  if (format == ".vti" || format == ".nrrd" || format == ".vdb" || format == ".vol") return true;
  if (format != ".npy") return false;
  std::ifstream in(path, std::ios::binary);
  std::array<char, 1024> start{};
  in.read(start.data(), start.size());
  const auto header = parse_npy_header({start.data(), static_cast<std::size_t>(in.gcount())});
  return header && header->shape.size() == 3;
}

void write_volume(const std::filesystem::path& path, const Volume& volume,
                  const VolumeWriteOptions& options) {
  if (static_cast<std::size_t>(volume.values.size()) != volume.grid.n_nodes())
    throw InputError("cannot write " + path.string() + ": " + std::to_string(volume.values.size()) +
                     " values for " + std::to_string(volume.grid.n_nodes()) + " nodes");
  const std::string format = lower_case(path.extension().string());
  const auto write = [&](auto writer) {
    write_atomically(path, [&](std::ostream& out) { writer(out, volume); });
  };
  if (format == ".vti") {
    write(write_vti);
  } else if (format == ".nrrd") {
    write(write_nrrd);
  } else if (format == ".npy") {
    write(write_npy_volume);
  } else if (format == ".vdb") {
    if (!has_openvdb())
      throw UnsupportedError(
          "cannot write " + path.string() +
          ": the module littoral_vdb.so, which needs OpenVDB to be built, is not "
          "installed with the program; .vti, .nrrd and .npy work");
    write([&](std::ostream& out, const Volume& v) { write_vdb(out, v, options); });
  } else {
    throw UnsupportedError("cannot write " + path.string() + ": " + in_quotes(format) +
                           " holds no volume; .vti, .nrrd, .npy and .vdb do");
  }
}

}  // namespace littoral::io
