#include "io/volume/read_voxels.h"

#include <zlib.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <map>

#include "base/index.h"
#include "io/formats.h"
#include "io/read.h"
#include "io/volume/volume_formats.h"
#include "littoral/error.h"

namespace littoral::io {

namespace {

constexpr long long most_voxels = 1LL << 31;
constexpr long long most_packed = 1032;  // bytes that zlib makes of one, at most

/// "Key: value" lines up to a line with a dot; returns where the voxels begin.
std::size_t read_header(std::string_view bytes, const std::string& name,
                        std::map<std::string, std::string>& header) {
  std::size_t at = 0;
  for (int line = 1; at < bytes.size() && line < 1000; ++line) {
    const std::size_t end = std::min(bytes.find('\n', at), bytes.size());
    std::string_view text = bytes.substr(at, end - at);
    at = end + 1;
    if (!text.empty() && text.back() == '\r') text.remove_suffix(1);
    if (text == ".") return std::min(at, bytes.size());
    const std::size_t colon = text.find(':');
    if (colon == std::string_view::npos)
      throw InputError(name + ":" + std::to_string(line) + ": expected 'Key: value' or '.'",
                       "bad-file");
    std::string_view value = text.substr(colon + 1);
    while (!value.empty() && value.front() == ' ') value.remove_prefix(1);
    header[std::string(text.substr(0, colon))] = std::string(value);
  }
  throw InputError(name + ": the header does not end with a line '.'", "bad-file");
}

int header_number(const std::map<std::string, std::string>& header, const std::string& key,
                  const std::string& name, int fallback) {
  const auto it = header.find(key);
  if (it == header.end()) {
    if (fallback >= 0) return fallback;
    throw InputError(name + ": the header has no '" + key + "'", "bad-file");
  }
  int value = 0;
  const char* last = it->second.data() + it->second.size();
  const auto [stop, code] = std::from_chars(it->second.data(), last, value);
  if (code != std::errc() || stop != last || value < 1)
    throw InputError(name + ": '" + key + ": " + it->second + "' is not a positive number",
                     "bad-file");
  return value;
}

}  // namespace

VoxelMask read_vol_bytes(std::string_view bytes, const std::string& name) {
  std::map<std::string, std::string> header;
  std::string_view data = bytes.substr(read_header(bytes, name, header));
  VoxelMask mask;
  long long count = 1;
  const char* keys[3] = {"X", "Y", "Z"};
  for (int d = 0; d < 3; ++d) {
    mask.grid.n[d] = header_number(header, keys[d], name, -1);
    count *= mask.grid.n[d];
    if (count > most_voxels) throw InputError(name + ": more than 2^31 voxels", "too-large");
  }
  if (header_number(header, "Voxel-Size", name, 1) != 1)
    throw UnsupportedError(name + ": voxels of more than one byte are not read",
                           "unsupported-file");
  const int version = header_number(header, "Version", name, 2);
  if (version != 2 && version != 3)
    throw UnsupportedError(
        name + ": version " + std::to_string(version) + " of .vol is not read; 2 and 3 are",
        "unsupported-file");
  const auto held = static_cast<long long>(data.size());
  if ((version == 2 ? held : held * most_packed) < count)
    throw InputError(name + ": " + std::to_string(count) + " voxels do not fit into the file's " +
                         std::to_string(held) + " bytes of data",
                     "bad-file");
  mask.inside.resize(std::size_t(count));
  if (version == 2) {
    std::memcpy(mask.inside.data(), data.data(), mask.inside.size());
  } else {
    uLongf size = static_cast<uLongf>(count);
    if (uncompress(mask.inside.data(), &size, reinterpret_cast<const Bytef*>(data.data()),
                   static_cast<uLong>(data.size())) != Z_OK ||
        size != static_cast<uLongf>(count))
      throw InputError(name + ": the packed voxels are damaged", "bad-file");
  }
  return mask;
}

Volume read_vol(std::string_view bytes, const std::string& name, const std::string&) {
  const VoxelMask mask = read_vol_bytes(bytes, name);
  const Eigen::Map<const Eigen::Matrix<unsigned char, Eigen::Dynamic, 1>> inside(
      mask.inside.data(), index(mask.inside.size()));
  return {mask.grid, inside.cast<double>(), "voxel"};
}

VoxelMask read_voxels(const std::filesystem::path& path) {
  const std::string name = path.filename().string();
  const Format& format = format_to_read(extension_to_read(path), path.string(), {Kind::voxels});
  if (format.read_voxels) return format.read_voxels(FileBytes(path).view(), name);
  const Volume volume = read_volume(path);
  if (!volume.values.allFinite())
    throw InputError(name + ": a mask needs finite values, 0 outside", "bad-file");
  if (volume.values.minCoeff() < 0 && volume.values.maxCoeff() > 0)
    throw InputError(
        name +
            ": its values have both signs, a mask is 0 outside and 1 inside; of a field, "
            "take the surface where it is 0",
        "bad-file");
  VoxelMask mask{volume.grid, {}};
  mask.inside.resize(volume.grid.n_nodes());
  for (std::size_t i = 0; i < mask.inside.size(); ++i)
    mask.inside[i] = volume.values[index(i)] != 0;
  return mask;
}

}  // namespace littoral::io
