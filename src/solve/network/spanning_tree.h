#pragma once
// Spanning forests, and a rooted tree whose branches can be hung elsewhere.

#include <algorithm>
#include <vector>

namespace littoral {

/// A spanning forest of a graph: each tree rooted at its lowest node.
struct Forest {
  std::vector<int> parent_arc;  // nodes; -1 at roots
  std::vector<int> order;       // nodes, parents before children
};

/// The forest that taking arcs in `order`, unless they close a cycle, gives.
Forest spanning_forest(int n_nodes, const std::vector<int>& tail, const std::vector<int>& head,
                       const std::vector<int>& order);

/// A tree whose arcs are exchanged one at a time, always by moving the smaller part. The root is
/// node n - 1 at first and changes as parts move.
class RootedTree {
 public:
  explicit RootedTree(int n) : node_(n) {}

  int parent(int u) const { return node_[u].parent; }
  int arc(int u) const { return node_[u].arc; }  // to the parent

  /// The first tree: hangs every node of `order`, parents before children, below parent_of(u) by
  /// arc_of(u).
  template <class ParentOf, class ArcOf>
  void build(const std::vector<int>& order, const ParentOf& parent_of, const ArcOf& arc_of) {
    for (const int u : order) hang(u, parent_of(u), arc_of(u));
    for (auto u = order.rbegin(); u != order.rend(); ++u)
      node_[node_[*u].parent].size += node_[*u].size;
  }

  /// The deepest node that is above (or is) both.
  int join(int a, int b) const {
    while (a != b) {
      if (node_[a].depth < node_[b].depth)
        b = node_[b].parent;
      else
        a = node_[a].parent;
    }
    return a;
  }

  /// Cuts the arc above `out` and joins `below`, in the branch cut off, to `above`, in the rest, by
  /// another arc. Calls moved(u, top) for every node of the part that moves, `top` being the one of
  /// the two in it, which it returns.
  template <class Moved>
  int exchange(int out, int below, int above, int arc, const Moved& moved) {
    const int old_parent = node_[out].parent, size = node_[out].size;
    unlink(out);
    node_[out].parent = -1;
    grow(old_parent, -size);
    int rest = above;
    while (node_[rest].parent >= 0) rest = node_[rest].parent;
    const bool branch_moves = size <= node_[rest].size;
    const int moves = branch_moves ? below : above, stays = branch_moves ? above : below;
    turn(moves);
    hang(moves, stays, arc);
    grow(stays, node_[moves].size);
    for_subtree(moves, [&](int v) {
      node_[v].depth = node_[node_[v].parent].depth + 1;
      moved(v, moves);
    });
    return moves;
  }

  /// Calls visit(u) for the node and all below it, parents first.
  template <class Visit>
  void for_subtree(int top, const Visit& visit) const {
    int u = top;
    while (true) {
      visit(u);
      if (node_[u].first_child >= 0) {
        u = node_[u].first_child;
        continue;
      }
      while (u != top && node_[u].next < 0) u = node_[u].parent;
      if (u == top) return;
      u = node_[u].next;
    }
  }

 private:
  struct Node {
    int parent = -1, arc = -1, depth = 0;
    int size = 1;                                  // of the branch
    int first_child = -1, next = -1, before = -1;  // children of one parent form a list
  };

  void hang(int u, int parent, int arc) {
    node_[u].arc = arc;
    node_[u].parent = parent;
    node_[u].depth = node_[parent].depth + 1;
    link(u);
  }

  void grow(int u, int by) {
    for (; u >= 0; u = node_[u].parent) node_[u].size += by;
  }

  /// Makes a node the top of its part, turning the arcs on its way up.
  void turn(int top) {
    std::vector<int>& way = way_;
    way.clear();
    for (int u = top; u >= 0; u = node_[u].parent) way.push_back(u);
    for (std::size_t i = 0; i + 1 < way.size(); ++i) unlink(way[i]);
    const int size = node_[way.back()].size;
    for (std::size_t i = way.size() - 1; i > 0; --i) {
      Node& node = node_[way[i]];
      node.size = size - node_[way[i - 1]].size;
      node.parent = way[i - 1];
      node.arc = node_[way[i - 1]].arc;
      link(way[i]);
    }
    node_[top].size = size;
    node_[top].parent = -1;
  }

  void link(int u) {
    Node& node = node_[u];
    Node& parent = node_[node.parent];
    node.before = -1;
    node.next = parent.first_child;
    if (node.next >= 0) node_[node.next].before = u;
    parent.first_child = u;
  }
  void unlink(int u) {
    const Node& node = node_[u];
    if (node.before >= 0)
      node_[node.before].next = node.next;
    else
      node_[node.parent].first_child = node.next;
    if (node.next >= 0) node_[node.next].before = node.before;
  }

  std::vector<Node> node_;
  std::vector<int> way_;
};

}  // namespace littoral
