#include "domain/mesh/split_at_jumps.h"

#include <map>
#include <utility>

namespace littoral {

SplitSurface split_at_jumps(const SurfaceMesh& mesh, const Rows<std::int64_t, 3>& key) {
  SplitSurface split;
  std::map<std::pair<int, std::int64_t>, int> vertex;
  for (int f = 0; f < mesh.n_faces(); ++f) {
    int corners[3];
    for (int k = 0; k < 3; ++k) {
      const auto [it, added] =
          vertex.try_emplace({mesh.face(f)[k], key(f, k)}, split.corner.size());
      if (added) split.corner.push_back({f, k});
      corners[k] = it->second;
    }
    split.soup.add_face(corners);
  }
  split.soup.points.resize(split.corner.size(), 3);
  for (std::size_t v = 0; v < split.corner.size(); ++v)
    split.soup.points.row(v) = mesh.point(mesh.face(split.corner[v][0])[split.corner[v][1]]);
  return split;
}

}  // namespace littoral
