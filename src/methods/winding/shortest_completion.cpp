#include "methods/winding/shortest_completion.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/disjoint_sets.h"
#include "littoral/error.h"
#include "methods/winding/surface_winding.h"

namespace littoral {

namespace {

/// The components, with those that pairs connect as one: winding numbers hold across these.
std::vector<int> parts_of_faces(const JumpCalculus& J, const std::vector<FacePair>& pairs,
                                int& n_parts) {
  DisjointSets components(J.n_components);
  for (const FacePair& p : pairs) components.join(J.component[p.left], J.component[p.right]);
  const std::vector<int> number = components.numbered(n_parts);
  std::vector<int> part(J.component.size());
  for (std::size_t f = 0; f < part.size(); ++f) part[f] = number[J.component[f]];
  return part;
}

/// Labels by walking from face to face; `bounds` (parts) says where that went without
/// contradiction.
VecXi walked_labels(const JumpCalculus& J, const VecX& curve, const std::vector<FacePair>& pairs,
                    const std::vector<int>& part, std::vector<char>& bounds) {
  constexpr int unknown = std::numeric_limits<int>::min();
  VecXi label = VecXi::Constant(J.n_faces, unknown);
  std::vector<std::vector<int>> sheets(std::size_t(J.n_faces));
  for (const FacePair& p : pairs) {
    sheets[p.left].push_back(p.right);
    sheets[p.right].push_back(p.left);
  }
  std::vector<int> open;
  const auto meet = [&](int f, int value) {
    if (label[f] == unknown) {
      label[f] = value;
      open.push_back(f);
    } else if (label[f] != value) {
      bounds[part[f]] = 0;
    }
  };
  for (int seed = 0; seed < J.n_faces; ++seed) {
    if (label[seed] != unknown) continue;
    meet(seed, 0);
    while (!open.empty()) {
      const int f = open.back();
      open.pop_back();
      for (int k = 0; k < 3; ++k) {
        const int e = J.edge(f, k);
        if (!J.interior(e)) continue;
        const auto& [left, right] = J.sides[e];
        const int jump = static_cast<int>(std::lround(curve[e]));
        if (left.face == right.face) {
          if (jump != 0) bounds[part[f]] = 0;
        } else if (left.face == f) {
          meet(right.face, label[f] - jump);
        } else {
          meet(left.face, label[f] + jump);
        }
      }
      for (int g : sheets[f]) meet(g, label[f]);
    }
  }
  return label;
}

/// How many nodes inside a part are met by the curve an odd number of times.
void count_ends(const JumpCalculus& J, const VecX& curve, ShortestCompletion& out) {
  std::vector<long> met(std::size_t(J.n_nodes), 0);
  std::vector<char> on_boundary(met.size(), 0);
  for (int e = 0; e < J.n_edges; ++e)
    for (const JumpCalculus::Side& side : J.sides[e]) {
      if (side.face < 0) continue;
      for (const int corner : J.ends(side)) {
        const int node = J.node(side.face, corner);
        met[node] += std::lround(std::abs(curve[e]));
        if (!J.interior(e)) on_boundary[node] = 1;
      }
    }
  std::vector<char> counted(met.size(), 0);
  for (int f = 0; f < J.n_faces; ++f)
    for (int k = 0; k < 3; ++k) {
      const int node = J.node(f, k);
      if (counted[node]++ || on_boundary[node]) continue;
      if (met[node] / 2 % 2 != 0) ++out.parts[out.part[f]].ends;  // both sides of an edge count
    }
}

}  // namespace

ShortestCompletion shortest_completion(const JumpCalculus& J, const VecX& curve, Complete which,
                                       double curve_weight, const Task& task, Report& report) {
  for (int e = 0; e < J.n_edges; ++e)
    if (curve[e] != 0 && !J.manifold[e])
      throw UnsupportedError("a curve runs along an edge where more than two faces meet");
  const std::vector<FacePair> pairs = pairs_at_nonmanifold_edges(J);
  ShortestCompletion out;
  int n_parts = 0;
  out.part = parts_of_faces(J, pairs, n_parts);
  std::vector<char> bounds(std::size_t(n_parts), 1);
  out.region = walked_labels(J, curve, pairs, out.part, bounds);
  out.parts.resize(std::size_t(n_parts));
  count_ends(J, curve, out);
  bool any = false;
  for (int c = 0; c < n_parts; ++c) {
    auto& part = out.parts[c];
    part.solved =
        bounds[c] || which == Complete::all || (which == Complete::without_ends && part.ends == 0);
    any = any || (part.solved && !bounds[c]);
  }
  if (any) {
    const VecX weight =
        (curve.array() != 0).select(curve_weight * J.length.array(), J.length.array());
    const VecXi cut = cut_labels(J, curve, pairs, weight, task, report);
    for (int f = 0; f < J.n_faces; ++f)
      if (!bounds[out.part[f]] && out.parts[out.part[f]].solved) out.region[f] = cut[f];
  }
  std::vector<int> least(std::size_t(n_parts), std::numeric_limits<int>::max());
  for (int f = 0; f < J.n_faces; ++f)
    least[out.part[f]] = std::min(least[out.part[f]], out.region[f]);
  for (int f = 0; f < J.n_faces; ++f) {
    const int c = out.part[f];
    out.region[f] -= least[c];
    out.parts[c].largest = std::max(out.parts[c].largest, out.region[f]);
  }
  out.jump = VecX::Zero(J.n_edges);
  for (int e = 0; e < J.n_edges; ++e) {
    const auto& [left, right] = J.sides[e];
    const int known = left.face >= 0 ? left.face : right.face;
    if (known < 0) continue;
    auto& part = out.parts[out.part[known]];
    const double given = std::round(curve[e]);
    part.given += std::abs(given) * J.length[e];
    if (!J.interior(e)) continue;
    if (!part.solved) continue;
    const double jump = out.region[left.face] - out.region[right.face];
    out.jump[e] = jump;
    if (given == 0) {
      part.added += std::abs(jump) * J.length[e];
    } else if (jump != given) {
      part.overruled += J.length[e];
    }
  }
  for (const FacePair& p : pairs)
    out.parts[out.part[p.left]].added +=
        std::abs(out.region[p.left] - out.region[p.right]) * J.length[p.edge];
  return out;
}

}  // namespace littoral
