#pragma once
// What becomes of an iterate when rows are inserted that it may violate.

#include <algorithm>
#include <vector>

#include "solve/direct/element_matrix.h"
#include "solve/optimization/paraboloid_rows.h"

namespace littoral::paraboloid {

/// An iterate that was well inside, and its slacks and multipliers, which are kept with the rows.
template <int K, int D>
class Anchor {
 public:
  using Program = ParaboloidProgram<K, D>;
  using Rows = ParaboloidRows<K, D>;
  using Row = typename Rows::Row;

  bool is_set() const { return x_.size() > 0; }

  void set(const VecX& x, double mu, Rows& rows) {
    x_ = x;
    mu_ = mu;
    each_element(rows.first.size() - 1, [&](int e) {
      rows.each(e, [](const Row& r, RowOrigin& origin) {
        origin.anchor_s = r.s;
        origin.anchor_z = r.z;
      });
    });
  }

  /// Inserts rows, and moves x and all rows back here as far as they ask for, within measure.
  void insert(const std::vector<typename Program::Inserted>& inserted, const Program& program,
              const ElementMatrix<K>& matrix, const std::vector<double>& weight, Rows& rows,
              VecX& x) const {
    double back = 0.02;
    std::vector<typename Rows::Inserted> grown;
    grown.reserve(inserted.size());
    for (const auto& [e, point, size] : inserted) {
      Row r;
      r.point = rows.add_point(point);
      const auto at = rows.at(r, program.transform[e]);
      const double there = at.value(0, matrix.gather(x_, e));
      const double here = at.value(0, matrix.gather(x, e));
      const double s = std::max({there, -here, 1e-4 * size});
      if (here < 0)
        back = std::max(back, std::min(0.3, there > 0 ? -1.5 * here / (there - here) : 1));
      grown.push_back({e, r, {size, s, 0.1 * mu_ * weight[e] / s}});
    }
    rows.insert(grown);
    x += back * (x_ - x);
    each_element(rows.first.size() - 1, [&](int e) {
      const auto local = matrix.gather(x, e);
      rows.each(e, [&](Row& r, const RowOrigin& origin) {
        const double g = rows.at(r, program.transform[e]).value(rows.bound_of(r), local);
        const double s = r.s + back * (origin.anchor_s - r.s);
        r.exact = g >= 0.5 * s;
        r.s = r.exact ? g : s;
        r.z += back * (origin.anchor_z - r.z);
      });
    });
  }

 private:
  VecX x_;
  double mu_ = 0;
};

}  // namespace littoral::paraboloid
