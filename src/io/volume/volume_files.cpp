// Volumes as whole files.

#include <algorithm>

#include "base/option_table.h"
#include "io/contents_hint.h"
#include "io/formats.h"
#include "io/read.h"
#include "io/text_scan.h"
#include "io/volume/volume_formats.h"
#include "io/write.h"
#include "littoral/error.h"

namespace littoral::io {

Volume read_volume_bytes(std::string_view bytes, const std::string& extension,
                         const std::string& name, const std::string& field) {
  const Format& format = format_to_read(extension, name, {Kind::volume});
  Volume volume =
      read_with_hint(bytes, extension, [&] { return format.read_volume(bytes, name, field); });
  if (!field.empty() && field != volume.name)
    throw InputError(name + ": there is no field " + in_quotes(field) + ", only " + volume.name,
                     "unknown-name");
  return volume;
}

std::size_t chosen_field(const std::vector<std::string>& names, const std::string& wanted,
                         const std::string& file) {
  const auto fail = [&](const std::string& what) {
    throw InputError(file + ": " + what, "bad-file");
  };
  const auto at = [&](const std::string& name) {
    return std::size_t(std::ranges::find(names, name) - names.begin());
  };
  const std::string known = listed(names);
  if (!wanted.empty()) {
    if (at(wanted) == names.size())
      fail("there is no field " + in_quotes(wanted) +
           "; it has: " + (known.empty() ? "none" : known));
    return at(wanted);
  }
  if (at("distance") < names.size()) return at("distance");
  if (names.empty()) fail("there is no field with one value per node");
  if (names.size() > 1) fail("it has the fields " + known + ": choose one with option field");
  return 0;
}

Volume read_volume(const std::filesystem::path& path, const std::string& field) {
  return read_volume_bytes(FileBytes(path).view(), extension_to_read(path), path.string(), field);
}

void write_volume(const std::filesystem::path& path, const Volume& volume,
                  const VolumeWriteOptions& options) {
  if (std::size_t(volume.values.size()) != volume.grid.n_nodes())
    throw InputError("cannot write " + path.string() + ": " + std::to_string(volume.values.size()) +
                         " values for " + std::to_string(volume.grid.n_nodes()) + " nodes",
                     "cannot-write");
  const Format& format = format_to_write(path, {Kind::volume});
  write_atomically(path, [&](std::ostream& out) { format.write_volume(out, volume, options); });
}

}  // namespace littoral::io
