#pragma once
// Everything a surface file can hold, as it was written: nothing merged, dropped or repaired.

#include <map>
#include <span>
#include <string>
#include <vector>

#include "littoral/types.h"

namespace littoral {

/// Polygons, polylines and per-vertex data over shared points. Faces may repeat vertices, overlap,
/// disagree in orientation or share an edge by the dozen; indices are always in range and points
/// may be non-finite only where a reader documents it.
struct PolygonSoup {
  MatX3 points{0, 3};                // vertices x 3
  std::vector<int> face_offsets{0};  // faces + 1, into corners
  std::vector<int> corners;          // vertex of each corner, counter-clockwise seen from outside
  std::vector<std::vector<int>> lines;  // polylines, by vertex
  MatX3 normals{0, 3};                  // vertices x 3 (not normalised), or empty
  std::map<std::string, VecX> scalars;  // per-vertex values by name, e.g. "distance"; may be +inf

  int n_vertices() const { return static_cast<int>(points.rows()); }
  int n_faces() const { return static_cast<int>(face_offsets.size()) - 1; }
  std::span<const int> face(int f) const {
    return {corners.data() + face_offsets[f], corners.data() + face_offsets[f + 1]};
  }
  void add_face(std::span<const int> vertices) {
    corners.insert(corners.end(), vertices.begin(), vertices.end());
    face_offsets.push_back(static_cast<int>(corners.size()));
  }
};

}  // namespace littoral
