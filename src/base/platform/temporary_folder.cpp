#include "base/platform/temporary_folder.h"

#include <cerrno>
#include <cstdlib>
#include <system_error>

#include "littoral/error.h"

namespace littoral {

TemporaryFolder::TemporaryFolder(const std::string& name) {
  std::error_code error;
  std::filesystem::path base = std::filesystem::temp_directory_path(error);
  if (error) base = "/tmp";
  std::string path = (base / (name + "-XXXXXX")).string();
  if (::mkdtemp(path.data()) == nullptr)
    throw IoError(
        "cannot make a folder in " + base.string() + ": " + std::generic_category().message(errno),
        "cannot-write");
  path_ = path;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace littoral
