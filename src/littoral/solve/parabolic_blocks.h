#pragma once
// The constraints of a parabolic program as blocks A x + b in a cone, and their interior-point
// state.

#include <vector>

#include "littoral/base/parallel.h"
#include "littoral/solve/element_matrix.h"
#include "littoral/solve/lorentz_cone.h"
#include "littoral/solve/parabolic_program.h"

namespace littoral::parabolic {

using lorentz::Vec;

/// q^T x >= |G x|^2 / 4 as (q^T x + tau, sqrt(tau) G x, q^T x - tau) in the cone of D + 2
/// dimensions.
template <int K, int D>
struct SampleBlock {
  static constexpr int N = D + 2;
  using Local = Eigen::Matrix<double, K, 1>;
  typename ParabolicProgram<K, D>::Sample p;
  double root;  // sqrt(tau)

  explicit SampleBlock(const typename ParabolicProgram<K, D>::Sample& sample)
      : p(sample), root(std::sqrt(sample.tau)) {}
  int element() const { return p.element; }
  double size() const { return p.tau; }
  double rank() const { return 2; }  // eigenvalues of the cone
  Vec<N> apply(const Local& x) const {
    Vec<N> r;
    r[0] = r[N - 1] = p.q.dot(x);
    for (int d = 0; d < D; ++d) r[1 + d] = root * p.g[d].dot(x);
    return r;
  }
  Vec<N> offset() const {
    Vec<N> b = Vec<N>::Zero();
    b[0] = p.tau;
    b[N - 1] = -p.tau;
    return b;
  }
  void add_adjoint(const Vec<N>& v, Local& y) const {
    y += (v[0] + v[N - 1]) * p.q;
    for (int d = 0; d < D; ++d) y += (root * v[1 + d]) * p.g[d];
  }
  /// A^T W^{-2} A = eta^{-2} (2 a a^T + tau sum_d g_d g_d^T), a = A^T J w.
  template <class Block>
  void add_normal(const lorentz::Scaling<N>& W, Block& K_e) const {
    const Vec<N>& w = W.w;
    double first = w[0] - w[N - 1];
    if (first < 1e-3 * w[0])
      first = (1 + w.template segment<D>(1).squaredNorm()) / (w[0] + w[N - 1]);
    Local a = first * p.q;
    for (int d = 0; d < D; ++d) a -= (root * w[1 + d]) * p.g[d];
    const double scale = 1 / (W.eta * W.eta);
    int at = 0;
    for (int i = 0; i < K; ++i)
      for (int j = i; j < K; ++j, ++at) {
        double gg = 0;
        for (int d = 0; d < D; ++d) gg += p.g[d][i] * p.g[d][j];
        K_e[at] += scale * (2 * a[i] * a[j] + p.tau * gg);
      }
  }
};

/// q^T x <= bound as bound - q^T x in the half line.
template <int K, int D>
struct CapBlock {
  static constexpr int N = 1;
  using Local = Eigen::Matrix<double, K, 1>;
  typename ParabolicProgram<K, D>::Cap p;
  double start;  // first slack

  int element() const { return p.element; }
  double size() const { return start; }
  double rank() const { return 1; }
  Vec<1> apply(const Local& x) const { return Vec<1>(-p.q.dot(x)); }
  Vec<1> offset() const { return Vec<1>(p.bound); }
  void add_adjoint(const Vec<1>& v, Local& y) const { y -= v[0] * p.q; }
  template <class Block>
  void add_normal(const lorentz::Scaling<1>& W, Block& K_e) const {
    const double scale = 1 / (W.eta * W.eta);
    int at = 0;
    for (int i = 0; i < K; ++i)
      for (int j = i; j < K; ++j, ++at) K_e[at] += scale * p.q[i] * p.q[j];
  }
};

/// All blocks of one kind with their slacks s, multipliers z and directions. Scaled directions:
/// ds = W^{-1} of the change of s, dz = W of the change of z; lambda = W z = W^{-1} s.
template <class B>
struct Blocks {
  static constexpr int N = B::N;
  struct State {
    Vec<N> s, z;
    lorentz::Scaling<N> W;
    lorentz::Interior<N> lambda;
    Vec<N> residual;  // s - A x - b
    struct Direction {
      Vec<N> target, sum, ds, dz;  // lambda o sum = target, sum = ds + dz
    };
    std::array<Direction, 2> direction;  // the one to be taken and one on trial
  };
  std::vector<B> block;  // by element
  std::vector<State> state;
  std::vector<int> first;  // elements + 1

  void index(int n_elements) {
    first.assign(static_cast<std::size_t>(n_elements) + 1, 0);
    for (const B& b : block) ++first[b.element() + 1];
    for (int e = 0; e < n_elements; ++e) first[e + 1] += first[e];
  }
  double rank() const {
    double sum = 0;
    for (const B& b : block) sum += b.rank();
    return sum;
  }
};

/// A point of the cone near v whose eigenvalues are at least `least`.
template <int N>
Vec<N> pushed_inside(Vec<N> v, double least) {
  v[0] = std::max(v[0], v.template tail<N - 1>().norm() + least);
  return v;
}

}  // namespace littoral::parabolic
