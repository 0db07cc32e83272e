#pragma once
// Curves for studies: nodal lines of low eigenfunctions, whole and damaged.

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "contour/isolines.h"
#include "littoral/sources.h"
#include "operators/calculus.h"
#include "solve/poisson/poisson.h"

namespace littoral {

/// The first eigenfunctions of L u = lambda M u after the constant, by subspace iteration.
inline std::vector<VecX> eigenfunctions(const Operators& ops, int count) {
  const Calculus& C = ops.scalar;
  const Poisson poisson(C.L, C.component, C.n_components, {});
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  std::vector<VecX> U(static_cast<std::size_t>(count) + 4, VecX(C.M.size()));
  for (VecX& u : U)
    for (double& x : u) x = normal(random);
  Report unused;
  for (int step = 0; step < 60; ++step) {
    for (std::size_t i = 0; i < U.size(); ++i) {
      VecX b = C.M.cwiseProduct(U[i]);
      b -= C.M * (b.sum() / C.M.sum());
      VecX u = poisson.solve(b, unused);
      u.array() -= C.M.dot(u) / C.M.sum();
      for (std::size_t j = 0; j < i; ++j) u -= U[j] * U[j].dot(C.M.cwiseProduct(u));
      U[i] = u / std::sqrt(u.dot(C.M.cwiseProduct(u)));
    }
  }
  U.resize(static_cast<std::size_t>(count));
  return U;
}

/// Isolines as signed curves.
inline Sources whole(const std::vector<Polyline>& lines) {
  Sources sources;
  for (const Polyline& line : lines) {
    Curve curve{line.nodes, true, "nodal line"};
    if (line.closed) curve.nodes.push_back(curve.nodes.front());
    if (curve.nodes.size() > 1) sources.curves.push_back(std::move(curve));
  }
  return sources;
}

/// Cuts every curve into runs of 4 to 12 segments, drops a share of them and reverses another.
inline Sources damaged(const Sources& sources, double drop, double reverse, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(0, 1);
  Sources out;
  for (const Curve& curve : sources.curves) {
    for (std::size_t i = 0; i + 1 < curve.nodes.size();) {
      const std::size_t end = std::min(curve.nodes.size() - 1, i + 4 + random() % 9);
      const bool first = out.curves.empty() && end + 1 == curve.nodes.size();  // keep at least one
      const bool dropped = u(random) < drop && !first, reversed = u(random) < reverse;
      Curve run{{curve.nodes.begin() + static_cast<std::ptrdiff_t>(i),
                 curve.nodes.begin() + static_cast<std::ptrdiff_t>(end) + 1},
                true,
                curve.origin};
      if (reversed) std::reverse(run.nodes.begin(), run.nodes.end());
      if (!dropped) out.curves.push_back(std::move(run));
      i = end;
    }
  }
  return out;
}

}  // namespace littoral
