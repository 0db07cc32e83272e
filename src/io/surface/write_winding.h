#pragma once
// Files that hold winding numbers: labels of faces, homogeneous texture coordinates, curves.

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "littoral/polygon_soup.h"

namespace littoral::io {

/// One integer per face: .txt (one a line), .csv ("face,region", 0-based), .npy (float64). Throws
/// UnsupportedError for other extensions, IoError naming the path.
void write_labels(const std::filesystem::path& path, const VecXi& region);

/// OBJ with homogeneous texture coordinates (value * weight, weight): interpolate both linearly and
/// divide per pixel. The scalars are vertices.
void write_homogeneous_obj(const std::filesystem::path& path, const PolygonSoup& soup,
                           const std::string& value, const std::string& weight);

/// OBJ of named groups of polylines.
void write_polylines(const std::filesystem::path& path,
                     const std::vector<std::pair<std::string, const std::vector<MatX3>*>>& groups);

}  // namespace littoral::io
