#pragma once
// The constraints of a paraboloid program, all as rows bound + q^T x - |T G x|^2 / 4 >= 0, and the
// sums over an element's rows that Newton's equations are made of.

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/index.h"
#include "solve/optimization/paraboloid_program.h"

namespace littoral::paraboloid {

/// A row and its interior-point state: slack s, multiplier z.
struct Row {
  int element = 0, point = 0;
  double bound = 0, size = 1;
  double s = 0, z = 0;
  bool exact = false;     // s is g(x); otherwise s - g(x) is still to be removed
  double ds = 0, dz = 0;  // direction
  double cross = 0;       // ds dz of the predictor
  double bend = 0;        // |T G dx|^2 / 4 of the predictor
  double target = 0;      // of s z
  double change = 0;      // of the target, on trial
  double anchor_s = 0, anchor_z = 0;
};

/// What one row is at one x.
template <int K, int D>
struct RowAt {
  using Program = ParaboloidProgram<K, D>;
  using Local = Eigen::Matrix<double, K, 1>;
  using Small = Eigen::Matrix<double, D, 1>;

  const typename Program::Point& p;
  const typename Program::Transform& T;
  double g;  // of x
  Local a;   // gradient of g

  RowAt(const Row& row, const typename Program::Point& point,
        const typename Program::Transform& transform, const Local& x)
      : p(point), T(transform) {
    const Small y = slopes(x);
    g = row.bound + p.q.dot(x) - 0.25 * y.squaredNorm();
    a = p.q - 0.5 * adjoint(y);
  }
  Small slopes(const Local& x) const {
    Small y;
    for (int d = 0; d < D; ++d) y[d] = p.g[d].dot(x);
    return T * y;
  }
  Local adjoint(const Small& y) const {
    const Small v = T.transpose() * y;
    Local out = v[0] * p.g[0];
    for (int d = 1; d < D; ++d) out += v[d] * p.g[d];
    return out;
  }
};

/// The largest step that keeps a slack s >= 0 on its way s + t b - t^2 bend, bend >= 0.
inline double step_to_zero(double s, double b, double bend) {
  const double down = std::sqrt(b * b + 4 * bend * s) - b;
  return down > 0 ? 2 * s / down : infinity;
}

/// How far a direction may be followed, and what becomes of s^T z.
struct Steps {
  double to_primal = infinity, to_dual = to_primal;
  double s_dz = 0, ds_z = 0, ds_dz = 0;

  // What is taken: not all of the way to the boundary.
  double primal() const { return std::min(1.0, 0.99 * to_primal); }
  double dual() const { return std::min(1.0, 0.99 * to_dual); }
  double least() const { return std::min(primal(), dual()); }
  double sum() const { return primal() + dual(); }

  /// b = a^T dx and bend = |T G dx|^2 / 4 say where g goes.
  void add(const Row& r, double b, double bend) {
    if (r.exact)
      to_primal = std::min(to_primal, step_to_zero(r.s, b, bend));
    else if (r.ds < 0)
      to_primal = std::min(to_primal, -r.s / r.ds);
    if (r.dz < 0) to_dual = std::min(to_dual, -r.z / r.dz);
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

}  // namespace littoral::paraboloid
