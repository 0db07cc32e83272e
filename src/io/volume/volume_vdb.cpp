// Finding the module that reads and writes .vdb.

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <vector>

#include "base/platform/shared_library.h"
#include "io/volume/vdb_module.h"
#include "io/volume/volume_formats.h"
#include "littoral/error.h"

namespace littoral::io {

namespace {

namespace fs = std::filesystem;
constexpr const char* file_name = "littoral_vdb.so";

/// Beside the program, one folder up (a build's tests), or where it is installed.
const VdbModule* find_module() {
  std::vector<fs::path> places;
  if (const fs::path folder = own_folder(); !folder.empty())
    places = {folder, folder.parent_path(),
              (folder / LITTORAL_MODULES_FROM_PROGRAM).lexically_normal(), folder / "littoral"};
#ifdef LITTORAL_MODULES
  places.emplace_back(LITTORAL_MODULES);
#endif
  for (const fs::path& place : places) {
    std::error_code none;
    const fs::path file = place / file_name;
    if (!fs::exists(file, none)) continue;
    const auto entry =
        reinterpret_cast<const VdbModule* (*)()>(symbol_of_library(file, vdb_module_symbol));
    if (entry == nullptr) continue;
    const VdbModule* found = entry();
    if (std::string(found->version) == LITTORAL_VERSION) return found;
  }
  return nullptr;
}

const VdbModule* module() {
  static const VdbModule* const found = find_module();
  return found;
}

}  // namespace

bool has_openvdb() { return module() != nullptr; }

Volume read_vdb(std::string_view bytes, const std::string& name, const std::string& field) {
  // A sparse grid may stand for many more nodes than it holds.
  constexpr double each = 1000, always = 1e8;
  std::istringstream in{std::string(bytes)};
  Volume volume;
  const std::string error =
      module()->read(in, field, std::max(always, each * static_cast<double>(bytes.size())), volume);
  if (!error.empty()) throw InputError(name + ": " + error, "bad-file");
  check_box(volume.grid, name);
  return volume;
}

void write_vdb(std::ostream& out, const Volume& volume, const VolumeWriteOptions& options) {
  if (module() == nullptr)
    throw UnsupportedError(std::string("there is no module ") + file_name +
                               " beside the program; it is built where OpenVDB is",
                           "unsupported-file");
  const std::string error = module()->write(out, volume, options.band);
  if (!error.empty()) throw IoError("OpenVDB: " + error);
}

}  // namespace littoral::io
