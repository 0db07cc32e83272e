#pragma once
// One reader per format of tets, and what they share.

#include <cstdint>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "io/tet/tets.h"
#include "io/text_scan.h"

namespace littoral::io {

TetFile read_tet(std::string_view bytes, const std::string& name);
TetFile read_vtk_tets(std::string_view bytes, const std::string& name);
/// The polygons among the cells.
PolygonSoup read_vtk_surface(std::string_view bytes, const std::string& name);

void write_vtk(std::ostream& out, const TetMesh& mesh, const VecX& values,
               const std::string& field);
void write_vtu(std::ostream& out, const TetMesh& mesh, const VecX& values,
               const std::string& field);

/// Words of a text whose line ends mean nothing.
class WordScanner {
 public:
  WordScanner(std::string_view bytes, const std::string& name)
      : size_(bytes.size()), lines_(without_byte_order_mark(bytes, name), name, '#') {}

  /// The next word; empty at the end of the text.
  std::string_view word() {
    for (;;) {
      const std::string_view found = lines_.word();
      if (!found.empty() || !lines_.next()) return found;
    }
  }
  /// The next word as a number; `what` was expected: "x of vertex 7".
  template <class What>
  double number(const What& what) {
    const std::string_view text = word();
    const auto value = parse_double(text);
    if (!value) lines_.fail("expected " + what() + ", found " + found_text(text));
    return *value;
  }
  template <class What>
  std::int64_t integer(const What& what) {
    const std::string_view text = word();
    const auto value = parse_integer(text);
    if (!value) lines_.fail("expected " + what() + ", found " + found_text(text));
    return *value;
  }
  /// A count of things of which each takes `least` bytes of text.
  int count(const char* what, std::size_t least);
  /// A vertex of an element, counted from `base`, as one counted from 0.
  int vertex(const char* element, int number, int base, int n_vertices);
  [[noreturn]] void fail(const std::string& text) const { lines_.fail(text); }

 private:
  static std::string found_text(std::string_view text) {
    return text.empty() ? "the end of the file" : in_quotes(text);
  }
  std::size_t size_;
  LineScanner lines_;
};

}  // namespace littoral::io
