// Nearly raw raster data (Teem): a text header, an empty line, numbers.

#include <cmath>
#include <limits>
#include <map>

#include "base/index.h"
#include "io/surface/surface_writers.h"
#include "io/text_scan.h"
#include "io/volume/volume_formats.h"
#include "littoral/error.h"

namespace littoral::io {

namespace {

class NrrdReader {
 public:
  NrrdReader(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  Volume read() {
    read_header();
    if (fields_.count("data file") + fields_.count("datafile") != 0)
      throw UnsupportedError(name_ + ": the data are in another file; only attached data are read",
                             "unsupported-file");
    for (const char* skip : {"line skip", "lineskip", "byte skip", "byteskip"}) {
      if (fields_.count(skip) != 0 && fields_[skip] != "0")
        throw UnsupportedError(name_ + ": '" + skip + "' is not supported", "unsupported-file");
    }
    if (need("dimension") != "3")
      throw UnsupportedError(
          name_ + ": the data have " + in_quotes(need("dimension")) + " axes; three are read",
          "unsupported-file");
    check_kinds();
    std::array<std::int64_t, 3> n{};
    Words sizes(need("sizes"));
    for (auto& k : n) {
      const auto size = parse_integer(sizes.next());
      if (!size) fail("'sizes' needs three whole numbers");
      k = *size;
    }
    Volume volume;
    volume.values = read_values(n);
    for (int k = 0; k < 3; ++k) volume.grid.n[k] = static_cast<int>(n[k]);
    read_box(volume.grid);
    check_box(volume.grid, name_);
    if (fields_.count("content") != 0 && !fields_["content"].empty())
      volume.name = fields_["content"];
    return volume;
  }

 private:
  /// Axes along which there are colours or vectors, not nodes, are no axes of a volume.
  void check_kinds() const {
    const auto found = fields_.find("kinds");
    if (found == fields_.end()) return;
    Words kinds(found->second);
    for (std::string_view kind = kinds.next(); !kind.empty(); kind = kinds.next()) {
      const std::string lower = lower_case(std::string(kind));
      if (lower != "domain" && lower != "space" && lower != "none" && lower != "???")
        throw UnsupportedError(name_ + ": along one axis lies " + in_quotes(kind) +
                                   "; volumes of one number at each node are read",
                               "unsupported-file");
    }
  }

  // Words between blanks.
  class Words {
   public:
    explicit Words(std::string_view text) : text_(text) {}
    std::string_view next() {
      while (!text_.empty() && is_blank(text_.front())) text_.remove_prefix(1);
      std::size_t end = 0;
      while (end < text_.size() && !is_blank(text_[end])) ++end;
      const std::string_view word = text_.substr(0, end);
      text_.remove_prefix(end);
      return word;
    }

   private:
    std::string_view text_;
  };

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(name_ + ": " + what, "bad-file");
  }

  const std::string& need(const std::string& key) const {
    const auto found = fields_.find(key);
    if (found == fields_.end()) fail("the header has no '" + key + "'");
    return found->second;
  }

  void read_header() {
    if (bytes_.substr(0, 7) != "NRRD000") fail("the file does not begin with NRRD000");
    for (bool first = true;; first = false) {
      const std::size_t end = bytes_.find('\n', at_);
      if (end == std::string_view::npos) fail("the header has no end");
      std::string_view line = bytes_.substr(at_, end - at_);
      at_ = end + 1;
      if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
      if (line.empty()) return;
      const std::size_t colon = line.find(':');
      if (first || line[0] == '#' || colon == std::string_view::npos) continue;
      if (colon + 1 < line.size() && line[colon + 1] == '=') continue;  // a key of somebody's own
      std::string_view value = line.substr(colon + 1);
      while (!value.empty() && is_blank(value.front())) value.remove_prefix(1);
      while (!value.empty() && is_blank(value.back())) value.remove_suffix(1);
      const std::string field = lower_case(std::string(line.substr(0, colon)));
      if (!fields_.emplace(field, value).second) fail(in_quotes(field) + " appears twice");
    }
  }

  NumberKind number_kind() const {
    static const std::map<std::string, NumberKind> kinds = [] {
      std::map<std::string, NumberKind> all{{"float", {'f', 4}}, {"double", {'f', 8}}};
      const auto add = [&](NumberKind kind, std::initializer_list<const char*> names) {
        for (const char* n : names) all[n] = kind;
      };
      add({'i', 1}, {"signed char", "int8", "int8_t"});
      add({'u', 1}, {"uchar", "unsigned char", "uint8", "uint8_t"});
      add({'i', 2}, {"short", "short int", "signed short", "signed short int", "int16", "int16_t"});
      add({'u', 2}, {"ushort", "unsigned short", "unsigned short int", "uint16", "uint16_t"});
      add({'i', 4}, {"int", "signed int", "int32", "int32_t"});
      add({'u', 4}, {"uint", "unsigned int", "uint32", "uint32_t"});
      add({'i', 8}, {"longlong", "long long", "long long int", "signed long long",
                     "signed long long int", "int64", "int64_t"});
      add({'u', 8},
          {"ulonglong", "unsigned long long", "unsigned long long int", "uint64", "uint64_t"});
      return all;
    }();
    const auto found = kinds.find(lower_case(need("type")));
    if (found == kinds.end()) fail("unknown type " + in_quotes(need("type")));
    return found->second;
  }

  VecX read_values(const std::array<std::int64_t, 3>& n) {
    const NumberKind kind = number_kind();
    const std::string encoding = lower_case(need("encoding"));
    const std::string_view data = bytes_.substr(at_);
    if (encoding == "ascii" || encoding == "text" || encoding == "txt") {
      const std::size_t nodes = checked_nodes(n, data.size(), name_);
      VecX values(index(nodes));
      LineScanner scan(data, name_, '\0', false,
                       1 + std::size_t(std::count(bytes_.begin(), bytes_.begin() + at_, '\n')));
      std::string_view word;
      for (double& value : values) {
        while ((word = scan.word()).empty())
          if (!scan.next()) fail("there are fewer numbers than nodes");
        const auto number = parse_double(word);
        if (!number) scan.fail(in_quotes(word) + " is not a number");
        value = *number;
      }
      return values;
    }
    std::endian order = std::endian::little;
    if (kind.size > 1) {
      const std::string endian = lower_case(need("endian"));
      if (endian != "little" && endian != "big") fail("'endian' must be little or big");
      if (endian == "big") order = std::endian::big;
    }
    if (encoding == "raw")
      return load_numbers(data, kind, checked_nodes(n, data.size() / kind.size, name_), order);
    if (encoding == "gzip" || encoding == "gz") {
      const std::size_t nodes = checked_nodes(n, std::uint64_t{1040} * (data.size() + 1), name_);
      const auto bytes = unpack(data, nodes * kind.size);
      if (!bytes) fail("the compressed data are damaged or not of the size stated");
      return load_numbers(*bytes, kind, nodes, order);
    }
    throw UnsupportedError(
        name_ + ": encoding " + in_quotes(encoding) + "; raw, ascii and gzip are read",
        "unsupported-file");
  }

  // "(1,0,0) (0,1,0)": numbers between brackets and commas.
  std::vector<double> numbers(std::string text, const char* key) const {
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c == '(' || c == ')' || c == ','; }, ' ');
    std::vector<double> out;
    Words words(text);
    for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
      const auto number = parse_double(word);
      if (!number) fail(std::string("'") + key + "' has " + in_quotes(word));
      out.push_back(*number);
    }
    return out;
  }

  /// Of a field that has two names.
  const std::string* either(const char* key, const char* other) const {
    for (const char* name : {key, other})
      if (const auto it = fields_.find(name); it != fields_.end()) return &it->second;
    return nullptr;
  }

  /// Where the axes begin and end: at the middle of the first and last samples, or half a sample
  /// before and after these. NaN is unknown.
  void read_ends(Grid& grid) const {
    const std::string *low = either("axis mins", "axismins"),
                      *high = either("axis maxs", "axismaxs"),
                      *centers = either("centers", "centerings");
    if (!low && !high) return;
    const auto three = [&](const std::string* text, const char* key) {
      std::vector<double> out(3, std::numeric_limits<double>::quiet_NaN());
      if (text) out = numbers(*text, key);
      if (out.size() != 3) fail(std::string("'") + key + "' needs three numbers");
      return out;
    };
    const auto mins = three(low, "axis mins"), maxs = three(high, "axis maxs");
    Words words(centers ? std::string_view(*centers) : std::string_view());
    for (int a = 0; a < 3; ++a) {
      const std::string center = lower_case(std::string(words.next()));
      if (std::isnan(mins[a]) && std::isnan(maxs[a])) continue;
      const bool node = center == "node", cell = center == "cell";
      if (!node && !cell)
        throw UnsupportedError(name_ + ": 'axis mins' and 'axis maxs' without 'centers', which " +
                                   "says for each axis whether they are those of nodes or cells",
                               "unsupported-file");
      const int steps = grid.n[a] - (node ? 1 : 0);
      double& h = grid.spacing[a];
      if (!fields_.contains("spacings") && steps > 0 && !std::isnan(maxs[a] - mins[a]))
        h = (maxs[a] - mins[a]) / steps;
      const double margin = cell ? h / 2 : 0;
      grid.origin[a] =
          std::isnan(mins[a]) ? maxs[a] - margin - h * (grid.n[a] - 1) : mins[a] + margin;
    }
  }

  void read_box(Grid& grid) const {
    if (const auto it = fields_.find("spacings"); it != fields_.end()) {
      const auto spacing = numbers(it->second, "spacings");
      if (spacing.size() != 3) fail("'spacings' needs three numbers");
      grid.spacing = Vec3(spacing[0], spacing[1], spacing[2]);
    }
    read_ends(grid);
    if (const auto it = fields_.find("space directions"); it != fields_.end()) {
      const auto d = numbers(it->second, "space directions");
      if (d.size() != 9) fail("'space directions' needs three vectors of three numbers");
      for (int a = 0; a < 3; ++a) {
        for (int b = 0; b < 3; ++b) {
          if (a == b ? !(d[4 * a] > 0) : d[3 * a + b] != 0)
            throw UnsupportedError(name_ + ": axes that do not run along x, y and z",
                                   "unsupported-file");
        }
        grid.spacing[a] = d[4 * a];
      }
    }
    if (const auto it = fields_.find("space origin"); it != fields_.end()) {
      const auto p = numbers(it->second, "space origin");
      if (p.size() != 3) fail("'space origin' needs three numbers");
      grid.origin = Vec3(p[0], p[1], p[2]);
    }
  }

  std::string_view bytes_;
  std::string name_;
  std::size_t at_ = 0;  // first byte after the header
  std::map<std::string, std::string> fields_;
};

}  // namespace

Volume read_nrrd(std::string_view bytes, const std::string& name, const std::string&) {
  return NrrdReader(bytes, name).read();
}

void write_nrrd(std::ostream& out, const Volume& volume, const VolumeWriteOptions&) {
  const Grid& g = volume.grid;
  const auto triple = [&out](double a, double b, double c) {
    out << '(' << exact_text(a) << ',' << exact_text(b) << ',' << exact_text(c) << ')';
  };
  std::string content = volume.name;
  std::replace_if(
      content.begin(), content.end(), [](unsigned char c) { return c < 32; }, ' ');
  out << "NRRD0004\ncontent: " << content << "\ntype: double\ndimension: 3\nsizes: " << g.n[0]
      << ' ' << g.n[1] << ' ' << g.n[2] << "\nspace dimension: 3\nspace directions: ";
  triple(g.spacing[0], 0, 0);
  out << ' ';
  triple(0, g.spacing[1], 0);
  out << ' ';
  triple(0, 0, g.spacing[2]);
  out << "\nspace origin: ";
  triple(g.origin[0], g.origin[1], g.origin[2]);
  out << "\nendian: little\nencoding: raw\n\n";
  store_numbers(out, volume.values);
}

}  // namespace littoral::io
