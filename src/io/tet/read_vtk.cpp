// VTK legacy files, text or binary (VTK File Formats, version 2.0 to 5.1).

#include <limits>
#include <optional>

#include "io/tet/cell_mesh.h"
#include "io/tet/tet_formats.h"
#include "io/volume/volume_formats.h"
#include "littoral/error.h"

namespace littoral::io {

namespace {

bool is_end(char c) { return c == '\n' || c == '\r'; }

/// Lines with keywords, between them numbers as text or bytes.
class VtkScanner {
 public:
  VtkScanner(std::string_view bytes, std::string name) : bytes_(bytes), name_(std::move(name)) {}

  bool binary = false;

  [[noreturn]] void fail(const std::string& text) const {
    throw InputError(
        name_ +
            (binary ? ": byte " + std::to_string(at_) + ": " : ":" + std::to_string(line_) + ": ") +
            text,
        "bad-file");
  }
  [[noreturn]] void unsupported(const std::string& text) const {
    throw UnsupportedError(name_ + ": " + text, "unsupported-file");
  }

  /// The rest of the current line; the next one becomes current.
  std::string_view rest_of_line() {
    const std::size_t begin = at_;
    while (at_ < bytes_.size() && !is_end(bytes_[at_])) ++at_;
    const std::string_view text = bytes_.substr(begin, at_ - begin);
    if (at_ < bytes_.size()) {
      if (bytes_[at_] == '\r' && at_ + 1 < bytes_.size() && bytes_[at_ + 1] == '\n') ++at_;
      ++at_;
      ++line_;
    }
    return text;
  }
  /// The next word on any line; empty at the end.
  std::string_view word() {
    while (at_ < bytes_.size() && (is_blank(bytes_[at_]) || is_end(bytes_[at_]))) {
      if (bytes_[at_] == '\n') ++line_;
      ++at_;
    }
    return word_of_line();
  }
  /// The next word on the current line; empty where there is none.
  std::string_view word_of_line() {
    while (at_ < bytes_.size() && is_blank(bytes_[at_])) ++at_;
    const std::size_t begin = at_;
    while (at_ < bytes_.size() && !is_blank(bytes_[at_]) && !is_end(bytes_[at_])) ++at_;
    return bytes_.substr(begin, at_ - begin);
  }
  /// A keyword in lower case; where another one stands, it stays the next.
  bool take(std::string_view wanted) {
    const std::size_t at = at_, line = line_;
    if (lower_case(std::string(word())) == wanted) return true;
    at_ = at;
    line_ = line;
    return false;
  }

  std::int64_t count(const char* what) {
    const std::string_view text = word_of_line();
    const auto n = parse_integer(text);
    if (!n || *n < 0)
      fail("expected the number of " + std::string(what) + ", found " + in_quotes(text));
    // Every number takes a byte at least.
    if (static_cast<std::uint64_t>(*n) > bytes_.size() || *n > std::numeric_limits<int>::max())
      fail("the file promises " + std::to_string(*n) + " " + what + ", it has " +
           std::to_string(bytes_.size()) + " bytes");
    return *n;
  }

  /// `n` numbers from the next line on; `type` as VTK calls it.
  VecX numbers(std::int64_t n, const std::string& type, const char* what) {
    const NumberKind kind = kind_of(type);
    if (binary) {
      rest_of_line();
      const auto size = static_cast<std::uint64_t>(n) * kind.size;
      if (size > bytes_.size() - at_)
        fail("the file ends within " + std::to_string(n) + " numbers of " + what);
      VecX out =
          load_numbers(bytes_.substr(at_), kind, static_cast<std::size_t>(n), std::endian::big);
      at_ += size;
      return out;
    }
    if (static_cast<std::uint64_t>(n) > bytes_.size() - at_)
      fail("the file ends within " + std::to_string(n) + " numbers of " + what);
    VecX out(n);
    for (std::int64_t i = 0; i < n; ++i) {
      const std::string_view text = word();
      const auto value = parse_double(text);
      if (!value)
        fail("expected number " + std::to_string(i) + " of " + what + ", found " +
             (text.empty() ? "the end of the file" : in_quotes(text)));
      out[i] = *value;
    }
    return out;
  }

 private:
  NumberKind kind_of(const std::string& type) const {
    const std::string t = lower_case(type);
    if (t == "double") return {'f', 8};
    if (t == "float") return {'f', 4};
    if (t == "char" || t == "signed_char") return {'i', 1};
    if (t == "unsigned_char") return {'u', 1};
    if (t == "short") return {'i', 2};
    if (t == "unsigned_short") return {'u', 2};
    if (t == "int" || t == "vtkidtype" || t == "vtktypeint32") return {'i', 4};
    if (t == "unsigned_int" || t == "vtktypeuint32") return {'u', 4};
    if (t == "long" || t == "vtktypeint64") return {'i', 8};
    if (t == "unsigned_long" || t == "vtktypeuint64") return {'u', 8};
    fail("numbers of type " + in_quotes(type) + " are not read");
  }

  std::string_view bytes_;
  std::string name_;
  std::size_t at_ = 0, line_ = 1;
};

class VtkReader {
 public:
  VtkReader(std::string_view bytes, const std::string& name) : scan_(bytes, name) {
    cells_.name = name;
  }

  TetFile read() {
    header();
    for (std::string_view word = scan_.word(); !word.empty(); word = scan_.word())
      section(lower_case(std::string(word)));
    build();
    return cells_.as_tets();
  }

 private:
  void header() {
    const std::string_view first = scan_.rest_of_line();
    constexpr std::string_view magic = "# vtk DataFile Version ";
    if (!first.starts_with(magic)) scan_.fail("expected '# vtk DataFile Version'");
    modern_ = first.substr(magic.size()).starts_with("5");
    scan_.rest_of_line();  // the title
    const std::string mode = lower_case(std::string(scan_.word()));
    if (mode != "ascii" && mode != "binary") scan_.fail("expected ASCII or BINARY");
    if (!scan_.take("dataset")) scan_.fail("expected DATASET");
    const std::string set(scan_.word());
    if (lower_case(set) != "unstructured_grid")
      scan_.unsupported("the data set is " + in_quotes(set) +
                        ", only UNSTRUCTURED_GRID holds tets");
    scan_.binary = mode == "binary";
  }

  void section(const std::string& keyword) {
    if (keyword == "points") {
      const std::int64_t n = scan_.count("points");
      const std::string type(scan_.word_of_line());
      const VecX x = scan_.numbers(3 * n, type, "POINTS");
      cells_.points = Eigen::Map<const MatX3>(x.data(), n, 3);
    } else if (keyword == "cells") {
      cells();
    } else if (keyword == "cell_types") {
      types_ = scan_.numbers(scan_.count("cells"), "int", "CELL_TYPES");
    } else if (keyword == "point_data" || keyword == "cell_data") {
      at_points_ = keyword == "point_data";
      values_ = scan_.count("values");
    } else if (keyword == "metadata") {
      scan_.rest_of_line();
      while (!scan_.rest_of_line().empty()) {
      }
    } else {
      attribute(keyword);
    }
  }

  void cells() {
    const std::int64_t n = scan_.count("cells"), size = scan_.count("corners");
    if (modern_) {
      // Offsets of the cells and of the end, then all corners.
      const VecX offsets = array("offsets", n), corners = array("connectivity", size);
      starts_.assign(offsets.begin(), offsets.end());
      corners_ = corners;
      for (std::size_t c = 0; c < starts_.size(); ++c)
        if (!(starts_[c] >= (c > 0 ? starts_[c - 1] : 0) && starts_[c] <= size))
          scan_.fail("the offset of cell " + std::to_string(c) + " is out of order");
      return;
    }
    // Each cell is the number of its corners and these.
    const VecX list = scan_.numbers(size, "int", "CELLS");
    corners_.resize(size);
    starts_.assign(1, 0);
    std::int64_t at = 0, used = 0;
    for (std::int64_t c = 0; c < n; ++c) {
      const double degree = at < size ? list[at] : -1;
      if (!(degree >= 0 && degree <= static_cast<double>(size - at - 1)))
        scan_.fail("CELLS ends within cell " + std::to_string(c));
      ++at;
      for (int k = 0; k < static_cast<int>(degree); ++k) corners_[used++] = list[at++];
      starts_.push_back(static_cast<double>(used));
    }
  }

  VecX array(const char* name, std::int64_t n) {
    if (!scan_.take(name)) scan_.fail("expected " + std::string(name));
    const std::string type(scan_.word_of_line());
    return scan_.numbers(n, type, name);
  }

  /// Values at points or cells: one component each is kept.
  void keep(const std::string& name, int components, std::int64_t tuples, const std::string& type) {
    VecX values = scan_.numbers(components * tuples, type, name.c_str());
    if (at_points_ && components == 1 && tuples == cells_.points.rows())
      cells_.scalars[name] = std::move(values);
  }

  int components() {
    const std::string_view text = scan_.word_of_line();
    if (text.empty()) return 1;
    const auto n = parse_integer(text);
    if (!n || *n < 1 || *n > 100) scan_.fail("the number of components must be 1 to 100");
    return static_cast<int>(*n);
  }

  void attribute(const std::string& keyword) {
    const std::string name(scan_.word_of_line());
    if (keyword == "field") {
      const std::int64_t n = scan_.count("arrays");
      for (std::int64_t i = 0; i < n; ++i) {
        const std::string label(scan_.word());
        if (lower_case(label) == "metadata") {
          section("metadata");
          --i;
          continue;
        }
        const int width = components();
        const std::int64_t tuples = scan_.count("values");
        keep(label, width, tuples, std::string(scan_.word_of_line()));
      }
      return;
    }
    if (keyword == "lookup_table") {
      const std::int64_t n = scan_.count("colours");
      scan_.numbers(4 * n, scan_.binary ? "unsigned_char" : "float", "LOOKUP_TABLE");
      return;
    }
    if (keyword == "color_scalars") {
      const int width = components();
      keep(name, width, values_, scan_.binary ? "unsigned_char" : "float");
      return;
    }
    if (keyword == "texture_coordinates") {
      const int width = components();
      keep("", std::max(2, width), values_, std::string(scan_.word_of_line()));
      return;
    }
    const std::string type(scan_.word_of_line());
    if (keyword == "scalars") {
      const int width = components();
      if (scan_.take("lookup_table")) scan_.word_of_line();
      keep(name, width, values_, type);
    } else if (keyword == "vectors" || keyword == "normals") {
      keep(name, 3, values_, type);
    } else if (keyword == "tensors" || keyword == "tensors6") {
      keep(name, keyword == "tensors" ? 9 : 6, values_, type);
    } else if (keyword == "global_ids" || keyword == "pedigree_ids") {
      scan_.numbers(values_, type, name.c_str());
    } else {
      scan_.fail("unknown keyword " + in_quotes(keyword));
    }
  }

  void build() {
    const std::size_t n = starts_.empty() ? 0 : starts_.size() - 1;
    if (static_cast<std::size_t>(types_.size()) != n)
      scan_.fail("there are " + std::to_string(n) + " cells and " + std::to_string(types_.size()) +
                 " cell types");
    std::vector<int> corners;
    for (std::size_t c = 0; c < n; ++c) {
      corners.clear();
      for (auto k = static_cast<Eigen::Index>(starts_[c]);
           k < static_cast<Eigen::Index>(starts_[c + 1]); ++k)
        corners.push_back(cells_.corner(c, corners_[k]));
      const double type = types_[static_cast<Eigen::Index>(c)];
      cells_.add(c, std::abs(type) < 1e9 ? static_cast<int>(type) : -1, corners);
    }
  }

  VtkScanner scan_;
  CellMesh cells_;
  bool modern_ = false, at_points_ = true;
  std::int64_t values_ = 0;     // points or cells that attributes have values at
  std::vector<double> starts_;  // per cell, and the end, into corners_
  VecX corners_, types_;
};

}  // namespace

TetFile read_vtk(std::string_view bytes, const std::string& name) {
  return VtkReader(bytes, name).read();
}

}  // namespace littoral::io
