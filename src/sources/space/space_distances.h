#pragma once
// Distances that are known beside sources in space, before anything is solved for.

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "domain/tet/tet_locator.h"
#include "littoral/polygon_soup.h"
#include "littoral/volume.h"
#include "sources/space/oriented_points.h"
#include "sources/surface/known_distances.h"
#include "spatial/point_tree.h"
#include "spatial/triangle_bvh.h"

namespace littoral {

/// The nearest points of triangles or, where there are none, of samples that stand for discs of
/// their area. Immutable.
class NearestSource {
 public:
  NearestSource(const PolygonSoup& triangles, const OrientedPoints& samples);

  Vec3 operator()(const Vec3& x) const;
  /// The triangle nearest to x; there are some.
  int triangle_at(const Vec3& x) const;
  std::array<Vec3, 3> corners(int triangle) const;

 private:
  const OrientedPoints& samples_;
  MatX3 points_;
  MatX3i faces_;
  std::optional<TriangleBvh> triangles_;
  std::optional<PointTree> centres_;
};

/// Distance at the nodes of the cells of a grid that hold samples.
KnownDistances known_distances(const Grid& grid, const NearestSource& nearest,
                               const OrientedPoints& samples);

/// A node of a tet and how far the source is from it.
struct TetNodeDistance {
  int tet;
  Eigen::Vector4d b;
  double distance;
};

/// Of which tets nodes are to know their distance: those that hold samples, or also those that
/// share a vertex with one, among which are those that the source crosses between its samples.
enum class Around { alone, with_neighbours };

/// Node -> distance, of the tets that hold samples, of which `places` says where they lie. Where
/// the straight way to the nearest point leaves the tets, as where part of the source lies outside,
/// it is the distance to what lies in them. `local`: barycentrics of a tet's nodes; `node(tet, i)`:
/// their numbers.
std::map<int, TetNodeDistance> distances_around(const TetMesh& mesh, const TetLocator& locator,
                                                const PolygonSoup& surface,
                                                const OrientedPoints& samples,
                                                const std::vector<TetPoint>& places,
                                                const std::vector<Eigen::Vector4d>& local,
                                                const std::function<int(int, int)>& node,
                                                Around around);

}  // namespace littoral
