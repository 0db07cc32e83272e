#pragma once
// Cells of files: polygons, and solids cut into tets.

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/formats.h"

namespace littoral::io {

/// Points with cells of the kinds that VTK numbers (VTK File Formats, "Legacy", figure 2).
///
/// Solid cells are cones: from the corner with the smallest number over the faces without it. Every
/// face of four corners is cut by the diagonal through its smallest number, also those beside the
/// tip; so cells that share a face cut it alike, and the tets fit together (Dompierre, Labbé,
/// Vallet, Camarero, "How to subdivide pyramids, prisms, and hexahedra into tetrahedra", 1999).
/// A hexahedron is 6 tets, a prism 3, a pyramid 2; where a cell repeats a corner, tets without
/// volume are left out.
struct CellMesh {
  static constexpr int last_without_area = 4;  // points and lines
  enum Cell {
    triangle = 5,
    triangle_strip,
    polygon,
    pixel,
    quad,
    tet,
    voxel,
    hexahedron,
    prism,
    pyramid
  };

  std::string name;  // of the file, for messages
  MatX3 points{0, 3};
  std::map<std::string, VecX> scalars;
  std::vector<int> tets;  // four a tet
  PolygonSoup faces;      // polygons, lines and normals alone

  /// A cell by its place in the file. Corners are in range. Throws InputError for a wrong number of
  /// corners, UnsupportedError for kinds that are not read.
  void add(std::size_t number, int kind, std::span<const int> corners);
  /// A polyline of the surface; one of a single point is left out.
  void add_line(std::span<const int> corners);
  /// A corner as read. Throws InputError unless a point has this number.
  int corner(std::size_t number, double vertex) const;

  bool solid() const { return !tets.empty(); }
  /// Tets, and the faces among them as triangles that fit. Leaves this empty.
  TetFile as_tets();
  /// The polygons. Throws InputError where there are only tets.
  PolygonSoup as_surface();
  /// Tets where there are any.
  Content as_what_it_is();

 private:
  void add_cone(std::span<const int> corners, std::span<const std::array<int, 4>> faces);
  void check_corners(std::size_t number, int kind, std::size_t corners, std::size_t needed) const;
};

CellMesh read_medit(std::string_view bytes, const std::string& name);
CellMesh read_msh(std::string_view bytes, const std::string& name);
CellMesh read_vtu(std::string_view bytes, const std::string& name);

/// One of these readers as the table of formats has them.
template <CellMesh (*read)(std::string_view bytes, const std::string& name)>
struct CellsAs {
  static TetFile tets(std::string_view bytes, const std::string& name) {
    return read(bytes, name).as_tets();
  }
  static PolygonSoup surface(std::string_view bytes, const std::string& name) {
    return read(bytes, name).as_surface();
  }
  static Content any(std::string_view bytes, const std::string& name, const std::string&) {
    return read(bytes, name).as_what_it_is();
  }
};

}  // namespace littoral::io
