#include "sources/tet_source_system.h"

#include <algorithm>
#include <map>
#include <utility>

namespace littoral {

TetSourceSystem tet_source_system(const TetMesh& mesh, const TetOperators& ops,
                                  const OrientedPoints& source, const std::vector<TetPoint>& places,
                                  const std::vector<int>& group, const std::vector<int>& part) {
  TetSourceSystem system;
  system.X0 = MatX3::Zero(ops.n_faces, 3);
  std::map<std::pair<int, int>, int> row_of;  // group and part -> row
  std::vector<double> weight;
  Triplets entries;
  for (Eigen::Index i = 0; i < source.size(); ++i) {
    const TetPoint& p = places[i];
    if (p.tet < 0 || ops.volumes[p.tet] == 0) {
      ++system.outside;
      continue;
    }
    const double area = source.areas[i];
    const auto [at, is_new] =
        row_of.try_emplace({group[i], part.empty() ? 0 : part[i]}, row_of.size());
    if (is_new) weight.push_back(0);
    if (is_new && !part.empty()) system.part.push_back(part[i]);
    weight[at->second] += area;
    for (int k = 0; k < 4; ++k) {
      const double lambda = p.barycentric[k];
      // phi of the face opposite corner k is 1 - 3 lambda_k.
      system.X0.row(ops.tet_faces(p.tet, k)) += area * (1 - 3 * lambda) * source.normals.row(i);
      entries.emplace_back(at->second, mesh.tets(p.tet, k), area * lambda);
    }
  }
  system.weight = Eigen::Map<const VecX>(weight.data(), weight.size());
  for (auto& e : entries) e = {e.row(), e.col(), e.value() / weight[e.row()]};
  system.A.resize(system.weight.size(), mesh.n_vertices());
  system.A.setFromTriplets(entries.begin(), entries.end());
  return system;
}

TetSourceSystem vertex_source_system(const TetOperators& ops, std::vector<int> vertices) {
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  TetSourceSystem system;
  Triplets entries;
  for (int v : vertices)
    if (ops.component[v] >= 0) entries.emplace_back(entries.size(), v, 1);
  system.weight = VecX::Ones(entries.size());
  system.A.resize(system.weight.size(), ops.L.rows());
  system.A.setFromTriplets(entries.begin(), entries.end());
  return system;
}

}  // namespace littoral
