// Files as a whole, and the choice of a surface reader.

#include <array>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>

#include "io/formats.h"
#include "io/read.h"
#include "littoral/error.h"

namespace littoral::io {

std::string read_bytes(const std::filesystem::path& path) {
  const auto fail = [&](const std::string& why) -> std::string {
    throw IoError("cannot read " + path.string() + ": " + why, "cannot-read");
  };
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) return fail("it is a directory");
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"),
                                                             &std::fclose);
  if (!file) return fail(std::generic_category().message(errno));
  std::string bytes;
  std::array<char, 1 << 16> block;
  while (const std::size_t n = std::fread(block.data(), 1, block.size(), file.get())) {
    bytes.append(block.data(), n);
  }
  if (std::ferror(file.get())) return fail(std::generic_category().message(errno));
  return bytes;
}

PolygonSoup read_surface_bytes(std::string_view bytes, const std::string& extension,
                               const std::string& name) {
  const Format& format = format_to_read(extension, name, {Kind::surface, Kind::cloud});
  return (format.read_surface ? format.read_surface : format.read_cloud)(bytes, name);
}

PolygonSoup read_surface(const std::filesystem::path& path) {
  const std::string extension = path.extension().string();
  const Format& format = format_to_read(extension, path.string(), {Kind::surface, Kind::cloud});
  if (format.read_beside) return format.read_beside(read_bytes(path), path);
  return read_surface_bytes(read_bytes(path), extension, path.string());
}

}  // namespace littoral::io
