#pragma once
// Several arrays in one file or folder.

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace littoral::io {

/// An array of numbers in bytes: the last axis runs fastest, lowest byte first.
struct NamedArray {
  std::string name;
  std::string type;  // as NumPy writes it: "<f4", "|u1"
  std::vector<std::size_t> shape;
  std::string bytes;
};

/// Throws UnsupportedError unless the extension is .npz, .zarr or .tar, IoError where it cannot be
/// written.
void check_arrays_output(const std::filesystem::path& path);

/// .npz: a member for each array; .zarr: version 2, a chunk for each array, and `about` as the
/// attributes; .tar: members STEM.NAME.npy and STEM.json, as WebDataset has them. `about`: JSON.
/// Nothing is left behind by a failure. Throws as above.
void write_arrays(const std::filesystem::path& path, const std::vector<NamedArray>& arrays,
                  const std::string& about);

}  // namespace littoral::io
