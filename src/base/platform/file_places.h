#pragma once
// A file that several threads write to.

#include <cstddef>

namespace littoral {

/// A file open for writing at any place of it.
class FilePlaces {
 public:
  /// A file that exists; is_open says whether it could be opened.
  explicit FilePlaces(const char* path) noexcept;
  ~FilePlaces();
  FilePlaces(const FilePlaces&) = delete;
  FilePlaces& operator=(const FilePlaces&) = delete;

  bool is_open() const { return file_ >= 0; }
  /// 0, or the number of the error where not all was written.
  int write(const char* bytes, std::size_t n, long long place) noexcept;

 private:
  int file_;
};

}  // namespace littoral
