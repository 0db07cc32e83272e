#include "methods/implicit/places_on_parts.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace littoral {

namespace {
constexpr int places_in_all = 4096, places_at_least = 4;  // on parts
}

std::vector<Place> places_on_parts(const MatX3& points, const MatX3i& faces, const VecX& areas,
                                   const std::vector<int>& part) {
  std::map<int, std::vector<int>> members;
  for (int f = 0; f < faces.rows(); ++f) members[part[f]].push_back(f);
  std::vector<Place> out;
  const double total = areas.sum();
  for (const auto& [number, all] : members) {
    double area = 0;
    for (const int f : all) area += areas[f];
    if (!(area > 0)) continue;
    const int n =
        std::max(places_at_least, static_cast<int>(std::lround(places_in_all * area / total)));
    std::size_t at = 0;
    double sum = areas[all[0]];
    for (int i = 0; i < n; ++i) {
      while (sum < (i + 0.5) / n * area && at + 1 < all.size()) sum += areas[all[++at]];
      double u = std::fmod(0.5 + 0.7548776662466927 * i, 1.0),
             v = std::fmod(0.5 + 0.5698402909980532 * i, 1.0);
      if (u + v > 1) u = 1 - u, v = 1 - v;
      const auto face = faces.row(all[at]);
      out.push_back({all[at], (1 - u - v) * points.row(face[0]) + u * points.row(face[1]) +
                                  v * points.row(face[2])});
    }
  }
  return out;
}

}  // namespace littoral
