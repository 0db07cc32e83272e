#pragma once
// A file that several threads write to, or read from.

#include <cstddef>

namespace littoral {

/// A file open at any place of it.
class FilePlaces {
 public:
  enum class For { reading, writing };
  /// A file that exists; is_open says whether it could be opened.
  FilePlaces(const char* path, For use) noexcept;
  ~FilePlaces();
  FilePlaces(const FilePlaces&) = delete;
  FilePlaces& operator=(const FilePlaces&) = delete;

  bool is_open() const { return file_ >= 0; }
  /// 0, or the number of the error where not all was written.
  int write(const char* bytes, std::size_t n, long long place) noexcept;
  /// How many bytes were read: fewer than n where the file ends before, or after an error, whose
  /// number that is.
  std::size_t read(char* bytes, std::size_t n, long long place, int& error) noexcept;

 private:
  int file_;
};

}  // namespace littoral
