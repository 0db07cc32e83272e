// Files as a whole: plain, packed by gzip, or standard input.

#include <algorithm>
#include <array>
#include <atomic>
#include <cctype>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <system_error>

#include "base/platform/large_pages.h"
#include "io/binary.h"
#include "io/formats.h"
#include "io/read.h"
#include "io/text_scan.h"
#include "io/volume/volume_formats.h"
#include "littoral/error.h"

namespace littoral::io {

namespace {

constexpr std::string_view stream_mark = ":-", packed_mark = ".gz";

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

bool is_packed(const std::filesystem::path& path) {
  return lower_case(path.extension().string()) == packed_mark;
}

[[noreturn]] void cannot_read(const std::filesystem::path& path, const std::string& why) {
  throw IoError("cannot read " + path.string() + ": " + why, "cannot-read");
}

/// size: of the file, where that is known.
std::string all_of(std::FILE* file, const std::filesystem::path& path, std::uintmax_t size) {
  std::string bytes;
  if (size > 0 && size < bytes.max_size()) {
    bytes.reserve(std::size_t(size));
    prefer_large_pages(bytes.data(), std::size_t(size));
  }
  std::array<char, 1 << 16> block;
  while (const std::size_t n = std::fread(block.data(), 1, block.size(), file))
    bytes.append(block.data(), n);
  if (std::ferror(file)) cannot_read(path, std::generic_category().message(errno));
  return bytes;
}

/// How large a file of one member below 4 GiB is unpacked, by its last bytes.
std::uint32_t unpacked_size(std::string_view last) {
  return load_little<std::uint32_t>(last.data() + last.size() - sizeof(std::uint32_t));
}

std::string without_gzip(const std::string& packed, const std::string& name) {
  const std::string hint = "; unpack it with gzip -d and name the result";
  constexpr std::size_t least = 18;  // bytes of head and end
  if (packed.size() < least || packed.substr(0, 2) != "\x1f\x8b")
    throw InputError(name + ": not packed by gzip, as its name says", "bad-file");
  auto bytes = unpack(packed, unpacked_size(packed), Packing::zlib_or_gzip);
  if (!bytes)
    throw InputError(name + ": damaged, of several parts, or beyond 4 GiB" + hint, "bad-file");
  return *std::move(bytes);
}

}  // namespace

bool is_standard_stream(const std::filesystem::path& path) {
  const std::string name = path.string();
  return name.size() > stream_mark.size() && name.ends_with(stream_mark) &&
         std::all_of(name.begin(), name.end() - stream_mark.size(),
                     [](unsigned char c) { return std::isalnum(c); });
}

std::string extension_to_write(const std::filesystem::path& path) {
  if (!is_standard_stream(path)) return path.extension().string();
  const std::string name = path.string();
  return "." + name.substr(0, name.size() - stream_mark.size());
}

std::string extension_named(const std::filesystem::path& path) {
  const std::string extension = extension_to_write(path);
  return lower_case(extension) == packed_mark ? path.stem().extension().string() : extension;
}

std::string read_bytes(const std::filesystem::path& path) {
  if (is_standard_stream(path)) {
    static std::atomic<bool> read = false;  // not kept: it may be large
    if (read.exchange(true)) cannot_read(path, "standard input was read before");
    return all_of(stdin, path, 0);
  }
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) cannot_read(path, "it is a directory");
  const File file(std::fopen(path.c_str(), "rb"), &std::fclose);
  if (!file)
    cannot_read(path, std::generic_category().message(errno) +
                          (path.string().starts_with("~")
                               ? "; '~' is the home folder only without quotes, in the shell"
                               : ""));
  std::string bytes = all_of(file.get(), path, std::filesystem::file_size(path, ignored));
  return is_packed(path) ? without_gzip(bytes, path.string()) : bytes;
}

FirstBytes first_bytes(const std::filesystem::path& path, std::size_t most) {
  std::error_code none;
  if (is_standard_stream(path) || !std::filesystem::is_regular_file(path, none)) return {};
  const File file(std::fopen(path.c_str(), "rb"), &std::fclose);
  if (!file) return {};
  const auto read = [&](std::size_t count) {
    std::string bytes(count, '\0');
    bytes.resize(std::fread(bytes.data(), 1, count, file.get()));
    return bytes;
  };
  std::string bytes = read(most);
  if (!is_packed(path)) {
    const std::uintmax_t size = std::filesystem::file_size(path, none);
    return {std::move(bytes), none ? 0 : size};
  }
  std::string last;
  if (std::fseek(file.get(), -static_cast<long>(sizeof(std::uint32_t)), SEEK_END) == 0)
    last = read(sizeof(std::uint32_t));
  return {unpacked_beginning(bytes, most),
          last.size() < sizeof(std::uint32_t) ? 0 : unpacked_size(last)};
}

}  // namespace littoral::io
