#include "solve/network/spanning_tree.h"

#include "base/disjoint_sets.h"

namespace littoral {

Forest spanning_forest(int n_nodes, const std::vector<int>& tail, const std::vector<int>& head,
                       const std::vector<int>& order) {
  DisjointSets joined(n_nodes);
  std::vector<int> taken, offset(n_nodes + 1, 0);
  for (int e : order) {
    if (!joined.join(tail[e], head[e])) continue;
    taken.push_back(e);
    ++offset[tail[e] + 1];
    ++offset[head[e] + 1];
  }
  for (int u = 0; u < n_nodes; ++u) offset[u + 1] += offset[u];
  std::vector<int> arcs(2 * taken.size()), at(offset.begin(), offset.end() - 1);
  for (int e : taken) {
    arcs[at[tail[e]]++] = e;
    arcs[at[head[e]]++] = e;
  }
  Forest forest;
  forest.parent_arc.assign(n_nodes, -1);
  forest.order.reserve(n_nodes);
  std::vector<char> seen(n_nodes, 0);
  for (int root = 0; root < n_nodes; ++root) {
    if (seen[root]) continue;
    seen[root] = 1;
    std::size_t i = forest.order.size();
    forest.order.push_back(root);
    for (; i < forest.order.size(); ++i) {
      const int u = forest.order[i];
      for (int k = offset[u]; k < offset[u + 1]; ++k) {
        const int v = tail[arcs[k]] == u ? head[arcs[k]] : tail[arcs[k]];
        if (seen[v]) continue;
        seen[v] = 1;
        forest.parent_arc[v] = arcs[k];
        forest.order.push_back(v);
      }
    }
  }
  return forest;
}

}  // namespace littoral
