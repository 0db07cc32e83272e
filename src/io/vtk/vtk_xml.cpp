#include "io/vtk/vtk_xml.h"

#include <algorithm>

#include "base/index.h"
#include "io/contents_hint.h"
#include "io/text_scan.h"
#include "littoral/error.h"

namespace littoral::io {

bool VtkXml::next(std::size_t at, XmlTag& tag) {
  if (!tags_.next(at, tag)) return false;
  if (tag.name != "AppendedData") return true;
  raw_ = tag.attribute("encoding", "base64") == "raw";
  appended_ = bytes().find('_', tag.end);
  if (appended_ == std::string_view::npos) fail("the appended data do not begin with '_'");
  ++appended_;
  return false;
}

void VtkXml::read_file_tag(const XmlTag& tag, const std::string& type) {
  if (const std::string held = tag.attribute("type"); held != type) {
    const std::string hint = contents_hint("<vtkfile type=\"" + held + "\"", "");
    throw UnsupportedError(name() + ": it holds VTK data of type " + in_quotes(held) + ", not " +
                               type + " as its extension says; " +
                               (hint.empty() ? "save it as " + type : hint),
                           "unsupported-file");
  }
  order_ = tag.attribute("byte_order", "LittleEndian") == "BigEndian" ? std::endian::big
                                                                      : std::endian::little;
  header_size_ = tag.attribute("header_type", "UInt32") == "UInt64" ? 8 : 4;
  const std::string compressor = tag.attribute("compressor");
  compressed_ = compressor == "vtkZLibDataCompressor";
  if (!compressed_ && !compressor.empty())
    throw UnsupportedError(name() + ": compressor " + in_quotes(compressor) + "; zlib is read",
                           "unsupported-file");
}

VtkXml::Array VtkXml::array(const XmlTag& tag) const {
  Array array{tag.attribute("Name", "values"),
              tag.attribute("type"),
              tag.attribute("format", "ascii"),
              1,
              tag.end,
              0,
              tag.empty};
  const auto components = parse_integer(tag.attribute("NumberOfComponents", "1"));
  if (!components || *components < 1 || *components > 100)
    fail("the array " + in_quotes(array.name) + " must have 1 to 100 components");
  array.components = static_cast<int>(*components);
  if (array.format == "appended") {
    const auto offset = parse_integer(tag.attribute("offset"));
    if (!offset || *offset < 0) fail("an appended array has no offset");
    array.offset =
        std::size_t(std::min<std::int64_t>(*offset, static_cast<std::int64_t>(bytes().size())));
  }
  return array;
}

NumberKind VtkXml::number_kind(const std::string& type) const {
  for (const char* family : {"Float", "Int", "UInt"}) {
    for (const char* bits : {"8", "16", "32", "64"}) {
      if (type != std::string(family) + bits) continue;
      const NumberKind kind{family[0] == 'F'   ? 'f'
                            : family[0] == 'I' ? 'i'
                                               : 'u',
                            std::size_t(std::stoi(bits) / 8)};
      if (kind.family != 'f' || kind.size >= 4) return kind;
    }
  }
  fail("unknown number type " + in_quotes(type));
}

VecX VtkXml::values(const Array& array, std::size_t count) const {
  const NumberKind kind = number_kind(array.type);
  std::string_view stored;
  bool is_raw = false;
  if (array.empty && array.format != "appended") {
    if (count == 0) return {};
    fail("the array " + in_quotes(array.name) + " is empty");
  }
  if (array.format == "appended") {
    if (appended_ == 0 || array.offset >= bytes().size() - appended_)
      fail("the data of " + in_quotes(array.name) + " begin after the end of the file");
    stored = bytes().substr(appended_ + array.offset);
    is_raw = raw_;
  } else {
    stored = bytes().substr(array.content);
    stored = stored.substr(0, stored.find('<'));
    if (array.format == "ascii") return ascii_values(stored, count);
    if (array.format != "binary") fail("unknown format " + in_quotes(array.format));
  }
  const std::string data = compressed_ ? packed_block(stored, is_raw, count * kind.size)
                                       : block(stored, is_raw, count * kind.size);
  return load_numbers(data, kind, count, order_);
}

VecX VtkXml::ascii_values(std::string_view text, std::size_t count) const {
  if (count > text.size())
    fail("there are fewer numbers than the " + std::to_string(count) + " expected");
  LineScanner scan(text, name(), '\0');
  VecX values(index(count));
  for (double& value : values) {
    std::string_view word = scan.word();
    while (word.empty()) {
      if (!scan.next())
        fail("there are fewer numbers than the " + std::to_string(count) + " expected");
      word = scan.word();
    }
    const auto number = parse_double(word);
    if (!number) fail(in_quotes(word) + " is not a number");
    value = *number;
  }
  return values;
}

std::size_t VtkXml::header_number(std::string_view bytes, std::size_t i) const {
  if (bytes.size() / header_size_ <= i) fail("the data are cut short");
  return load_size(bytes.substr(i * header_size_, header_size_), order_);
}

std::string VtkXml::text_bytes(std::string_view text, std::size_t& used) const {
  const auto bytes = decode_base64(text, used);
  if (!bytes) fail("the data are not base64");
  return *bytes;
}

// Length in bytes, then the data.
std::string VtkXml::block(std::string_view stored, bool is_raw, std::size_t size) const {
  std::size_t used = 0;
  std::string decoded;
  if (!is_raw) {
    const std::string_view text = stored.substr(0, stored.find('<'));
    decoded = text_bytes(text, used);
    std::size_t more = 0;  // some programs write the length as a text of its own
    if (decoded.size() == header_size_) decoded += text_bytes(text.substr(used), more);
    stored = decoded;
  }
  if (header_number(stored, 0) != size)
    fail("the data of an array have " + std::to_string(header_number(stored, 0)) +
         " bytes, they need " + std::to_string(size));
  if (stored.size() - header_size_ < size) fail("the data are cut short");
  return std::string(stored.substr(header_size_, size));
}

// Number of blocks, size of each but the last, size of the last (0: as the others), packed sizes;
// then the packed blocks, in base64 a text of its own.
std::string VtkXml::packed_block(std::string_view stored, bool is_raw, std::size_t size) const {
  std::string head, body;
  std::string_view packed;
  if (is_raw) {
    const std::size_t blocks = header_number(stored, 0);
    if (blocks > stored.size() / header_size_) fail("the data are cut short");
    if (stored.size() / header_size_ < 3 + blocks) fail("the data are cut short");
    head = stored.substr(0, (3 + blocks) * header_size_);
    packed = stored.substr(head.size());
  } else {
    std::size_t used = 0;
    stored = stored.substr(0, stored.find('<'));
    head = text_bytes(stored, used);
    // A header whose length needs no padding runs into the data.
    const std::size_t blocks = header_number(head, 0);
    if (blocks > head.size() / header_size_) fail("the data are cut short");
    if (head.size() > (3 + blocks) * header_size_) {
      body = head.substr((3 + blocks) * header_size_);
    } else {
      std::size_t more = 0;
      body = text_bytes(stored.substr(used), more);
    }
    packed = body;
  }
  const std::size_t blocks = header_number(head, 0), each = header_number(head, 1),
                    last = header_number(head, 2);
  std::string out;
  for (std::size_t b = 0; b < blocks; ++b) {
    const std::size_t length = header_number(head, 3 + b);
    const std::size_t plain = b + 1 == blocks && last != 0 ? last : each;
    if (length > packed.size() || plain > size - out.size()) fail("the data are cut short");
    const auto bytes = unpack(packed.substr(0, length), plain);
    if (!bytes) fail("the compressed data are damaged");
    out += *bytes;
    packed.remove_prefix(length);
  }
  if (out.size() != size) fail("the data do not fill their array");
  return out;
}

}  // namespace littoral::io
