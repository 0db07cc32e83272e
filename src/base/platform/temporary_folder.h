#pragma once
// A place for files that are gone afterwards.

#include <filesystem>
#include <string>

namespace littoral {

/// A new folder that nobody else can read, removed with all that is in it.
class TemporaryFolder {
 public:
  /// `name` is what its own begins with. Throws IoError if it cannot be made.
  explicit TemporaryFolder(const std::string& name);
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace littoral
