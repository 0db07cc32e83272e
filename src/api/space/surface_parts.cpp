#include "api/space/surface_parts.h"

#include <Eigen/Geometry>
#include <array>

#include "base/disjoint_sets.h"
#include "base/index.h"

namespace littoral {

SurfaceParts parts_of(const PolygonSoup& surface) {
  DisjointSets sets(surface.n_vertices());
  for (int f = 0; f < surface.n_faces(); ++f)
    for (const int v : surface.face(f)) sets.join(surface.face(f)[0], v);
  SurfaceParts parts;
  std::vector<int> number(std::size_t(surface.n_vertices()), -1);  // by root
  std::vector<int> first;                                          // a vertex of each
  for (int f = 0; f < surface.n_faces(); ++f) {
    const auto face = surface.face(f);
    int& part = number[sets.find(face[0])];
    if (part < 0) {
      part = static_cast<int>(first.size());
      first.push_back(face[0]);
      parts.boxes.emplace_back();
      parts.volumes.push_back(0);
    }
    parts.of_face.push_back(part);
    std::array<Vec3, 3> x;
    for (std::size_t k = 0; k < 3; ++k) {
      x[k] = surface.points.row(face[k]);
      parts.boxes[part].add(x[k]);
    }
    const Vec3 origin = surface.points.row(first[part]);  // near the part: little cancels
    parts.volumes[part] += (x[0] - origin).dot((x[1] - origin).cross(x[2] - origin)) / 6;
  }
  return parts;
}

PolygonSoup with_parts(const PolygonSoup& surface, const SurfaceParts& parts,
                       const std::vector<char>& stays) {
  std::vector<int> number(std::size_t(surface.n_vertices()), -1);
  for (int f = 0; f < surface.n_faces(); ++f)
    if (stays[parts.of_face[f]])
      for (const int v : surface.face(f)) number[v] = 0;
  PolygonSoup out;
  int n = 0;
  for (int& at : number)
    if (at == 0) at = n++;
  out.points.resize(n, 3);
  for (std::size_t v = 0; v < number.size(); ++v)
    if (number[v] >= 0) out.points.row(number[v]) = surface.points.row(index(v));
  for (int f = 0; f < surface.n_faces(); ++f) {
    if (!stays[parts.of_face[f]]) continue;
    std::array<int, 3> face;
    for (std::size_t k = 0; k < 3; ++k) face[k] = number[surface.face(f)[k]];
    out.add_face(face);
  }
  return out;
}

}  // namespace littoral
