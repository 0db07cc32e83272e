#include "domain/mesh/edge_sides.h"

namespace littoral {

EdgeSides edge_sides(const IntrinsicTriangulation& T) {
  return groups_of<TriangleSide>(std::size_t(T.n_edges()), [&](const auto& put) {
    for (int f = 0; f < T.n_faces(); ++f)
      for (int k = 0; k < 3; ++k) put(T.side_edge(f, k), TriangleSide{f, k});
  });
}

}  // namespace littoral
