#include "sources/space/tet_source_system.h"

#include <map>
#include <utility>

#include "sources/space/tet_source_values.h"

namespace littoral {

TetSourceSystem tet_source_system(const TetMesh& mesh, const TetOperators& ops,
                                  const OrientedPoints& source, const std::vector<TetPoint>& places,
                                  const std::vector<int>& group, const std::vector<int>& part,
                                  const std::vector<double>& value) {
  TetSourceSystem system;
  system.X0 = MatX3::Zero(ops.n_faces, 3);
  std::map<std::pair<int, int>, int> row_of;  // group and part -> row
  std::vector<double> weight, valued;
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
    if (is_new) {
      weight.push_back(0);
      valued.push_back(0);
    }
    if (is_new && !part.empty()) system.part.push_back(part[i]);
    weight[at->second] += area;
    if (!value.empty()) valued[at->second] += area * value[i];
    for (int k = 0; k < 4; ++k) {
      const double lambda = p.barycentric[k];
      // phi of the face opposite corner k is 1 - 3 lambda_k.
      system.X0.row(ops.tet_faces(p.tet, k)) += area * (1 - 3 * lambda) * source.normals.row(i);
      entries.emplace_back(at->second, mesh.tets(p.tet, k), area * lambda);
    }
  }
  system.weight = Eigen::Map<const VecX>(weight.data(), weight.size());
  system.value = Eigen::Map<const VecX>(valued.data(), valued.size()).cwiseQuotient(system.weight);
  for (auto& e : entries) e = {e.row(), e.col(), e.value() / weight[e.row()]};
  system.A.resize(system.weight.size(), mesh.n_vertices());
  system.A.setFromTriplets(entries.begin(), entries.end());
  return system;
}

TetSourceSystem vertex_source_system(const TetOperators& ops, std::vector<int> vertices,
                                     std::vector<double> values) {
  merge_vertices(vertices, values);
  TetSourceSystem system;
  Triplets entries;
  system.value = VecX::Zero(vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (ops.component[vertices[i]] < 0) continue;
    if (!values.empty()) system.value[entries.size()] = values[i];
    entries.emplace_back(entries.size(), vertices[i], 1);
  }
  system.value.conservativeResize(entries.size());
  system.weight = VecX::Ones(entries.size());
  system.A.resize(system.weight.size(), ops.L.rows());
  system.A.setFromTriplets(entries.begin(), entries.end());
  return system;
}

}  // namespace littoral
