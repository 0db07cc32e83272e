#pragma once
// One writer per format; each writes a whole file to a stream. What is written was checked before.

#include <cstdint>
#include <ostream>
#include <string>

#include "littoral/polygon_soup.h"

namespace littoral::io {

/// The shortest text that reads back as the same double; "inf", "-inf" and "nan" where it is none.
std::string exact_text(double value);

/// The field, where the soup has it, becomes the texture coordinate u. Lines with a scalar "level"
/// are groups by it.
void write_obj(std::ostream& out, const PolygonSoup& soup, const std::string& field);
/// All fields are written; `field`, where the soup has it, also as colours. Throws UnsupportedError
/// for names that no property can have.
void write_ply(std::ostream& out, const PolygonSoup& soup, const std::string& field);
void write_off(std::ostream& out, const PolygonSoup& soup, const std::string& field);
/// glTF in one file. The field is also the vertices' colours; all scalars are attributes "_NAME",
/// infinite ones as the largest number. Throws UnsupportedError unless faces are triangles, for
/// coordinates beyond single precision and for normals without a direction.
void write_glb(std::ostream& out, const PolygonSoup& soup, const std::string& field);
/// Throws UnsupportedError unless faces are triangles with coordinates in the range of single
/// precision.
void write_stl(std::ostream& out, const PolygonSoup& soup, const std::string& field);
/// Lengths are millimetres. Throws UnsupportedError unless faces are triangles with three different
/// vertices, all of them finite.
void write_3mf(std::ostream& out, const PolygonSoup& soup, const std::string& field);
/// The outline of the faces and the lines, coloured by a scalar "level", seen from the positive
/// side of the axis along which they are flat. Throws UnsupportedError where they are flat along
/// none.
void write_svg(std::ostream& out, const PolygonSoup& soup, const std::string& field);
/// VTK's XML polygon data with normals and all scalars (appended raw data); `field`, where the soup
/// has it, is the one that programs show first. Points alone are vertices of their own.
void write_vtp(std::ostream& out, const PolygonSoup& soup, const std::string& field);
/// Text as it stands between quotes in XML.
std::string xml_text(const std::string& plain);
/// The arrays of VTK's XML files that stand as raw data at the end: announced in order, then
/// written.
class AppendedArrays {
 public:
  explicit AppendedArrays(std::ostream& out) : out_(out) {}
  /// type: "Float64"; bytes: of all its numbers.
  void announce(const char* type, const std::string& name, int components, std::uint64_t bytes);

 private:
  std::ostream& out_;
  std::uint64_t offset_ = 0;  // every block is its length in bytes and then the data
};

}  // namespace littoral::io
