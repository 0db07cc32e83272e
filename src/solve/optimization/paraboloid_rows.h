#pragma once
// The constraints of a paraboloid program, all as rows bound + q^T x - |T G x|^2 / 4 >= 0, and the
// sums over an element's rows that Newton's equations are made of.

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>
#include <vector>

#include "base/index.h"
#include "base/parallel.h"
#include "base/parallel_sum.h"
#include "solve/optimization/paraboloid_program.h"

namespace littoral::paraboloid {

/// A row's interior-point state: slack s, multiplier z. Loops over the rows wait for memory, so it
/// holds what most of them need and no direction, which is found again from dx: 64 bytes for D = 2.
template <int D>
struct Row {
  double s = 0, z = 0;
  Eigen::Matrix<double, D, 1> y =
      Eigen::Matrix<double, D, 1>::Zero();  // T G x at Newton's equations
  double bend = 0;                          // |T G dx|^2 / 4 of the predictor
  double target = 0;                        // of s z; until that is known, ds dz of the predictor
  double change = 0;                        // of the target, on trial
  int point = 0;
  bool exact = false;  // s is g(x); otherwise s - g(x) is still to be removed
};

/// What is seldom needed of a row.
struct RowOrigin {
  double size = 1;  // of x expected here
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

/// A row's part of a direction: b = a^T dx and bend = |T G dx|^2 / 4 say where g goes.
struct RowStep {
  double b = 0, bend = 0;
  double ds = 0, dz = 0;
};

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
  double greatest() const { return std::max(primal(), dual()); }
  double sum() const { return primal() + dual(); }

  template <int D>
  void add(const Row<D>& r, const RowStep& step) {
    if (r.exact) {
      if (r.s + to_primal * (step.b - to_primal * step.bend) < 0)
        to_primal = std::min(to_primal, step_to_zero(r.s, step.b, step.bend));
    } else if (r.s + to_primal * step.ds < 0) {
      to_primal = -r.s / step.ds;
    }
    if (r.z + to_dual * step.dz < 0) to_dual = -r.z / step.dz;
    s_dz += r.s * step.dz;
    ds_z += step.ds * r.z;
    ds_dz += step.ds * step.dz;
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
  /// A row that is to be among those of an element.
  struct Inserted {
    int element;
    Row row;
    RowOrigin origin;
  };

  std::vector<int> first;         // elements + 1
  std::vector<Row> row;           // element by element
  std::vector<RowOrigin> origin;  // rows
  std::vector<typename Program::Point> points;
  std::vector<double> bound;  // points

  /// Caps are as large as their bound, but no smaller than `least`.
  ParaboloidRows(const Program& program, double least)
      : first(program.transform.size() + 1, 0),
        points(program.points),
        bound(program.points.size(), 0) {
    for (const auto& s : program.samples) ++first[s.element + 1];
    for (const auto& cap : program.caps) ++first[cap.element + 1];
    for (std::size_t e = 1; e < first.size(); ++e) first[e] += first[e - 1];
    row.reserve(first.back() + first.back() / 16);  // with room for what is inserted
    origin.reserve(row.capacity());
    row.resize(first.back());
    origin.resize(row.size());
    std::vector<int> next(first.begin(), first.end() - 1);
    const auto put = [&](int element, int point, double size) {
      row[next[element]].point = point;
      origin[next[element]++].size = size;
    };
    for (const auto& s : program.samples) put(s.element, s.point, s.tau);
    for (const auto& cap : program.caps) {
      typename Program::Point p{-cap.q, {}};
      p.g.fill(Program::Row::Zero());
      put(cap.element, add_point(p, cap.bound), std::max(cap.bound, least));
    }
  }
  int add_point(const typename Program::Point& p, double its_bound = 0) {
    points.push_back(p);
    bound.push_back(its_bound);
    return int_size(points) - 1;
  }
  RowAt<K, D> at(const Row& r, const typename Program::Transform& T) const {
    return {points[r.point], T};
  }
  double bound_of(const Row& r) const { return bound[r.point]; }
  /// Calls f(row) or f(row, its origin) for the rows of an element.
  template <class F>
  void each(int element, F&& f) {
    for (int i = first[element]; i < first[element + 1]; ++i) {
      if constexpr (std::is_invocable_v<F, Row&>)
        f(row[i]);
      else
        f(row[i], origin[i]);
    }
  }
  /// Puts new rows, of ascending elements, behind those of their elements.
  void insert(const std::vector<Inserted>& inserted) {
    int left = int_size(inserted);
    int end = int_size(row);  // of the rows that are not yet in place
    row.resize(row.size() + inserted.size());
    origin.resize(row.size());
    const auto shift_from = [&](int begin) {
      std::move_backward(row.begin() + begin, row.begin() + end, row.begin() + end + left);
      std::move_backward(origin.begin() + begin, origin.begin() + end, origin.begin() + end + left);
      end = begin;
    };
    for (int e = int_size(first) - 1; left > 0; --e) {
      const int rows_end = first[e];
      first[e] += left;
      if (inserted[left - 1].element != e - 1) continue;
      shift_from(rows_end);
      for (; left > 0 && inserted[left - 1].element == e - 1; --left) {
        row[end + left - 1] = inserted[left - 1].row;
        origin[end + left - 1] = inserted[left - 1].origin;
      }
    }
  }
};

inline constexpr std::size_t elements_at_once = 256;  // of a piece of a parallel loop

/// Calls f(element, partial) for n elements, in pieces with a partial result each, which are
/// combined in order.
template <class Partial, class F, class Combine>
Partial for_elements(std::size_t n, F&& f, Combine&& combine) {
  const auto piece = [&](std::size_t begin, std::size_t end) {
    Partial here{};  // not in a line of memory with those of other threads
    for (std::size_t e = begin; e < end; ++e) f(e, here);
    return here;
  };
  return of_pieces(n, elements_at_once, Partial{}, piece, [&](Partial total, const Partial& next) {
    combine(total, next);
    return total;
  });
}

/// Calls f(element).
template <class F>
void each_element(std::size_t n, F&& f) {
  parallel_for(n, elements_at_once, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) f(e);
  });
}

}  // namespace littoral::paraboloid
