#include "spatial/weld.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <vector>

#include "base/numbers_hash.h"
#include "spatial/finite_box.h"

namespace littoral {

namespace {

constexpr double finest_cell = 1e-12;  // of the longest side

using Cell = std::array<std::int64_t, 3>;

/// The vertex that each one becomes, itself where it is kept.
std::vector<int> kept_vertices(const MatX3& points, double distance) {
  const Vec3 low = finite_box(points).min();
  const double side = std::max(points_size(points), std::numeric_limits<double>::min());
  const double cell = std::max(distance, finest_cell * side);
  std::unordered_map<Cell, std::vector<int>, NumbersHash> kept;
  std::vector<int> out(std::size_t(points.rows()));
  for (int v = 0; v < points.rows(); ++v) {
    out[v] = v;
    const Vec3 x = points.row(v);
    if (!x.allFinite()) continue;
    Cell at;
    for (int k = 0; k < 3; ++k) at[k] = std::llround(std::floor((x[k] - low[k]) / cell));
    double nearest = distance;
    for (int n = 0; n < 27; ++n) {
      const auto found = kept.find({at[0] + n % 3 - 1, at[1] + n / 3 % 3 - 1, at[2] + n / 9 - 1});
      if (found == kept.end()) continue;
      for (const int w : found->second) {
        const double far = (points.row(w).transpose() - x).norm();
        if (far < nearest || (far == nearest && (out[v] == v || w < out[v]))) {
          nearest = far;
          out[v] = w;
        }
      }
    }
    if (out[v] == v) kept[at].push_back(v);
  }
  return out;
}

/// The vertices by their new numbers, each once where it follows itself.
std::vector<int> renumbered(std::span<const int> vertices, const std::vector<int>& number,
                            bool closed) {
  std::vector<int> out;
  for (const int v : vertices)
    if (out.empty() || out.back() != number[v]) out.push_back(number[v]);
  while (closed && out.size() > 1 && out.front() == out.back()) out.pop_back();
  return out;
}

template <class Values>
Values rows_at(const Values& values, const std::vector<int>& rows) {
  return values.rows() == 0 ? values : Values(values(rows, Eigen::all));
}

}  // namespace

Welded weld(const PolygonSoup& soup, double distance) {
  const std::vector<int> becomes = kept_vertices(soup.points, distance);
  std::vector<int> kept, number(becomes.size());
  for (int v = 0; v < soup.n_vertices(); ++v) {
    number[v] = becomes[v] == v ? static_cast<int>(kept.size()) : number[becomes[v]];
    if (becomes[v] == v) kept.push_back(v);
  }
  Welded out;
  out.n_merged = soup.n_vertices() - static_cast<int>(kept.size());
  out.soup.points = rows_at(soup.points, kept);
  out.soup.normals = rows_at(soup.normals, kept);
  for (const auto& [name, values] : soup.scalars) out.soup.scalars[name] = rows_at(values, kept);
  for (int f = 0; f < soup.n_faces(); ++f) {
    const std::vector<int> face = renumbered(soup.face(f), number, true);
    if (face.size() >= 3)
      out.soup.add_face(face);
    else
      ++out.n_dropped_faces;
  }
  for (const auto& line : soup.lines)
    if (auto nodes = renumbered(line, number, false); nodes.size() >= 2)
      out.soup.lines.push_back(std::move(nodes));
  return out;
}

}  // namespace littoral
