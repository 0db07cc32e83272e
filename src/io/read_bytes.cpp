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
#include <utility>
#include <vector>

#include "base/index.h"
#include "base/parallel.h"
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

/// A stream up to its end.
std::string all_of(std::FILE* file, const std::filesystem::path& path) {
  std::string bytes;
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

std::string without_gzip(std::string_view packed, const std::string& name) {
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

void FileBytes::read(FilePlaces& file, const std::filesystem::path& path, std::size_t size) {
  constexpr std::size_t piece = 1 << 20;
  bytes_.reset(new char[size]);
  prefer_large_pages(bytes_.get(), size);
  struct Read {
    std::size_t bytes;
    int error;
  };
  std::vector<Read> pieces((size + piece - 1) / piece);
  parallel_for(size, piece, [&](std::size_t begin, std::size_t end) {
    Read here{0, 0};
    here.bytes = file.read(&bytes_[begin], end - begin, index(begin), here.error);
    pieces[begin / piece] = here;
  });
  for (const Read& p : pieces) {
    if (p.error != 0) cannot_read(path, std::generic_category().message(p.error));
    size_ += p.bytes;
    if (p.bytes < piece) break;  // the last one, or the file has become shorter
  }
  std::array<char, 1 << 16> block;
  int error = 0;
  while (const std::size_t n =
             file.read(block.data(), block.size(), index(size_ + text_.size()), error))
    text_.append(block.data(), n);
  if (error != 0) cannot_read(path, std::generic_category().message(error));
  if (text_.empty()) return;
  text_.insert(0, bytes_.get(), size_);  // it has become longer
  bytes_.reset();
}

FileBytes::FileBytes(const std::filesystem::path& path) {
  if (is_standard_stream(path)) {
    static std::atomic<bool> was_read = false;  // not kept: it may be large
    if (was_read.exchange(true)) cannot_read(path, "standard input was read before");
    text_ = all_of(stdin, path);
    return;
  }
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) cannot_read(path, "it is a directory");
  const File file(std::fopen(path.c_str(), "rb"), &std::fclose);
  if (!file)
    cannot_read(path, std::generic_category().message(errno) +
                          (path.string().starts_with("~")
                               ? "; '~' is the home folder only without quotes, in the shell"
                               : ""));
  std::error_code none;
  std::optional<FilePlaces> places;  // of a plain file: to open a pipe again would wait for ever
  const bool plain = std::filesystem::is_regular_file(path, none);
  const std::uintmax_t size = plain ? std::filesystem::file_size(path, none) : 0;
  if (plain && size > 0 && !none && size < text_.max_size())
    places.emplace(path.c_str(), FilePlaces::For::reading);
  if (places && places->is_open())
    read(*places, path, std::size_t(size));
  else
    text_ = all_of(file.get(), path);
  if (!is_packed(path)) return;
  text_ = without_gzip(view(), path.string());
  bytes_.reset();
}

std::string read_bytes(const std::filesystem::path& path) {
  return std::string(FileBytes(path).view());
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
