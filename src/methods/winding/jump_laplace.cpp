#include "methods/winding/jump_laplace.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/disjoint_sets.h"
#include "solve/poisson/poisson.h"

namespace littoral {

namespace {

/// Goes round one node from a corner, adding up jumps; false if they contradict each other.
bool walk_round(const JumpCalculus& J, const VecX& jump, int face, int corner, MatX3& offset,
                std::vector<char>& seen) {
  std::vector<std::pair<int, int>> fan{{face, corner}};
  seen[3 * face + corner] = 1;
  bool consistent = true;
  for (std::size_t i = 0; i < fan.size(); ++i) {
    const auto [f, c] = fan[i];
    for (const int k : {c, (c + 2) % 3}) {  // the two sides at the corner
      const JumpCalculus::Side at = J.across(f, k);
      if (at.face < 0) continue;
      const int e = J.edge(f, k), d = J.corner_across(f, c, at);
      const JumpCalculus::Side& left = J.sides[e][0];
      const bool leaves_left = left.face == f && left.k == k;
      const double value = offset(f, c) + (leaves_left ? -jump[e] : jump[e]);
      if (seen[3 * at.face + d]) {
        if (std::abs(offset(at.face, d) - value) > 1e-6) consistent = false;
        continue;
      }
      seen[3 * at.face + d] = 1;
      offset(at.face, d) = value;
      fan.emplace_back(at.face, d);
    }
  }
  if (!consistent)
    for (const auto& [f, c] : fan) offset(f, c) = 0;
  return consistent;
}

/// The unknown of every node: its own, or one for each stretch of the boundary.
std::vector<int> unknowns(const JumpCalculus& J, const VecX& jump, Boundary boundary) {
  DisjointSets sets(J.n_nodes);
  std::vector<char> touched(J.n_nodes, 0);
  for (int f = 0; f < J.n_faces; ++f)
    for (int k = 0; k < 3; ++k)
      if (jump[J.edge(f, k)] != 0) touched[J.node(f, k)] = touched[J.node(f, (k + 1) % 3)] = 1;
  for (int f = 0; f < J.n_faces && boundary == Boundary::level; ++f)
    for (int k = 0; k < 3; ++k) {
      const int i = J.node(f, k), j = J.node(f, (k + 1) % 3);
      const bool alone = J.manifold[J.edge(f, k)] && !J.interior(J.edge(f, k));
      if (alone && !touched[i] && !touched[j]) sets.join(i, j);
    }
  std::vector<int> unknown(touched.size());
  for (int i = 0; i < J.n_nodes; ++i) unknown[i] = sets.find(i);
  return unknown;
}

/// Connected parts of the unknowns, -1 for those of open nodes and of none.
std::vector<int> parts(const JumpCalculus& J, const std::vector<int>& unknown,
                       const std::vector<char>& open, int& n) {
  DisjointSets sets(J.n_nodes);
  for (int f = 0; f < J.n_faces; ++f)
    for (int k = 0; k < 3; ++k) {
      const int i = J.node(f, k), j = J.node(f, (k + 1) % 3);
      if (!open[i] && !open[j]) sets.join(unknown[i], unknown[j]);
    }
  std::vector<int> part(J.n_nodes, -1);
  n = 0;
  for (int i = 0; i < J.n_nodes; ++i)
    if (!open[i] && unknown[i] == i) part[i] = sets.find(i) == i ? n++ : part[sets.find(i)];
  return part;
}

/// Mean 0 over each component, by area; at open corners the mean of the face's other corners.
void finish(const JumpCalculus& J, CornerFunction& f) {
  VecX sum = VecX::Zero(J.n_components), area = sum;
  for (int t = 0; t < J.n_faces; ++t) {
    double values = 0;
    int count = 0;
    for (int k = 0; k < 3; ++k)
      if (!f.open[J.node(t, k)]) {
        values += f.u(t, k);
        ++count;
      }
    const double mean = count ? values / count : 0;
    for (int k = 0; k < 3; ++k)
      if (f.open[J.node(t, k)]) f.u(t, k) = mean;
    if (!count) continue;
    sum[J.component[t]] += J.area[t] * mean;
    area[J.component[t]] += J.area[t];
  }
  for (int t = 0; t < J.n_faces; ++t) {
    const int c = J.component[t];
    if (area[c] > 0) f.u.row(t).array() -= sum[c] / area[c];
  }
}

}  // namespace

CornerFunction jump_offsets(const JumpCalculus& J, const VecX& jump) {
  CornerFunction offset{MatX3::Zero(J.n_faces, 3), std::vector<char>(J.n_nodes, 0)};
  std::vector<char> seen(3 * std::size_t(J.n_faces), 0);
  for (int e = 0; e < J.n_edges; ++e) {
    if (jump[e] == 0 || !J.interior(e)) continue;
    const JumpCalculus::Side& s = J.sides[e][0];
    for (const int corner : J.ends(s))
      if (!seen[3 * s.face + corner] && !walk_round(J, jump, s.face, corner, offset.u, seen))
        offset.open[J.node(s.face, corner)] = 1;
  }
  return offset;
}

CornerFunction solve_jump_laplace(const JumpCalculus& J, const VecX& jump, const VecXc& field,
                                  Boundary boundary, const Task& task, Report& report) {
  // u = u0 + c with one unknown u0 per node: minimise sum w (u_j - u_i - <field, side>)^2 over the
  // sides of faces.
  CornerFunction u = jump_offsets(J, jump);
  const std::vector<int> unknown = unknowns(J, jump, boundary);
  Triplets entries;
  entries.reserve(9 * std::size_t(J.n_faces));
  VecX b = VecX::Zero(J.n_nodes);
  for (int f = 0; f < J.n_faces; ++f)
    for (int k = 0; k < 3; ++k) {
      const int l = (k + 1) % 3, i = unknown[J.node(f, k)], j = unknown[J.node(f, l)];
      if (i == j || u.open[i] || u.open[j]) continue;
      // Without its open corner a face is no longer positive by itself: its last side must be.
      const bool alone = u.open[J.node(f, (k + 2) % 3)];
      const double w = alone ? std::max(J.weight(f, k), 1e-3) : J.weight(f, k),
                   along = field.size() ? plane::dot(field[f], J.side[f][k]) : 0,
                   c = w * (u.u(f, l) - u.u(f, k) - along);
      entries.emplace_back(i, i, w);
      entries.emplace_back(j, j, w);
      entries.emplace_back(std::max(i, j), std::min(i, j), -w);
      b[i] += c;
      b[j] -= c;
    }
  SpMat L(J.n_nodes, J.n_nodes);
  L.setFromTriplets(entries.begin(), entries.end());
  int n_parts = 0;
  const std::vector<int> part = parts(J, unknown, u.open, n_parts);
  const VecX u0 = Poisson(L, part, n_parts, task).solve(b, report);
  for (int f = 0; f < J.n_faces; ++f)
    for (int k = 0; k < 3; ++k)
      if (!u.open[J.node(f, k)]) u.u(f, k) += u0[unknown[J.node(f, k)]];
  finish(J, u);
  return u;
}

CornerFunction solve_jump_laplace(const JumpCalculus& J, const DelaunayJumps& on, const VecX& jump,
                                  Boundary boundary, const Task& task, Report& report) {
  const CornerFunction fine = solve_jump_laplace(*on.J, on.jump(jump), {}, boundary, task, report);
  CornerFunction u = jump_offsets(J, jump);
  VecX u0(J.n_nodes);
  for (int i = 0; i < J.n_nodes; ++i) {
    const auto& [a, b] = std::pair(on.before[i], on.here[i]);
    u0[i] = fine.u(b.face, b.k) - u.u(a.face, a.k);
  }
  for (int f = 0; f < J.n_faces; ++f)
    for (int k = 0; k < 3; ++k) u.u(f, k) += u0[J.node(f, k)];
  finish(J, u);
  return u;
}

VecX darboux_derivative(const JumpCalculus& J, const CornerFunction& f) {
  VecX omega = VecX::Zero(J.n_edges);
  for (int e = 0; e < J.n_edges; ++e) {
    int count = 0;
    for (const JumpCalculus::Side& s : J.sides[e]) {
      if (s.face < 0) continue;
      const auto [tail, head] = J.ends(s);
      if (f.open[J.node(s.face, tail)] || f.open[J.node(s.face, head)]) continue;
      omega[e] += f.u(s.face, head) - f.u(s.face, tail);
      ++count;
    }
    if (count == 2) omega[e] /= 2;
  }
  return omega;
}

VecX jump_derivative(const JumpCalculus& J, const MatX3& u) {
  VecX jump = VecX::Zero(J.n_edges);
  for (int e = 0; e < J.n_edges; ++e) {
    if (!J.interior(e)) continue;
    const auto& [left, right] = J.sides[e];
    const auto a = J.ends(left), b = J.ends(right);
    for (int end = 0; end < 2; ++end)
      jump[e] += 0.5 * (u(left.face, a[end]) - u(right.face, b[end]));
  }
  return jump;
}

}  // namespace littoral
