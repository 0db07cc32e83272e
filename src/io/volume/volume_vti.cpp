// VTK's XML image data, one piece.

#include <map>

#include "base/option_table.h"
#include "io/binary.h"
#include "io/surface/surface_writers.h"
#include "io/text_scan.h"
#include "io/volume/volume_formats.h"
#include "littoral/error.h"

namespace littoral::io {

namespace {

struct Tag {
  std::string name;  // "/Piece" where it closes
  std::map<std::string, std::string> attributes;
  std::size_t end = 0;  // first byte after it
  bool empty = false;   // "/>"
};

std::string plain_text(std::string_view text) {
  static const std::pair<std::string_view, char> entities[] = {
      {"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&apos;", '\''}};
  std::string plain;
  while (!text.empty()) {
    bool found = false;
    for (const auto& [entity, c] : entities) {
      if (text.substr(0, entity.size()) != entity) continue;
      plain += c;
      text.remove_prefix(entity.size());
      found = true;
      break;
    }
    if (found) continue;
    plain += text.front();
    text.remove_prefix(1);
  }
  return plain;
}

bool is_space(char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; }

class VtiReader {
 public:
  VtiReader(std::string_view bytes, const std::string& name, const std::string& wanted)
      : bytes_(bytes), name_(name), wanted_(wanted) {}

  Volume read() {
    read_structure();
    const Array& array = chosen();
    Volume volume;
    volume.name = array.name;
    volume.grid = grid_;
    volume.values = values_of(array);
    return volume;
  }

 private:
  struct Array {
    std::string name, type, format;
    std::size_t content = 0;  // where inline numbers begin
    std::size_t offset = 0;   // of appended ones
  };

  [[noreturn]] void fail(const std::string& why) const {
    throw InputError(name_ + ": " + why, "bad-file");
  }
  [[noreturn]] void refuse(const std::string& what) const {
    throw UnsupportedError(name_ + ": " + what, "unsupported-file");
  }
  // The next tag from `at` on; comments, declarations and text are passed over.
  bool next_tag(std::size_t at, Tag& tag) const {
    for (;;) {
      at = bytes_.find('<', at);
      if (at == std::string_view::npos) return false;
      if (bytes_.substr(at, 4) == "<!--") {
        at = bytes_.find("-->", at);
        if (at == std::string_view::npos) return false;
      } else if (bytes_.substr(at, 2) == "<?" || bytes_.substr(at, 2) == "<!") {
        at = bytes_.find('>', at);
        if (at == std::string_view::npos) return false;
      } else {
        break;
      }
    }
    tag = {};
    const auto peek = [&] { return at < bytes_.size() ? bytes_[at] : '>'; };
    for (++at; peek() != '>' && !is_space(peek()) && !(peek() == '/' && !tag.name.empty()); ++at)
      tag.name += peek();
    for (;;) {
      while (is_space(peek())) ++at;
      if (at >= bytes_.size()) fail("the XML ends within a tag");
      if (peek() == '>') break;
      if (peek() == '/') {
        tag.empty = true;
        ++at;
        continue;
      }
      const std::size_t equals = bytes_.find('=', at);
      if (equals == std::string_view::npos) fail("an XML attribute has no value");
      std::string key(bytes_.substr(at, equals - at));
      while (!key.empty() && is_space(key.back())) key.pop_back();
      at = equals + 1;
      while (is_space(peek())) ++at;
      const char quote = peek();
      const std::size_t close = bytes_.find(quote, at + 1);
      if ((quote != '"' && quote != '\'') || close == std::string_view::npos)
        fail("an XML attribute has no quotes");
      tag.attributes[key] = plain_text(bytes_.substr(at + 1, close - at - 1));
      at = close + 1;
    }
    tag.end = at + 1;
    return true;
  }

  static std::string attribute(const Tag& tag, const std::string& key,
                               const std::string& fallback) {
    const auto found = tag.attributes.find(key);
    return found == tag.attributes.end() ? fallback : found->second;
  }

  template <std::size_t count>
  std::array<double, count> numbers(const Tag& tag, const std::string& key,
                                    const std::string& fallback) const {
    const std::string text = attribute(tag, key, fallback);
    LineScanner words(text, name_, '\0');
    std::array<double, count> out{};
    bool good = words.next();
    for (double& value : out) {
      std::string_view word = good ? words.word() : std::string_view();
      if (good && word.empty() && (good = words.next())) word = words.word();
      const auto number = parse_double(word);
      if (!number) fail("the attribute " + key + " needs " + std::to_string(count) + " numbers");
      value = *number;
    }
    return out;
  }

  void read_structure() {
    Tag tag;
    bool in_points = false, seen_file = false;
    for (std::size_t at = 0; next_tag(at, tag); at = tag.end) {
      if (tag.name == "VTKFile") {
        seen_file = true;
        read_file_tag(tag);
      } else if (tag.name == "ImageData") {
        read_image_tag(tag);
      } else if (tag.name == "Piece") {
        if (++pieces_ > 1) refuse("only one piece is read");
        if (numbers<6>(tag, "Extent", extent_text_) != extent_)
          refuse("a piece that is not the whole grid");
      } else if (tag.name == "PointData") {
        in_points = !tag.empty;
      } else if (tag.name == "/PointData") {
        in_points = false;
      } else if (tag.name == "DataArray" && in_points) {
        add_array(tag);
      } else if (tag.name == "AppendedData") {
        raw_ = attribute(tag, "encoding", "base64") == "raw";
        appended_ = bytes_.find('_', tag.end);
        if (appended_ == std::string_view::npos) fail("the appended data do not begin with '_'");
        ++appended_;
        break;
      }
      if (!seen_file) fail("the file does not begin with the element VTKFile");
    }
    if (pieces_ == 0) fail("there is no ImageData with a piece");
  }

  void read_file_tag(const Tag& tag) {
    if (attribute(tag, "type", "") != "ImageData")
      refuse("VTK data of type " + in_quotes(attribute(tag, "type", "")) + "; ImageData is read");
    order_ = attribute(tag, "byte_order", "LittleEndian") == "BigEndian" ? std::endian::big
                                                                         : std::endian::little;
    header_size_ = attribute(tag, "header_type", "UInt32") == "UInt64" ? 8 : 4;
    const std::string compressor = attribute(tag, "compressor", "");
    compressed_ = compressor == "vtkZLibDataCompressor";
    if (!compressed_ && !compressor.empty())
      refuse("compressor " + in_quotes(compressor) + "; zlib is read");
  }

  void read_image_tag(const Tag& tag) {
    extent_text_ = attribute(tag, "WholeExtent", "");
    extent_ = numbers<6>(tag, "WholeExtent", "");
    const auto origin = numbers<3>(tag, "Origin", "0 0 0");
    const auto spacing = numbers<3>(tag, "Spacing", "1 1 1");
    const std::array<double, 9> straight{1, 0, 0, 0, 1, 0, 0, 0, 1};
    if (numbers<9>(tag, "Direction", "1 0 0 0 1 0 0 0 1") != straight)
      refuse("a grid whose axes do not run along x, y and z");
    std::array<std::int64_t, 3> n{};
    for (int k = 0; k < 3; ++k) {
      const double first = extent_[2 * k], last = extent_[2 * k + 1];
      if (!(std::abs(first) < 1e9 && std::abs(last) < 1e9)) fail("WholeExtent is out of range");
      n[k] = static_cast<std::int64_t>(last) - static_cast<std::int64_t>(first) + 1;
      grid_.spacing[k] = spacing[k];
      grid_.origin[k] = origin[k] + first * spacing[k];
    }
    nodes_ = checked_nodes(n, std::uint64_t{1040} * (bytes_.size() + 1), name_);
    for (int k = 0; k < 3; ++k) grid_.n[k] = static_cast<int>(n[k]);
    check_box(grid_, name_);
  }

  void add_array(const Tag& tag) {
    const std::string components = attribute(tag, "NumberOfComponents", "1");
    if (components != "1") return;
    Array array{attribute(tag, "Name", "values"), attribute(tag, "type", ""),
                attribute(tag, "format", "ascii"), tag.end, 0};
    if (array.format == "appended") {
      const auto offset = parse_integer(attribute(tag, "offset", ""));
      if (!offset || *offset < 0) fail("an appended array has no offset");
      array.offset = static_cast<std::size_t>(std::min<std::int64_t>(*offset, bytes_.size()));
    } else if (tag.empty) {
      fail("the array " + in_quotes(array.name) + " is empty");
    }
    arrays_.push_back(std::move(array));
  }

  const Array& chosen() const {
    for (const Array& array : arrays_)
      if (!wanted_.empty() && array.name == wanted_) return array;
    const std::string known = listed(arrays_, &Array::name);
    if (!wanted_.empty())
      fail("there is no field " + in_quotes(wanted_) +
           "; it has: " + (known.empty() ? "none" : known));
    for (const Array& array : arrays_)
      if (array.name == "distance") return array;
    if (arrays_.empty()) fail("there is no field with one value per node");
    if (arrays_.size() > 1) fail("it has the fields " + known + ": choose one with option field");
    return arrays_.front();
  }

  NumberKind number_kind(const std::string& type) const {
    for (const char* family : {"Float", "Int", "UInt"})
      for (const char* bits : {"8", "16", "32", "64"}) {
        if (type != std::string(family) + bits) continue;
        const NumberKind kind{family[0] == 'F'   ? 'f'
                              : family[0] == 'I' ? 'i'
                                                 : 'u',
                              static_cast<std::size_t>(std::stoi(bits) / 8)};
        if (kind.family != 'f' || kind.size >= 4) return kind;
      }
    fail("unknown number type " + in_quotes(type));
  }

  VecX values_of(const Array& array) const {
    const NumberKind kind = number_kind(array.type);
    std::string_view stored;
    bool is_raw = false;
    if (array.format == "appended") {
      if (appended_ == 0 || array.offset >= bytes_.size() - appended_)
        fail("the data of " + in_quotes(array.name) + " begin after the end of the file");
      stored = bytes_.substr(appended_ + array.offset);
      is_raw = raw_;
    } else {
      stored = bytes_.substr(array.content);
      stored = stored.substr(0, stored.find('<'));
      if (array.format == "ascii") return ascii_values(stored);
      if (array.format != "binary") fail("unknown format " + in_quotes(array.format));
    }
    const std::string data = compressed_ ? packed_block(stored, is_raw, nodes_ * kind.size)
                                         : block(stored, is_raw, nodes_ * kind.size);
    return load_numbers(data, kind, nodes_, order_);
  }

  VecX ascii_values(std::string_view text) const {
    if (nodes_ > text.size()) fail("there are fewer numbers than nodes");
    LineScanner scan(text, name_, '\0');
    VecX values(static_cast<Eigen::Index>(nodes_));
    for (double& value : values) {
      std::string_view word = scan.word();
      while (word.empty()) {
        if (!scan.next()) fail("there are fewer numbers than nodes");
        word = scan.word();
      }
      const auto number = parse_double(word);
      if (!number) fail(in_quotes(word) + " is not a number");
      value = *number;
    }
    return values;
  }

  std::size_t header_number(std::string_view bytes, std::size_t i) const {
    if (bytes.size() / header_size_ <= i) fail("the data are cut short");
    return load_size(bytes.substr(i * header_size_, header_size_), order_);
  }

  std::string text_bytes(std::string_view text, std::size_t& used) const {
    const auto bytes = decode_base64(text, used);
    if (!bytes) fail("the data are not base64");
    return *bytes;
  }

  // Length in bytes, then the data.
  std::string block(std::string_view stored, bool is_raw, std::size_t size) const {
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
      fail("the data have " + std::to_string(header_number(stored, 0)) + " bytes, the grid needs " +
           std::to_string(size));
    if (stored.size() - header_size_ < size) fail("the data are cut short");
    return std::string(stored.substr(header_size_, size));
  }

  // Number of blocks, size of each but the last, size of the last (0: as the others), packed sizes;
  // then the packed blocks, in base64 a text of its own.
  std::string packed_block(std::string_view stored, bool is_raw, std::size_t size) const {
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
    if (out.size() != size) fail("the data do not fill the grid");
    return out;
  }

  std::string_view bytes_;
  std::string name_, wanted_;
  std::endian order_ = std::endian::little;
  std::size_t header_size_ = 4;
  bool compressed_ = false, raw_ = false;
  std::string extent_text_;
  std::array<double, 6> extent_{};
  Grid grid_;
  std::size_t nodes_ = 0, appended_ = 0;  // appended_: first byte after '_'
  int pieces_ = 0;
  std::vector<Array> arrays_;
};

}  // namespace

Volume read_vti(std::string_view bytes, const std::string& name, const std::string& field) {
  return VtiReader(bytes, name, field).read();
}

void write_vti(std::ostream& out, const Volume& volume, const VolumeWriteOptions& options) {
  const Grid& g = volume.grid;
  std::string extent;
  for (int k = 0; k < 3; ++k) extent += (k ? " 0 " : "0 ") + std::to_string(g.n[k] - 1);
  const auto triple = [](const Vec3& v) {
    return exact_text(v[0]) + " " + exact_text(v[1]) + " " + exact_text(v[2]);
  };
  out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"1.0\" "
         "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<ImageData WholeExtent=\""
      << extent << "\" Origin=\"" << triple(g.origin) << "\" Spacing=\"" << triple(g.spacing)
      << "\">\n<Piece Extent=\"" << extent << "\">\n<PointData Scalars=\"" << xml_text(volume.name)
      << "\">\n";
  const std::uint64_t bytes = 8 * g.n_nodes();
  for (std::size_t f = 0; f <= options.more.size(); ++f)
    out << "<DataArray type=\"Float64\" Name=\""
        << xml_text(f == 0 ? volume.name : options.more[f - 1].first)
        << "\" NumberOfComponents=\"1\" format=\"appended\" offset=\"" << f * (8 + bytes)
        << "\"/>\n";
  out << "</PointData>\n</Piece>\n</ImageData>\n<AppendedData encoding=\"raw\">\n_";
  for (std::size_t f = 0; f <= options.more.size(); ++f) {
    store_little(out, bytes);
    store_numbers(out, f == 0 ? volume.values : options.more[f - 1].second);
  }
  out << "\n</AppendedData>\n</VTKFile>\n";
}

}  // namespace littoral::io
