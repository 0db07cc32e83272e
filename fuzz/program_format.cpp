#include "program_format.h"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string_view>

namespace {

std::string& format() {
  static std::string text;
  return text;
}

}  // namespace

const std::string& program_format() { return format(); }

extern "C" int LLVMFuzzerInitialize(int* /*argc*/, char*** argv) {
  constexpr std::string_view prefix = "fuzz_";
  const std::string name = std::filesystem::path((*argv)[0]).filename().string();
  if (!name.starts_with(prefix)) {
    std::fprintf(stderr, "%s must be called fuzz_FORMAT, as the links beside it\n", name.c_str());
    std::exit(2);
  }
  const std::string format_and_kind = name.substr(prefix.size());  // "npy_cloud" reads .npy
  format() = "." + format_and_kind.substr(0, format_and_kind.find('_'));
  return 0;
}
