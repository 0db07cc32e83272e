// Volumes as whole files.

#include "io/formats.h"
#include "io/read.h"
#include "io/text_scan.h"
#include "io/write.h"
#include "littoral/error.h"

namespace littoral::io {

Volume read_volume_bytes(std::string_view bytes, const std::string& extension,
                         const std::string& name, const std::string& field) {
  const Format& format = format_to_read(extension, name, {Kind::volume});
  Volume volume = format.read_volume(bytes, name, field);
  if (!field.empty() && field != volume.name)
    throw InputError(name + ": there is no field " + in_quotes(field) + ", only " + volume.name,
                     "unknown-name");
  return volume;
}

Volume read_volume(const std::filesystem::path& path, const std::string& field) {
  return read_volume_bytes(read_bytes(path), extension_to_read(path), path.string(), field);
}

void write_volume(const std::filesystem::path& path, const Volume& volume,
                  const VolumeWriteOptions& options) {
  if (static_cast<std::size_t>(volume.values.size()) != volume.grid.n_nodes())
    throw InputError("cannot write " + path.string() + ": " + std::to_string(volume.values.size()) +
                         " values for " + std::to_string(volume.grid.n_nodes()) + " nodes",
                     "cannot-write");
  const Format& format = format_to_write(path, {Kind::volume});
  write_atomically(path, [&](std::ostream& out) { format.write_volume(out, volume, options); });
}

}  // namespace littoral::io
