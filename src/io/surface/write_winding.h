#pragma once
// Files that hold winding numbers: homogeneous texture coordinates, curves.

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "littoral/polygon_soup.h"

namespace littoral::io {

/// OBJ with homogeneous texture coordinates (value * weight, weight): interpolate both linearly and
/// divide per pixel. The scalars are vertices.
void write_homogeneous_obj(const std::filesystem::path& path, const PolygonSoup& soup,
                           const std::string& value, const std::string& weight);

/// OBJ of named groups of polylines.
void write_polylines(const std::filesystem::path& path,
                     const std::vector<std::pair<std::string, const std::vector<MatX3>*>>& groups);

}  // namespace littoral::io
