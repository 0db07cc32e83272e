#pragma once
// The constraints of a paraboloid program, all as rows bound + q^T x - |T G x|^2 / 4 >= 0, and the
// sums over an element's rows that Newton's equations are made of.

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/index.h"
#include "base/parallel.h"
#include "solve/optimization/paraboloid_program.h"

namespace littoral::paraboloid {

/// A row and its interior-point state: slack s, multiplier z.
template <int D>
struct Row {
  int element = 0, point = 0;
  double bound = 0, size = 1;
  double s = 0, z = 0;
  bool exact = false;   // s is g(x); otherwise s - g(x) is still to be removed
  double residual = 0;  // s - g(x), as it was when Newton's equations were set up
  Eigen::Matrix<double, D, 1> y = Eigen::Matrix<double, D, 1>::Zero();  // T G x, likewise
  double ds = 0, dz = 0;                                                // direction
  double cross = 0;                                                     // ds dz of the predictor
  double bend = 0;    // |T G dx|^2 / 4 of the predictor
  double target = 0;  // of s z
  double change = 0;  // of the target, on trial
  double anchor_s = 0, anchor_z = 0;
};

/// A row's functions of x: its sums over an element's unknowns are made without forming the
/// gradient a = q - (T G)^T y / 2, y = T G x, for every use.
template <int K, int D>
struct RowAt {
  using Program = ParaboloidProgram<K, D>;
  using Local = Eigen::Matrix<double, K, 1>;
  using Small = Eigen::Matrix<double, D, 1>;

  const typename Program::Point& p;
  const typename Program::Transform& T;

  Small slopes(const Local& x) const {
    Small y;
    for (int d = 0; d < D; ++d) y[d] = p.g[d].dot(x);
    return T * y;
  }
  /// g, given the slopes of x.
  double value(double bound, const Local& x, const Small& y) const {
    return bound + p.q.dot(x) - 0.25 * y.squaredNorm();
  }
  double value(double bound, const Local& x) const { return value(bound, x, slopes(x)); }
  /// a^T dx, given the slopes of dx.
  double slope(const Small& y, const Local& dx, const Small& dy) const {
    return p.q.dot(dx) - 0.5 * y.dot(dy);
  }
  /// sum += q + (T G)^T y, both with factors.
  void add(double of_q, const Small& y, Local& sum) const {
    const Small v = T.transpose() * y;
    sum += of_q * p.q;
    for (int d = 0; d < D; ++d) sum += v[d] * p.g[d];
  }
  /// Row d of T G.
  Local slope_row(int d) const {
    Local row = T(d, 0) * p.g[0];
    for (int k = 1; k < D; ++k) row += T(d, k) * p.g[k];
    return row;
  }
  /// sum += factor a.
  void add_gradient(double factor, const Small& y, Local& sum) const {
    add(factor, (-0.5 * factor) * y, sum);
  }
};

/// N += factor a a^T.
template <int K>
void add_square(double factor, const Eigen::Matrix<double, K, 1>& a,
                Eigen::Matrix<double, K, K>& N) {
  for (int k = 0; k < K; ++k) N.col(k) += (factor * a[k]) * a;
}

/// The largest step that keeps a slack s >= 0 on its way s + t b - t^2 bend, bend >= 0.
inline double step_to_zero(double s, double b, double bend) {
  const double down = std::sqrt(b * b + 4 * bend * s) - b;
  return down > 0 ? 2 * s / down : infinity;
}

/// How far a direction may be followed (2: at least so far), and what becomes of s^T z.
struct Steps {
  double to_primal = 2, to_dual = 2;
  double s_dz = 0, ds_z = 0, ds_dz = 0;

  // What is taken: not all of the way to the boundary.
  double primal() const { return std::min(1.0, 0.99 * to_primal); }
  double dual() const { return std::min(1.0, 0.99 * to_dual); }
  double least() const { return std::min(primal(), dual()); }
  double sum() const { return primal() + dual(); }

  /// b = a^T dx and bend = |T G dx|^2 / 4 say where g goes.
  template <int D>
  void add(const Row<D>& r, double b, double bend) {
    if (r.exact) {
      if (r.s + to_primal * (b - to_primal * bend) < 0)
        to_primal = std::min(to_primal, step_to_zero(r.s, b, bend));
    } else if (r.s + to_primal * r.ds < 0) {
      to_primal = -r.s / r.ds;
    }
    if (r.z + to_dual * r.dz < 0) to_dual = -r.z / r.dz;
    s_dz += r.s * r.dz;
    ds_z += r.ds * r.z;
    ds_dz += r.ds * r.dz;
  }
  static void combine(Steps& total, const Steps& p) {
    total.to_primal = std::min(total.to_primal, p.to_primal);
    total.to_dual = std::min(total.to_dual, p.to_dual);
    total.s_dz += p.s_dz;
    total.ds_z += p.ds_z;
    total.ds_dz += p.ds_dz;
  }
};

/// The rows of a program by element, with the rows' points.
template <int K, int D>
struct ParaboloidRows {
  using Program = ParaboloidProgram<K, D>;
  using Row = paraboloid::Row<D>;

  std::vector<Row> row;    // ascending elements
  std::vector<int> first;  // elements + 1
  std::vector<typename Program::Point> points;

  /// Caps are as large as their bound, but no smaller than `least`.
  ParaboloidRows(const Program& program, double least) : points(program.points) {
    for (const auto& s : program.samples) add(s.element, s.point, 0, s.tau);
    for (const auto& cap : program.caps) {
      typename Program::Point p{-cap.q, {}};
      p.g.fill(Program::Row::Zero());
      add(cap.element, add_point(p), cap.bound, std::max(cap.bound, least));
    }
    std::stable_sort(row.begin(), row.end(),
                     [](const Row& a, const Row& b) { return a.element < b.element; });
    index(int_size(program.transform));
  }
  int add_point(const typename Program::Point& p) {
    points.push_back(p);
    return int_size(points) - 1;
  }
  void index(int n_elements) {
    first.assign(n_elements + 1, 0);
    for (const Row& r : row) ++first[r.element + 1];
    for (int e = 0; e < n_elements; ++e) first[e + 1] += first[e];
  }

 private:
  void add(int element, int point, double bound, double size) {
    Row r;
    r.element = element;
    r.point = point;
    r.bound = bound;
    r.size = size;
    row.push_back(r);
  }
};

inline constexpr std::size_t elements_at_once = 256;  // of a piece of a parallel loop

/// Calls f(element, partial) for n elements, in pieces with a partial result each, which are
/// combined in order.
template <class Partial, class F, class Combine>
Partial for_elements(std::size_t n, F&& f, Combine&& combine) {
  std::vector<Partial> partial((n + elements_at_once - 1) / elements_at_once);
  parallel_for(n, elements_at_once, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) f(e, partial[begin / elements_at_once]);
  });
  Partial total{};
  for (const Partial& p : partial) combine(total, p);
  return total;
}

/// Calls f(element).
template <class F>
void each_element(std::size_t n, F&& f) {
  parallel_for(n, elements_at_once, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) f(e);
  });
}

}  // namespace littoral::paraboloid
