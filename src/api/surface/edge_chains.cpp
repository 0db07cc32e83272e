#include "api/surface/edge_chains.h"

#include <cmath>
#include <map>

namespace littoral {

std::vector<std::vector<int>> edge_chains(const SurfaceMesh& mesh, const VecX& times) {
  std::multimap<int, int> out;  // vertex -> next
  std::map<int, int> surplus;
  for (int e = 0; e < mesh.n_edges(); ++e) {
    const long n = std::lround(std::abs(times[e]));
    for (long i = 0; i < n; ++i) {
      const int a = mesh.edges()(e, times[e] > 0 ? 0 : 1);
      const int b = mesh.edges()(e, times[e] > 0 ? 1 : 0);
      out.emplace(a, b);
      ++surplus[a];
      --surplus[b];
    }
  }
  std::vector<std::vector<int>> lines;
  const auto follow = [&](int v) {
    std::vector<int>& line = lines.emplace_back(1, v);
    for (auto it = out.find(v); it != out.end(); it = out.find(v)) {
      v = it->second;
      out.erase(it);
      line.push_back(v);
    }
  };
  for (const auto& [v, n] : surplus)  // ends of open curves first
    for (int i = 0; i < n; ++i) follow(v);
  while (!out.empty()) follow(out.begin()->first);
  return lines;
}

}  // namespace littoral
