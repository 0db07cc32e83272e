#include "domain/mesh/split_at_jumps.h"

#include <map>
#include <utility>

namespace littoral {

SplitSurface split_at_jumps(const SurfaceMesh& mesh, const Rows<std::int64_t, 3>& key) {
  SplitSurface torn;
  std::map<std::pair<int, std::int64_t>, int> vertex;
  for (int f = 0; f < mesh.n_faces(); ++f) {
    int corners[3];
    for (int k = 0; k < 3; ++k) {
      const auto [it, added] = vertex.try_emplace({mesh.face(f)[k], key(f, k)}, torn.corner.size());
      if (added) torn.corner.push_back({f, k});
      corners[k] = it->second;
    }
    torn.soup.add_face(corners);
  }
  torn.soup.points.resize(torn.corner.size(), 3);
  for (std::size_t v = 0; v < torn.corner.size(); ++v)
    torn.soup.points.row(v) = mesh.point(mesh.face(torn.corner[v][0])[torn.corner[v][1]]);
  return torn;
}

}  // namespace littoral
