#include "sources/parts_of_samples.h"

#include <map>

#include "base/disjoint_sets.h"
#include "sources/space_distances.h"
#include "spatial/boundary_edges.h"
#include "spatial/triangulate.h"

namespace littoral {

std::vector<int> parts_of_samples(const PolygonSoup& surface, const OrientedPoints& samples) {
  std::vector<int> part(static_cast<std::size_t>(samples.size()), 0);
  if (surface.n_faces() == 0) return part;
  const PolygonSoup triangles = triangulate(surface);
  const std::vector<int> first = same_positions(triangles.points);
  DisjointSets joined(triangles.n_vertices());
  for (int f = 0; f < triangles.n_faces(); ++f)
    for (int k = 1; k < 3; ++k)
      joined.join(first[triangles.face(f)[0]], first[triangles.face(f)[k]]);
  const NearestSource nearest(triangles, samples);
  std::map<int, int> number;
  for (std::size_t i = 0; i < part.size(); ++i) {
    const int f = nearest.triangle_at(samples.points.row(static_cast<Eigen::Index>(i)));
    const int root = joined.find(first[triangles.face(f)[0]]);
    part[i] = number.try_emplace(root, static_cast<int>(number.size())).first->second;
  }
  return part;
}

}  // namespace littoral
