#include "base/platform/shared_library.h"

#include <dlfcn.h>

#include <system_error>

namespace littoral {

namespace fs = std::filesystem;

fs::path own_folder() {
  std::error_code none;
  Dl_info info{};
  static const int here = 0;
  if (dladdr(&here, &info) == 0 || info.dli_fname == nullptr) return {};
  // Of the program itself, the loader knows no more than how it was called.
  fs::path object = fs::canonical(info.dli_fname, none);
  const fs::path program = fs::read_symlink("/proc/self/exe", none);
  if (object.empty() || object.filename() == program.filename()) object = program;
  return object.parent_path();
}

void* symbol_of_library(const fs::path& library, const std::string& symbol) {
  void* loaded = dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
  return loaded == nullptr ? nullptr : dlsym(loaded, symbol.c_str());
}

void* loaded_symbol(const std::string& symbol) { return dlsym(RTLD_DEFAULT, symbol.c_str()); }

}  // namespace littoral
