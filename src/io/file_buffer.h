#pragma once
// The buffer of a file that large arrays are written to.

#include <fstream>
#include <memory>
#include <string>

#include "base/platform/file_places.h"

namespace littoral::io {

/// Of a regular file, which is made or emptied. Much at once is written by several threads, in
/// pieces: a system that has to find memory for what it is given does so for each of them.
class FileBuffer : public std::filebuf {
 public:
  /// is_open says whether the file could be opened; errno why not.
  explicit FileBuffer(std::string path);

 protected:
  std::streamsize xsputn(const char* bytes, std::streamsize n) override;

 private:
  std::string path_;
  std::unique_ptr<FilePlaces> places_;  // opened when there is much
};

}  // namespace littoral::io
