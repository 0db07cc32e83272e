#include "io/write_arrays.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <sstream>
#include <system_error>
#include <utility>

#include "base/platform/process.h"
#include "io/formats.h"
#include "io/write.h"
#include "io/write_table.h"
#include "io/zip_archive.h"
#include "littoral/error.h"

namespace littoral::io {

namespace fs = std::filesystem;

namespace {

std::string shape_text(const NamedArray& array, const char* after_last) {
  std::string text;
  for (const std::size_t n : array.shape) text += (text.empty() ? "" : ", ") + std::to_string(n);
  return array.shape.size() == 1 ? text + after_last : text;
}

std::string npy_of(const NamedArray& array) {
  std::ostringstream out;
  write_npy_header(out, shape_text(array, ","), false, array.type);
  out << array.bytes;
  return out.str();
}

void write_npz_arrays(std::ostream& out, const std::vector<NamedArray>& arrays) {
  std::vector<std::pair<std::string, std::string>> members;
  for (const NamedArray& array : arrays) members.emplace_back(array.name + ".npy", npy_of(array));
  write_zip(out, members);
}

/// A member of a POSIX ustar archive (IEEE 1003.1, pax): 512 bytes of head, contents, zeros.
void write_tar_member(std::ostream& out, const std::string& name, const std::string& bytes) {
  constexpr std::size_t block = 512;
  std::string head(block, '\0');
  const auto put = [&head](std::size_t at, const std::string& text) {
    head.replace(at, text.size(), text);
  };
  const auto octal = [](unsigned long long value, int digits) {
    char text[32];
    std::snprintf(text, sizeof text, "%0*llo", digits, value);
    return std::string(text);
  };
  if (name.size() > 100 || std::uint64_t{bytes.size()} >= (std::uint64_t{1} << 33))
    throw UnsupportedError("a member of a .tar has at most 100 characters and 8 GiB: " + name,
                           "unsupported-file");
  put(0, name);
  put(100, octal(0644, 7));
  put(108, octal(0, 7));
  put(116, octal(0, 7));
  put(124, octal(bytes.size(), 11));
  put(136, octal(0, 11));  // no time, so that the same samples are the same file
  put(148, "        ");
  put(156, "0");
  put(257, std::string("ustar\0", 6) + "00");
  unsigned sum = 0;
  for (const char c : head) sum += static_cast<unsigned char>(c);
  put(148, octal(sum, 6) + std::string("\0 ", 2));
  out << head << bytes << std::string((block - bytes.size() % block) % block, '\0');
}

void write_tar(std::ostream& out, const std::string& stem, const std::vector<NamedArray>& arrays,
               const std::string& about) {
  std::string key = stem;
  std::replace(key.begin(), key.end(), '.', '_');  // a key ends at the first dot
  for (const NamedArray& array : arrays)
    write_tar_member(out, key + "." + array.name + ".npy", npy_of(array));
  write_tar_member(out, key + ".json", about);
  out << std::string(1024, '\0');
}

void write_file(const fs::path& path, const std::string& bytes) {
  write_atomically(path, [&](std::ostream& out) { out << bytes; });
}

/// Zarr storage specification, version 2: a group, in it arrays of one chunk each.
void write_zarr(const fs::path& folder, const std::vector<NamedArray>& arrays,
                const std::string& about) {
  write_file(folder / ".zgroup", "{\"zarr_format\": 2}\n");
  write_file(folder / ".zattrs", about);
  for (const NamedArray& array : arrays) {
    fs::create_directory(folder / array.name);
    const std::string shape = "[" + shape_text(array, "") + "]";
    write_file(folder / array.name / ".zarray",
               "{\"zarr_format\": 2, \"shape\": " + shape + ", \"chunks\": " + shape +
                   ", \"dtype\": \"" + array.type +
                   "\", \"compressor\": null, \"fill_value\": 0, \"order\": \"C\", "
                   "\"filters\": null}\n");
    write_file(folder / array.name / (array.shape.size() == 1 ? "0" : "0.0"), array.bytes);
  }
}

/// A folder that is made beside its place and moved there when it is whole.
template <class Fill>
void make_folder_atomically(const fs::path& path, const Fill& fill) {
  const fs::path temporary = path.parent_path() / ("." + path.filename().string() + "." +
                                                   std::to_string(process_id()) + ".tmp");
  std::error_code error;
  try {
    fs::remove_all(temporary);
    fs::create_directory(temporary);
    fill(temporary);
    fs::remove_all(path);
    fs::rename(temporary, path);
  } catch (const fs::filesystem_error& e) {
    fs::remove_all(temporary, error);
    throw IoError("cannot write " + path.string() + ": " + e.code().message(), "cannot-write");
  } catch (...) {
    fs::remove_all(temporary, error);
    throw;
  }
}

}  // namespace

void check_arrays_output(const fs::path& path) {
  if (!has_extension(path, ".npz") && !has_extension(path, ".zarr") && !has_extension(path, ".tar"))
    throw UnsupportedError(
        "cannot write samples to " + path.string() + ": they are written to .npz .zarr .tar",
        "cannot-write");
  if (!has_extension(path, ".zarr")) return check_writable(path);
  std::error_code error;
  if (fs::exists(path, error) && !fs::is_directory(path, error))
    throw IoError("cannot write " + path.string() + ": it is a file, and zarr is a folder",
                  "cannot-write");
}

void write_arrays(const fs::path& path, const std::vector<NamedArray>& arrays,
                  const std::string& about) {
  check_arrays_output(path);
  if (has_extension(path, ".zarr"))
    return make_folder_atomically(
        path, [&](const fs::path& folder) { write_zarr(folder, arrays, about); });
  write_atomically(path, [&](std::ostream& out) {
    if (has_extension(path, ".tar"))
      write_tar(out, path.stem().string(), arrays, about);
    else
      write_npz_arrays(out, arrays);
  });
}

}  // namespace littoral::io
