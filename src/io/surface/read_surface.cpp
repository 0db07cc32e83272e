// The choice of a surface reader.

#include "io/contents_hint.h"
#include "io/formats.h"
#include "io/read.h"

namespace littoral::io {

PolygonSoup read_surface_bytes(std::string_view bytes, const std::string& extension,
                               const std::string& name) {
  const Format& format = format_to_read(extension, name, {Kind::surface, Kind::cloud});
  return read_with_hint(bytes, extension, [&] {
    return (format.read_surface ? format.read_surface : format.read_cloud)(bytes, name);
  });
}

PolygonSoup read_surface(const std::filesystem::path& path) {
  const std::string extension = extension_to_read(path);
  const Format& format = format_to_read(extension, path.string(), {Kind::surface, Kind::cloud});
  if (format.read_beside) return format.read_beside(FileBytes(path).view(), path);
  return read_surface_bytes(FileBytes(path).view(), extension, path.string());
}

}  // namespace littoral::io
