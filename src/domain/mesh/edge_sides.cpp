#include "domain/mesh/edge_sides.h"

namespace littoral {

EdgeSides edge_sides(const IntrinsicTriangulation& T) {
  EdgeSides list;
  list.offsets.assign(T.n_edges() + 1, 0);
  for (int f = 0; f < T.n_faces(); ++f)
    for (int k = 0; k < 3; ++k) ++list.offsets[T.side_edge(f, k) + 1];
  for (int e = 0; e < T.n_edges(); ++e) list.offsets[e + 1] += list.offsets[e];
  list.sides.resize(list.offsets.back());
  std::vector<int> next(list.offsets.begin(), list.offsets.end() - 1);
  for (int f = 0; f < T.n_faces(); ++f)
    for (int k = 0; k < 3; ++k) list.sides[next[T.side_edge(f, k)]++] = {f, k};
  return list;
}

}  // namespace littoral
