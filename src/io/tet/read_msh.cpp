// Gmsh's files, versions 2 and 4, text or binary (Gmsh Reference Manual, "MSH file format").

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "base/index.h"
#include "base/option_table.h"
#include "io/binary.h"
#include "io/tet/cell_mesh.h"
#include "io/tet/tet_formats.h"
#include "littoral/error.h"

namespace littoral::io {

namespace {

/// Numbers as words or as bytes, between lines that begin with '$'.
class MshScanner {
 public:
  MshScanner(std::string_view bytes, std::string name) : bytes_(bytes), name_(std::move(name)) {}

  bool binary = false;
  std::endian order = std::endian::little;

  [[noreturn]] void fail(const std::string& text) const {
    throw InputError(name_ +
                         (binary ? ": byte " + std::to_string(at_) : ":" + std::to_string(line_)) +
                         ": " + text,
                     "bad-file");
  }
  [[noreturn]] void unsupported(const std::string& text) const {
    throw UnsupportedError(name_ + ": " + text, "unsupported-file");
  }

  /// A word of text, also in binary files, where headers are text.
  std::string_view word() {
    while (at_ < bytes_.size() && is_gap(bytes_[at_])) {
      if (bytes_[at_] == '\n') ++line_;
      ++at_;
    }
    const std::size_t begin = at_;
    while (at_ < bytes_.size() && !is_gap(bytes_[at_])) ++at_;
    return bytes_.substr(begin, at_ - begin);
  }
  /// The rest of the line, of which bytes begin after.
  void end_line() {
    const std::size_t end = bytes_.find('\n', at_);
    at_ = end == std::string_view::npos ? bytes_.size() : end + 1;
    ++line_;
  }
  /// A text between quotes, on a line of its own.
  std::string line_of_text() {
    const std::size_t begin = at_;
    end_line();
    std::string text(bytes_.substr(begin, at_ - begin));
    std::erase_if(text, [](char c) { return c == '"' || c == '\n' || c == '\r'; });
    return text;
  }
  /// Passes a section over.
  void skip_to(const std::string& word) {
    const std::size_t found = bytes_.find(word, at_);
    if (found == std::string_view::npos) fail("the file ends before " + word);
    line_ += std::size_t(std::count(bytes_.begin() + static_cast<std::ptrdiff_t>(at_),
                                    bytes_.begin() + static_cast<std::ptrdiff_t>(found), '\n'));
    at_ = found + word.size();
  }

  double text_number(const char* what) {
    const std::string_view text = word();
    const auto value = parse_double(text);
    if (!value)
      fail("expected " + std::string(what) + ", found " +
           (text.empty() ? "the end of the file" : in_quotes(text)));
    return *value;
  }
  std::int64_t text_integer(const char* what) {
    const std::string_view text = word();
    const auto value = parse_integer(text);
    if (!value)
      fail("expected " + std::string(what) + ", found " +
           (text.empty() ? "the end of the file" : in_quotes(text)));
    return *value;
  }
  double number(const char* what) { return binary ? stored<double>(what) : text_number(what); }
  /// Of four bytes where they are binary.
  std::int64_t integer(const char* what) {
    return binary ? stored<std::int32_t>(what) : text_integer(what);
  }
  /// Of eight bytes.
  std::int64_t long_integer(const char* what) {
    return binary ? stored<std::int64_t>(what) : text_integer(what);
  }
  /// A number as a count of things of which each takes `least` bytes.
  std::int64_t checked(std::int64_t n, const char* what, std::size_t least) const {
    if (n < 0) fail("negative number of " + std::string(what));
    if (static_cast<std::uint64_t>(n) > (bytes_.size() - at_) / least + 1 ||
        n > std::numeric_limits<int>::max())
      fail("the file promises " + std::to_string(n) + " " + what + ", it has " +
           std::to_string(bytes_.size()) + " bytes");
    return n;
  }

 private:
  static bool is_gap(char c) { return is_blank(c) || c == '\n' || c == '\r'; }

  template <class T>
  T stored(const char* what) {
    if (bytes_.size() - at_ < sizeof(T)) fail("the file ends within " + std::string(what));
    at_ += sizeof(T);
    return load<T>(bytes_.data() + at_ - sizeof(T), order);
  }

  std::string_view bytes_;
  std::string name_;
  std::size_t at_ = 0, line_ = 1;
};

/// Types of elements: corners, and what VTK calls them.
struct MshType {
  int corners, kind;
};
constexpr std::array<MshType, 8> msh_types{{{0, -1},
                                            {2, 3},
                                            {3, CellMesh::triangle},
                                            {4, CellMesh::quad},
                                            {4, CellMesh::tet},
                                            {8, CellMesh::hexahedron},
                                            {6, CellMesh::prism},
                                            {5, CellMesh::pyramid}}};

class MshReader {
 public:
  MshReader(std::string_view bytes, const std::string& name) : scan_(bytes, name) {
    cells_.name = name;
  }

  CellMesh read() {
    read_format();
    for (std::string_view word = scan_.word(); !word.empty(); word = scan_.word()) {
      const std::string section(word);
      if (section.front() != '$' || section.starts_with("$End"))
        scan_.fail("expected the begin of a section, found " + in_quotes(section));
      const std::string end = "$End" + section.substr(1);
      if (section == "$Nodes" || section == "$Elements" || section == "$NodeData") {
        scan_.end_line();
        if (section == "$Nodes") read_nodes();
        if (section == "$Elements") read_elements();
        if (section == "$NodeData") read_values();
        if (scan_.word() != end) scan_.fail("expected " + end);
      } else {
        scan_.skip_to(end);
      }
    }
    if (coordinates_.empty()) throw InputError(cells_.name + ": no vertices", "bad-file");
    return std::move(cells_);
  }

 private:
  void read_format() {
    if (scan_.word() != "$MeshFormat") scan_.fail("expected $MeshFormat");
    const double version = scan_.text_number("the version");
    const std::int64_t type = scan_.text_integer("the type of the file"),
                       size = scan_.text_integer("the size of numbers");
    four_ = version >= 4;
    tags_first_ = version >= 4.1;
    if (!((version >= 2 && version < 3) || (version >= 4 && version < 5)))
      scan_.unsupported("Gmsh's format of version " + number_text(version) + "; 2 and 4 are read");
    if (type != 0 && type != 1) scan_.fail("the type of the file must be 0 or 1");
    if (type == 1) {
      if (size != 8) scan_.unsupported("numbers of " + std::to_string(size) + " bytes; 8 are read");
      scan_.end_line();
      scan_.binary = true;
      const std::int64_t one = scan_.integer("the number one");
      if (one == 1 << 24) scan_.order = std::endian::big;
      if (one != 1 && one != 1 << 24) scan_.fail("the number one is not there");
    }
    if (scan_.word() != "$EndMeshFormat") scan_.fail("expected $EndMeshFormat");
  }

  void add_node(std::int64_t tag) {
    const auto number = static_cast<int>(places_.size());
    if (!places_.emplace(tag, number).second)
      scan_.fail("node " + std::to_string(tag) + " appears twice");
  }
  void add_point() {
    for (int k = 0; k < 3; ++k) coordinates_.push_back(scan_.number("a coordinate of a node"));
  }

  void read_nodes() {
    if (!coordinates_.empty()) scan_.fail("a second section $Nodes");
    if (!four_) {
      const std::int64_t n = scan_.checked(scan_.text_integer("the number of nodes"), "nodes", 8);
      scan_.end_line();
      for (std::int64_t i = 0; i < n; ++i) {
        add_node(scan_.integer("the number of a node"));
        add_point();
      }
    } else {
      const std::int64_t blocks =
          scan_.checked(scan_.long_integer("the number of blocks"), "blocks", 8);
      scan_.long_integer("the number of nodes");
      if (tags_first_)
        for (int k = 0; k < 2; ++k) scan_.long_integer("the range of nodes");
      for (std::int64_t b = 0; b < blocks; ++b) read_node_block();
    }
    cells_.points = Eigen::Map<const MatX3>(coordinates_.data(), index(coordinates_.size() / 3), 3);
  }

  void read_node_block() {
    // Dimension and number of the entity, in 4.0 the other way round.
    std::array<std::int64_t, 2> entity{};
    for (std::int64_t& number : entity) number = scan_.integer("the entity of a block");
    const std::int64_t parametric = scan_.integer("whether nodes are parametric");
    const std::int64_t n = scan_.checked(scan_.long_integer("the number of nodes"), "nodes", 6);
    const std::int64_t more = parametric != 0 ? std::clamp<std::int64_t>(entity[0], 0, 3) : 0;
    if (!tags_first_ && parametric != 0) scan_.unsupported("parametric nodes of version 4.0");
    if (tags_first_)
      for (std::int64_t i = 0; i < n; ++i) add_node(scan_.long_integer("the number of a node"));
    for (std::int64_t i = 0; i < n; ++i) {
      if (!tags_first_) add_node(scan_.integer("the number of a node"));
      add_point();
      for (std::int64_t k = 0; k < more; ++k) scan_.number("a parameter of a node");
    }
  }

  MshType type_of(std::int64_t type) const {
    if (type == 15) return {1, 1};  // a point
    if (type > 0 && type < static_cast<std::int64_t>(msh_types.size())) return msh_types[type];
    scan_.unsupported("elements of type " + std::to_string(type) +
                      "; triangles, quads, tets, hexahedra, prisms and pyramids of first order are "
                      "read (Mesh.ElementOrder = 1)");
  }

  void read_element(const MshType& type, std::int64_t number, bool long_tags) {
    held_.clear();
    for (int k = 0; k < type.corners; ++k) {
      const std::int64_t tag =
          long_tags ? scan_.long_integer("a corner") : scan_.integer("a corner");
      const auto found = places_.find(tag);
      if (found == places_.end())
        scan_.fail("element " + std::to_string(number) + " refers to node " + std::to_string(tag) +
                   ", which is not there");
      held_.push_back(found->second);
    }
    cells_.add(std::size_t(number), type.kind, held_);
  }

  void read_elements() {
    if (four_) return read_element_blocks();
    const std::int64_t n =
        scan_.checked(scan_.text_integer("the number of elements"), "elements", 6);
    scan_.end_line();
    for (std::int64_t read = 0; read < n;) {
      std::int64_t number = scan_.binary ? 0 : scan_.integer("the number of an element");
      const MshType type = type_of(scan_.integer("the type of an element"));
      // Binary: a head for several elements of one type.
      const std::int64_t alike = scan_.binary ? scan_.integer("the number of elements") : 1;
      const std::int64_t tags = scan_.checked(scan_.integer("the number of tags"), "tags", 1);
      if (alike < 1 || alike > n - read)
        scan_.fail("a block of " + std::to_string(alike) + " elements, the file promises " +
                   std::to_string(n) + " in all");
      for (std::int64_t i = 0; i < alike; ++i, ++read) {
        if (scan_.binary) number = scan_.integer("the number of an element");
        for (std::int64_t k = 0; k < tags; ++k) scan_.integer("a tag of an element");
        read_element(type, number, false);
      }
    }
  }

  void read_element_blocks() {
    const std::int64_t blocks =
        scan_.checked(scan_.long_integer("the number of blocks"), "blocks", 8);
    scan_.long_integer("the number of elements");
    if (tags_first_)
      for (int k = 0; k < 2; ++k) scan_.long_integer("the range of elements");
    for (std::int64_t b = 0; b < blocks; ++b) {
      for (int k = 0; k < 2; ++k) scan_.integer("the entity of a block");
      const MshType type = type_of(scan_.integer("the type of elements"));
      const std::int64_t n =
          scan_.checked(scan_.long_integer("the number of elements"), "elements", 4);
      for (std::int64_t i = 0; i < n; ++i) {
        const std::int64_t number = tags_first_ ? scan_.long_integer("the number of an element")
                                                : scan_.integer("the number of an element");
        read_element(type, number, tags_first_);
      }
    }
  }

  // Texts (the name first), numbers, whole numbers (step, components, count); then node and values.
  void read_values() {
    const std::int64_t texts = scan_.checked(scan_.text_integer("the number of texts"), "texts", 1);
    scan_.end_line();
    std::string name;
    for (std::int64_t i = 0; i < texts; ++i) {
      const std::string text = scan_.line_of_text();
      if (i == 0) name = text;
    }
    const std::int64_t reals =
        scan_.checked(scan_.text_integer("the number of numbers"), "numbers", 2);
    for (std::int64_t i = 0; i < reals; ++i) scan_.text_number("a number");
    const std::int64_t whole =
        scan_.checked(scan_.text_integer("the number of whole numbers"), "numbers", 2);
    std::int64_t components = 1, n = 0;
    for (std::int64_t i = 0; i < whole; ++i) {
      const std::int64_t value = scan_.text_integer("a whole number");
      if (i == 1) components = value;
      if (i == 2) n = value;
    }
    scan_.end_line();
    if (components < 1 || components > 9)
      scan_.fail("values of " + std::to_string(components) + " components");
    scan_.checked(n, "values", 4);
    VecX values = VecX::Constant(cells_.points.rows(), std::numeric_limits<double>::quiet_NaN());
    for (std::int64_t i = 0; i < n; ++i) {
      const std::int64_t node = scan_.integer("the node of a value");
      double value = 0;
      for (std::int64_t k = 0; k < components; ++k) value = scan_.number("a value");
      const auto found = places_.find(node);
      if (found == places_.end())
        scan_.fail("a value at node " + std::to_string(node) + ", which is not there");
      values[found->second] = value;
    }
    // Values that some nodes lack are those of a part, and no field.
    if (components == 1 && !values.hasNaN()) cells_.scalars[name] = values;
  }

  MshScanner scan_;
  CellMesh cells_;
  bool four_ = false, tags_first_ = false;
  std::unordered_map<std::int64_t, int> places_;  // of nodes, by their numbers in the file
  std::vector<double> coordinates_;
  std::vector<int> held_;
};

}  // namespace

CellMesh read_msh(std::string_view bytes, const std::string& name) {
  return MshReader(bytes, name).read();
}

}  // namespace littoral::io
