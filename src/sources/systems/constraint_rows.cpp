#include "sources/systems/constraint_rows.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/index.h"

namespace littoral {

SpMat matrix_of_few(Triplets entries, Eigen::Index rows, Eigen::Index columns) {
  std::stable_sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) {
    return std::pair(a.col(), a.row()) < std::pair(b.col(), b.row());
  });
  SpMat out(rows, columns);
  out.resizeNonZeros(index(entries.size()));
  int* begin = out.outerIndexPtr();
  int n = 0, column = 0;
  for (const auto& entry : entries) {
    for (; column <= entry.col(); ++column) begin[column] = n;
    if (n > begin[entry.col()] && out.innerIndexPtr()[n - 1] == entry.row()) {
      out.valuePtr()[n - 1] += entry.value();
      continue;
    }
    out.innerIndexPtr()[n] = entry.row();
    out.valuePtr()[n++] = entry.value();
  }
  std::fill(begin + column, begin + columns + 1, n);
  out.resizeNonZeros(n);
  return out;
}

int SourceNodes::id(const SurfacePoint& p) {
  const auto key = p.on == SurfacePoint::On::vertex
                       ? std::make_tuple(0, p.element, std::array<double, 3>{1, 0, 0})
                       : std::make_tuple(int(p.on), p.element, p.b);
  const auto [it, added] = ids_.try_emplace(key, points.size());
  if (added) {
    points.push_back(p);
    weight.push_back(0);
    value.push_back(infinity);
    joined_.add();
  }
  return it->second;
}

std::vector<std::pair<int, double>> hats(const SurfaceMesh& mesh, const SurfacePoint& p) {
  switch (p.on) {
    case SurfacePoint::On::vertex:
      return {{p.element, 1.0}};
    case SurfacePoint::On::edge:
      return {{mesh.edges()(p.element, 0), p.b[0]}, {mesh.edges()(p.element, 1), p.b[1]}};
    case SurfacePoint::On::face:
      break;
  }
  const auto c = mesh.face(p.element);
  return {{c[0], p.b[0]}, {c[1], p.b[1]}, {c[2], p.b[2]}};
}

void ConstraintRowBuilder::end_run() {
  double total = 0;
  for (const Row& piece : run_) total += piece.weight;
  const double block = total / std::max(1.0, std::round(total / 2.5));
  double passed = 0;
  int blocks = -1;
  for (const Row& piece : run_) {
    const int at = static_cast<int>((passed + 0.5 * piece.weight) / block);
    if (at != blocks) rows_.push_back({{}, 0, piece.node, 0});
    blocks = at;
    for (const auto& [v, value] : piece.entries)
      rows_.back().entries.emplace_back(v, piece.weight * value);
    rows_.back().weight += piece.weight;
    rows_.back().value += piece.weight * piece.value;
    passed += piece.weight;
  }
  run_.clear();
}

void ConstraintRowBuilder::write(const SurfaceMesh& mesh, SourceNodes& nodes,
                                 SourceSystem& system) {
  end_run();
  for (std::size_t i = 0; i < nodes.points.size(); ++i)
    if (nodes.weight[i] > 0)
      rows_.push_back({hats(mesh, nodes.points[i]), nodes.weight[i], static_cast<int>(i),
                       nodes.weight[i] * nodes.value[i]});
  Triplets entries;
  std::map<int, int> group_of_root;
  system.weight.resize(rows_.size());
  system.value.resize(rows_.size());
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    double sum = 0;  // a mean, whatever the coefficients were weighted with
    for (const auto& [v, value] : rows_[r].entries) sum += value;
    for (const auto& [v, value] : rows_[r].entries) entries.emplace_back(r, v, value / sum);
    system.weight[r] = rows_[r].weight;
    system.value[r] = rows_[r].value / rows_[r].weight;
    const auto [it, added] = group_of_root.try_emplace(nodes.root(rows_[r].node), system.n_groups);
    if (added) ++system.n_groups;
    system.group.push_back(it->second);
  }
  system.A = matrix_of_few(std::move(entries), index(rows_.size()), mesh.n_vertices());
}

}  // namespace littoral
