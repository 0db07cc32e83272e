#include "sources/space/parts_of_samples.h"

#include <map>

#include "base/disjoint_sets.h"
#include "base/index.h"
#include "sources/space/space_distances.h"
#include "spatial/boundary_edges.h"
#include "spatial/triangulate.h"

namespace littoral {

std::vector<int> parts_of_faces(const PolygonSoup& surface) {
  const std::vector<int> first = same_positions(surface.points);
  DisjointSets joined(surface.n_vertices());
  for (int f = 0; f < surface.n_faces(); ++f)
    for (const int v : surface.face(f)) joined.join(first[surface.face(f)[0]], first[v]);
  std::map<int, int> number;
  std::vector<int> part;
  for (int f = 0; f < surface.n_faces(); ++f) {
    const int root = joined.find(first[surface.face(f)[0]]);
    part.push_back(number.try_emplace(root, static_cast<int>(number.size())).first->second);
  }
  return part;
}

std::vector<int> parts_of_samples(const PolygonSoup& surface, const OrientedPoints& samples) {
  std::vector<int> part(std::size_t(samples.size()), 0);
  if (surface.n_faces() == 0) return part;
  const PolygonSoup triangles = triangulate(surface);
  const std::vector<int> of_face = parts_of_faces(triangles);
  const NearestSource nearest(triangles, samples);
  std::map<int, int> number;
  for (std::size_t i = 0; i < part.size(); ++i) {
    const int of = of_face[nearest.triangle_at(samples.points.row(index(i)))];
    part[i] = number.try_emplace(of, static_cast<int>(number.size())).first->second;
  }
  return part;
}

}  // namespace littoral
