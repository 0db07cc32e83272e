#pragma once
// The least of an OBJ file that tests of lower layers need (they may not include io): v, f, l.

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "littoral/domain/polygon_soup.h"

namespace littoral::test {

/// Points, polygons and polylines with 1-based positive indices; everything else is skipped.
inline PolygonSoup plain_obj(const std::filesystem::path& path) {
  PolygonSoup soup;
  std::vector<Vec3> points;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string key, word;
    words >> key;
    if (key == "v") {
      std::string x, y, z;
      words >> x >> y >> z;
      points.emplace_back(std::stod(x), std::stod(y), std::stod(z));
    } else if (key == "f" || key == "l") {
      std::vector<int> indices;
      while (words >> word) indices.push_back(std::stoi(word) - 1);
      if (key == "f")
        soup.add_face(indices);
      else
        soup.lines.push_back(indices);
    }
  }
  soup.points.resize(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t v = 0; v < points.size(); ++v)
    soup.points.row(static_cast<Eigen::Index>(v)) = points[v];
  return soup;
}

}  // namespace littoral::test
