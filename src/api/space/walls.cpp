#include "api/space/walls.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "api/space/input_queries.h"
#include "base/disjoint_sets.h"
#include "base/index.h"
#include "base/option_table.h"
#include "base/parallel.h"
#include "base/platform/memory.h"
#include "contour/isosurface.h"
#include "spatial/boundary_edges.h"
#include "spatial/triangle_bvh.h"
#include "spatial/triangulate.h"

namespace littoral {

namespace {

// In spacings: what is nearer than a spacing to the outside on both sides has, at one of these
// depths, a distance of at least `clear` from the inside. Next to an edge of a thick part it has
// not.
constexpr std::array depths = {0.5, 0.75, 1.0, 1.25};
constexpr double clear = 0.25;
constexpr double gap = 0.9;  // the surface is torn where it misses a thin part by more: next to
                             // edges of what it holds it may by less
constexpr double missed_of_part =
    0.15;                         // of a thin part's area, for those next to holes of the input
constexpr double parallel = 0.9;  // cosine of the angle between the two sides of a thin part

using Triangle = std::array<Vec3, 3>;

/// A part of a triangle of the input.
struct Piece {
  int face;
  Triangle corners;
  Vec3 middle, normal;
  double area;
};

/// The triangles with area in pieces with no side longer than `longest`, by halving the longest.
std::vector<Piece> pieces_of(const PolygonSoup& triangles, double longest, const Task& task) {
  double area = 0;
  for (int f = 0; f < triangles.n_faces(); ++f) {
    const auto v = triangles.face(f);
    const Vec3 a = triangles.points.row(v[0]), b = triangles.points.row(v[1]),
               c = triangles.points.row(v[2]);
    area += (b - a).cross(c - a).norm() / 2;
  }
  constexpr double most_pieces = 8;  // in a square of that length
  check_memory(sizeof(Piece) * (triangles.n_faces() + most_pieces * area / (longest * longest)),
               "walls of pieces no longer than " + rounded_text(longest),
               "lower option resolution, or leave out option thicken");
  std::vector<Piece> out;
  std::vector<Triangle> left;
  for (int f = 0; f < triangles.n_faces(); ++f) {
    if (f % 1024 == 0) task.checkpoint();
    const auto v = triangles.face(f);
    left.push_back(
        {triangles.points.row(v[0]), triangles.points.row(v[1]), triangles.points.row(v[2])});
    const Vec3 across = (left[0][1] - left[0][0]).cross(left[0][2] - left[0][0]);
    const Vec3 normal = across.stableNormalized();
    if (!(normal.squaredNorm() > 0.5)) left.clear();
    while (!left.empty()) {
      const Triangle t = left.back();
      left.pop_back();
      int side = 0;
      double length = 0;
      for (int k = 0; k < 3; ++k)
        if (const double l = (t[(k + 1) % 3] - t[k]).norm(); l > length) {
          side = k;
          length = l;
        }
      if (!(length > longest)) {
        out.push_back(
            {f, t, (t[0] + t[1] + t[2]) / 3, normal, (t[1] - t[0]).cross(t[2] - t[0]).norm() / 2});
        continue;
      }
      const Vec3 half = (t[side] + t[(side + 1) % 3]) / 2;
      const Vec3 opposite = t[(side + 2) % 3];
      left.push_back({t[side], half, opposite});
      left.push_back({half, t[(side + 1) % 3], opposite});
    }
  }
  return out;
}

double value_at(const Volume& distance, const Vec3& x) {
  const Vec3 at = (x - distance.grid.origin).cwiseQuotient(distance.grid.spacing);
  const Vec3 last =
      Eigen::Map<const Eigen::Vector3i>(distance.grid.n.data()).cast<double>().array() - 1;
  return interpolate(distance, at.cwiseMax(0).cwiseMin(last));
}

/// Whether the outside is near on both sides.
bool is_thin(const Piece& piece, const Volume& distance, double h) {
  const auto outside_at = [&](double sign) {
    return std::any_of(depths.begin(), depths.end(), [&](double depth) {
      return value_at(distance, piece.middle + sign * depth * h * piece.normal) >= clear * h;
    });
  };
  return outside_at(1) && outside_at(-1);
}

/// Which cells of width h the pieces' middles lie in, each with its pieces.
using Cell = std::array<long, 3>;
std::map<Cell, std::vector<int>> cells_of(const std::vector<Piece>& pieces, double h) {
  std::map<Cell, std::vector<int>> cells;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    Cell cell;
    for (int a = 0; a < 3; ++a) cell[a] = std::lround(std::floor(pieces[i].middle[a] / h));
    cells[cell].push_back(static_cast<int>(i));
  }
  return cells;
}

/// visit(i, j) for all cells that touch cell i, and for itself.
template <class Cells, class Visit>
void visit_neighbours(const Cells& cells, const Cell& cell, const Visit& visit) {
  for (int c = 0; c < 27; ++c) {
    const auto found =
        cells.find({cell[0] + c % 3 - 1, cell[1] + c / 3 % 3 - 1, cell[2] + c / 9 - 1});
    if (found != cells.end()) visit(found->second);
  }
}

/// Numbers of pieces that are neighbours, through others too, are the same.
std::vector<int> connected(const std::vector<Piece>& pieces, double h, int& count) {
  const auto cells = cells_of(pieces, h);
  DisjointSets sets(static_cast<int>(pieces.size()));
  for (const auto& [cell, here] : cells)
    visit_neighbours(cells, cell, [&, first = here.front()](const auto& there) {
      sets.join(first, there.front());
    });
  for (const auto& [cell, here] : cells)
    for (const int i : here) sets.join(here.front(), i);
  return sets.numbered(count);
}

MatX3 middles_of(const std::vector<Piece>& pieces) {
  MatX3 out(index(pieces.size()), 3);
  for (Eigen::Index i = 0; i < out.rows(); ++i) out.row(i) = pieces[i].middle.transpose();
  return out;
}

/// How far points are from where the surface ends.
VecX distance_to_ends(const PolygonSoup& triangles, const MatX3& x, const Task& task) {
  PolygonSoup ends;
  ends.points = triangles.points;
  for (const auto& [a, b] : boundary_edges(triangles.points, triangles_of(triangles))) {
    const std::array<int, 3> side{a, b, b};
    ends.add_face(side);
  }
  if (ends.n_faces() == 0) return VecX::Constant(x.rows(), infinity);
  return NearestOnInput(ends).at(x, task).distances;
}

/// The pieces without those that one that stays is much like: where needles crowd, more than eight
/// with one normal in a quarter of h, the largest of them stays. Its wall, two spacings thick and
/// more, covers the others.
std::vector<Piece> without_crowds(const std::vector<Piece>& pieces, double h) {
  constexpr double many_cells = 4, many_directions = 8;
  constexpr std::size_t crowd = 8;
  std::map<std::array<long, 6>, std::vector<int>> groups;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    std::array<long, 6> key{};
    for (int a = 0; a < 3; ++a) {
      key[a] = std::lround(std::floor(many_cells * pieces[i].middle[a] / h));
      key[3 + a] = std::lround(many_directions * pieces[i].normal[a]);
    }
    groups[key].push_back(static_cast<int>(i));
  }
  std::vector<char> stays(pieces.size(), 1);
  for (const auto& [key, group] : groups) {
    if (group.size() <= crowd) continue;
    for (const int i : group) stays[i] = 0;
    stays[*std::max_element(group.begin(), group.end(),
                            [&](int i, int j) { return pieces[i].area < pieces[j].area; })] = 1;
  }
  std::vector<Piece> out;
  for (std::size_t i = 0; i < pieces.size(); ++i)
    if (stays[i]) out.push_back(pieces[i]);
  return out;
}

/// How thick a part the pieces are sides of, up to h; 0 of sheets.
VecX thicknesses(const std::vector<Piece>& pieces, const TriangleBvh& bvh, double h,
                 const Task& task) {
  const auto n = pieces.size();
  VecX own = VecX::Zero(index(n));
  parallel_for(n, 1024, [&](std::size_t begin, std::size_t end) {
    task.checkpoint();
    for (std::size_t i = begin; i < end; ++i) {
      for (const double sign : {1.0, -1.0}) {
        // Seen from a spacing away the other side is the nearest.
        const Vec3 away = sign * h * pieces[i].normal;
        const NearestPoint found = bvh.closest_point(pieces[i].middle + away);
        const Vec3 to = found.point - pieces[i].middle;
        const double t = to.dot(away) / h;
        const bool faces = std::abs(pieces[found.face].normal.dot(pieces[i].normal)) > parallel;
        if (faces && t > own[index(i)] && (to - t / h * away).norm() <= 0.1 * h) own[index(i)] = t;
      }
    }
  });
  // Those at the rim of a part, which see no other side, are as thick as those next to them.
  VecX out = own;
  const auto cells = cells_of(pieces, h);
  for (const auto& [cell, here] : cells) {
    double most = 0;
    visit_neighbours(cells, cell, [&](const auto& there) {
      for (const int i : there) most = std::max(most, own[i]);
    });
    for (const int i : here)
      if (own[i] == 0) out[i] = most;
  }
  return out;
}

Walls made_of(const PolygonSoup& triangles, const std::vector<Piece>& all,
              const std::vector<char>& chosen, double thickness, double h, const Task& task) {
  Walls out;
  out.wholly.assign(std::size_t(triangles.n_faces()), 1);
  double area = 0, of_walls = 0;
  std::vector<Piece> pieces;
  for (std::size_t i = 0; i < all.size(); ++i) {
    area += all[i].area;
    if (!chosen[i]) {
      out.wholly[all[i].face] = 0;
      continue;
    }
    of_walls += all[i].area;
    if (pieces.empty() || pieces.back().face != all[i].face) ++out.triangles;
    pieces.push_back(all[i]);
  }
  if (pieces.empty()) return out;
  out.share = of_walls / area;
  pieces = without_crowds(pieces, h);
  const auto n = index(pieces.size());
  MatX3 points(3 * n, 3);
  MatX3i faces(n, 3);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (int k = 0; k < 3; ++k) points.row(3 * i + k) = pieces[i].corners[k].transpose();
    faces.row(i) << int(3 * i), int(3 * i + 1), int(3 * i + 2);
  }
  out.pieces = soup_of(points, faces);
  const TriangleBvh bvh(points, faces);
  // The other side adds its thickness; but a grid holds no less than two spacings.
  const VecX part = thicknesses(pieces, bvh, h, task);
  const VecX held = (2 * h - part.array()).min(thickness);
  out.radii = held.cwiseMax((thickness - part.array()).matrix()) / 2;
  return out;
}

}  // namespace

bool is_inside(const Volume& distance, const Vec3& x) { return value_at(distance, x) < 0; }

Walls walls_of_all(const PolygonSoup& triangles, const Grid& grid, double thickness, Task task) {
  const double h = grid.spacing.maxCoeff();
  const std::vector<Piece> pieces = pieces_of(triangles, h, task);
  return made_of(triangles, pieces, std::vector<char>(pieces.size(), 1), thickness, h, task);
}

Walls walls_of(const PolygonSoup& triangles, const PolygonSoup& surface, const Volume& distance,
               double far, double thickness, Task task) {
  const double h = distance.grid.spacing.maxCoeff();
  const std::vector<Piece> all = pieces_of(triangles, h, task);
  std::vector<char> thin(all.size(), 0);
  parallel_for(all.size(), 1024, [&](std::size_t begin, std::size_t end) {
    task.checkpoint();
    for (std::size_t i = begin; i < end; ++i) thin[i] = is_thin(all[i], distance, h);
  });
  std::vector<Piece> pieces;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (thin[i]) pieces.push_back(all[i]);
  std::vector<char> chosen(all.size(), 0);
  if (pieces.empty()) return made_of(triangles, all, chosen, thickness, h, task);

  const VecX to_surface =
      NearestOnInput(surface).at(middles_of(pieces), task.stage(1, "walls")).distances;
  int count = 0;
  const std::vector<int> part = connected(pieces, h, count);
  const VecX to_end = distance_to_ends(triangles, middles_of(pieces), task);
  struct Part {
    Box box;
    double farthest = 0, away_from_ends = 0, missed = 0, area = 0;
  };
  std::vector<Part> parts(count);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    Part& of = parts[part[i]];
    for (const Vec3& x : pieces[i].corners) of.box.add(x);
    of.area += pieces[i].area;
    if (is_inside(distance, pieces[i].middle)) continue;
    const double d = to_surface[index(i)];
    of.farthest = std::max(of.farthest, d);
    if (to_end[index(i)] > 2 * h) of.away_from_ends = std::max(of.away_from_ends, d);
    if (d > far) of.missed += pieces[i].area;
  }
  std::vector<char> stays(count);
  for (int c = 0; c < count; ++c) {
    const Part& of = parts[c];
    const bool is_torn = of.away_from_ends > gap * h ||
                         (of.farthest > gap * h && of.missed > missed_of_part * of.area) ||
                         of.farthest > 2 * h;
    const bool is_wide = of.box.size().norm() > 2 * thickness;
    stays[c] = (is_torn && is_wide) || of.farthest > std::max(thickness, 2 * h);
  }
  std::size_t k = 0;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (thin[i]) chosen[i] = stays[part[k++]];
  return made_of(triangles, all, chosen, thickness, h, task);
}

WallDistance wall_distance(const Walls& walls, const Grid& grid, Task task) {
  const TriangleBvh bvh(walls.pieces.points, triangles_of(walls.pieces));
  WallDistance out;
  out.at_nodes = bvh.values_at_nodes(
      grid,
      [&](const Vec3&, const NearestPoint& nearest) {
        return nearest.distance - walls.radii[nearest.face];
      },
      task.stage(0.7, "walls"));
  Report ignored;  // another surface is contoured
  out.surface =
      isosurface(grid, out.at_nodes, 0, {.close = true}, ignored, task.stage(0.2, "walls"));
  MatX3& points = out.surface.points;
  parallel_for(std::size_t(points.rows()), 1024, [&](std::size_t begin, std::size_t end) {
    task.checkpoint();
    for (std::size_t v = begin; v < end; ++v) {
      const Vec3 x = points.row(index(v));
      const NearestPoint foot = bvh.closest_point(x);
      if (foot.distance > walls.radii[foot.face] / 2)
        points.row(index(v)) =
            foot.point + walls.radii[foot.face] / foot.distance * (x - foot.point);
    }
  });
  return out;
}

}  // namespace littoral
