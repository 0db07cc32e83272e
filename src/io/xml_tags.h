#pragma once
// The tags of an XML file, one after the other. Files of VTK may hold raw bytes after their tags,
// which makes them no XML for a library that reads it.

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace littoral::io {

struct XmlTag {
  std::string_view name;  // "/Piece" where it closes
  std::vector<std::pair<std::string_view, std::string_view>> attributes;  // as they stand
  std::size_t end = 0;                                                    // first byte after it
  bool empty = false;                                                     // "/>"

  bool has(std::string_view key) const;
  /// As text, or the fallback.
  std::string attribute(std::string_view key, const std::string& fallback = "") const;
  /// The name without the letters of its namespace: "m:mesh" is "mesh".
  std::string_view local_name() const;
};

class XmlTags {
 public:
  XmlTags(std::string_view bytes, std::string name) : bytes_(bytes), name_(std::move(name)) {}
  /// The next tag from `at` on; comments, declarations and text are passed over. Throws InputError
  /// for a tag that does not end.
  bool next(std::size_t at, XmlTag& tag) const;
  [[noreturn]] void fail(const std::string& what) const;
  std::string_view bytes() const { return bytes_; }
  const std::string& name() const { return name_; }

 private:
  std::string_view bytes_;
  std::string name_;
};

}  // namespace littoral::io
