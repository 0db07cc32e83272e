#pragma once
// VTK's XML files (VTK File Formats, "XML File Formats"): data arrays as text, base64 or raw bytes,
// plain or packed by zlib.

#include <bit>
#include <string>
#include <string_view>

#include "io/volume/volume_formats.h"
#include "io/xml_tags.h"

namespace littoral::io {

class VtkXml {
 public:
  struct Array {
    std::string name, type, format;
    int components = 1;
    std::size_t content = 0;  // where inline numbers begin
    std::size_t offset = 0;   // of appended ones
    bool empty = false;       // the element has no content
  };

  VtkXml(std::string_view bytes, const std::string& name) : tags_(bytes, name) {}

  /// The next tag from `at` on, until the appended data begin.
  bool next(std::size_t at, XmlTag& tag);
  /// The element VTKFile. Throws UnsupportedError unless its data are of this type.
  void read_file_tag(const XmlTag& tag, const std::string& type);
  /// The element DataArray.
  Array array(const XmlTag& tag) const;
  /// The numbers of an array, which must be `count`.
  VecX values(const Array& array, std::size_t count) const;

  [[noreturn]] void fail(const std::string& what) const { tags_.fail(what); }
  const std::string& name() const { return tags_.name(); }
  std::size_t size() const { return bytes().size(); }

 private:
  std::string_view bytes() const { return tags_.bytes(); }
  NumberKind number_kind(const std::string& type) const;
  VecX ascii_values(std::string_view text, std::size_t count) const;
  std::size_t header_number(std::string_view bytes, std::size_t i) const;
  std::string text_bytes(std::string_view text, std::size_t& used) const;
  std::string block(std::string_view stored, bool is_raw, std::size_t size) const;
  std::string packed_block(std::string_view stored, bool is_raw, std::size_t size) const;

  XmlTags tags_;
  std::endian order_ = std::endian::little;
  std::size_t header_size_ = 4, appended_ = 0;  // appended_: first byte after '_'
  bool compressed_ = false, raw_ = false;
};

}  // namespace littoral::io
