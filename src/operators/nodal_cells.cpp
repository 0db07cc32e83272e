#include "operators/nodal_cells.h"

#include <algorithm>
#include <tuple>

#include "base/parallel.h"

namespace littoral {

namespace {

constexpr std::size_t patch_grain = 4096;  // patches

VecXc as_complex(const VecX& x) {
  return Eigen::Map<const VecXc>(reinterpret_cast<const Complex*>(x.data()), x.size() / 2);
}

VecX as_pairs(const VecXc& z) {
  return Eigen::Map<const VecX>(reinterpret_cast<const double*>(z.data()), 2 * z.size());
}

}  // namespace

NodalCells::NodalCells(const NodalSurface& S)
    : P_(S.P),
      corner_(S.cells->faces.matrix()),
      slope_(corner_.rows(), 3),
      to_frame_(corner_.rows()),
      cell_offsets_(S.patch_offsets),
      node_offsets_{0} {
  const IntrinsicTriangulation& T = *S.cells;
  // The gradient of a hat function is the opposite side, turned inward, over twice the area; with
  // corner 0 at 0 and corner 1 at x, those of corners 1 and 2 are turned -p2 and turned x.
  for (int c = 0; c < T.n_faces(); ++c) {
    const TriangleShape t = T.shape(c);
    const double inward = T.orientation[c] / (2 * t.area);
    slope_.row(c) << inward * t.p[2].imag(), -inward * t.p[2].real(), inward * t.p[1].real();
  }
}

void NodalCells::add_patch(const std::vector<int>& nodes, const VecXc& turn, const VecXc& axes) {
  to_frame_.segment(cell_offsets_[n_patches()], axes.size()) = axes.conjugate();
  node_.insert(node_.end(), nodes.begin(), nodes.end());
  turn_.insert(turn_.end(), turn.data(), turn.data() + turn.size());
  node_offsets_.push_back(node_.size());
}

LinearMap NodalCells::gradient(std::shared_ptr<const NodalCells> cells) {
  LinearMap G{2 * cells->n_cells(), cells->n_nodes(), {}, {}, {}};
  G.apply = [cells](const VecX& u) {
    const VecX v = cells->P_ * u;
    VecX g(2 * cells->n_cells());
    parallel_for(cells->n_cells(), patch_grain, [&](std::size_t begin, std::size_t end) {
      for (Eigen::Index c = begin; c < Eigen::Index(end); ++c) {
        const auto corner = cells->corner_.row(c);
        const auto s = cells->slope_.row(c);
        const double v1 = v[corner[1]] - v[corner[0]], v2 = v[corner[2]] - v[corner[0]];
        g[2 * c] = v1 * s[0];
        g[2 * c + 1] = v1 * s[1] + v2 * s[2];
      }
    });
    return g;
  };
  G.adjoint = [cells](const VecX& g) {
    VecX v = VecX::Zero(cells->P_.rows());
    for (Eigen::Index c = 0; c < cells->n_cells(); ++c) {
      const auto corner = cells->corner_.row(c);
      const auto s = cells->slope_.row(c);
      const double v1 = s[0] * g[2 * c] + s[1] * g[2 * c + 1], v2 = s[2] * g[2 * c + 1];
      v[corner[0]] -= v1 + v2;
      v[corner[1]] += v1;
      v[corner[2]] += v2;
    }
    return VecX(cells->P_.transpose() * v);
  };
  G.matrix = [cells] {
    Triplets entries;
    for (int c = 0; c < cells->n_cells(); ++c) {
      const auto corner = cells->corner_.row(c);
      const auto s = cells->slope_.row(c);
      for (const auto& [row, k, value] : {std::tuple(0, 1, s[0]),
                                          {0, 0, -s[0]},
                                          {1, 1, s[1]},
                                          {1, 2, s[2]},
                                          {1, 0, -s[1] - s[2]}})
        for (Interpolation::InnerIterator it(cells->P_, corner[k]); it; ++it)
          entries.emplace_back(2 * c + row, it.col(), value * it.value());
    }
    SpRows matrix(2 * cells->n_cells(), cells->n_nodes());
    matrix.setFromTriplets(entries.begin(), entries.end());
    return matrix;
  };
  return G;
}

void NodalCells::mean_in_patch(int p, const VecXc& X, std::vector<Complex>& in_patch,
                               VecXc& Y) const {
  const int* node = node_.data() + node_offsets_[p];
  const Complex* turn = turn_.data() + node_offsets_[p];
  const int n = node_offsets_[p + 1] - node_offsets_[p];
  in_patch.resize(n);
  for (int i = 0; i < n; ++i) in_patch[i] = turn[i] * X[node[i]];
  int known = -1;  // the vertex between nodes at which the vector is known:
  Complex between;
  auto at = [&](int v) {
    int i = 0;
    if (v < n_nodes()) {
      while (node[i] != v) ++i;
      return in_patch[i];
    }
    if (v == known) return between;
    known = v;
    between = 0;
    for (Interpolation::InnerIterator it(P_, v); it; ++it) {
      while (node[i] != it.col()) ++i;
      between += it.value() * in_patch[i];
    }
    return between;
  };
  for (int c = cell_offsets_[p]; c < cell_offsets_[p + 1]; ++c) {
    const Complex sum = at(corner_(c, 0)) + at(corner_(c, 1)) + at(corner_(c, 2));
    Y[c] = to_frame_[c] * sum / 3.0;
  }
}

LinearMap NodalCells::mean(std::shared_ptr<const NodalCells> cells) {
  LinearMap Q{2 * cells->n_cells(), 2 * cells->n_nodes(), {}, {}, {}};
  Q.apply = [cells](const VecX& x) {
    const VecXc X = as_complex(x);
    VecXc Y(cells->n_cells());
    parallel_for(cells->n_patches(), patch_grain, [&](std::size_t begin, std::size_t end) {
      std::vector<Complex> in_patch;
      for (std::size_t p = begin; p < end; ++p) cells->mean_in_patch(p, X, in_patch, Y);
    });
    return as_pairs(Y);
  };
  return Q;
}

}  // namespace littoral
