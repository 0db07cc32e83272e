#include "solve/optimization/shortened_gradients.h"

#include <algorithm>
#include <cmath>

#include "base/index.h"
#include "base/now_and_then.h"
#include "base/parallel_sum.h"
#include "littoral/error.h"
#include "solve/direct/cholesky.h"

namespace littoral {

namespace {

constexpr int rings = 4;                 // of cells around one that is too long, which take part
constexpr int fewest = 100, most = 200;  // cells too long: that many, and one in as many of all
constexpr double keep = 1e-4;            // weight of staying, beside that of being short
constexpr double below = 0.8;            // of what is allowed over 1, aimed at
constexpr int most_steps = 30;
constexpr std::size_t cells_looked_at = 1 << 13;
constexpr double settled = 1e-3;  // share of the rest by which a step lessens it

/// The cells that take part and the unknowns that may move in them.
class Patch {
 public:
  Patch(const CellGradients& all, const VecX& g, const std::vector<char>& fixed,
        const std::vector<int>& too_long)
      : all_(all), cells_(too_long), local_(all.D.rows(), -1) {
    std::vector<char> inside(all.A.size(), 0);
    for (const int c : cells_) inside[c] = 1;
    std::size_t first = 0;
    for (int ring = 0; ring < rings; ++ring) {
      const std::size_t end = cells_.size();
      for (; first < end; ++first)
        for_unknowns(cells_[first], [&](int i) {
          for_cells(i, [&](int c) {
            if (inside[c]) return;
            inside[c] = 1;
            cells_.push_back(c);
          });
        });
    }
    // An unknown moves if all that it changes is here.
    for (const int c : cells_)
      for_unknowns(c, [&](int i) {
        if (local_[i] >= 0 || fixed[i]) return;
        bool here = true;
        for_cells(i, [&](int other) { here = here && inside[other]; });
        if (!here) return;
        local_[i] = int_size(moving_);
        moving_.push_back(i);
      });
    g_.resize(index(cells_.size()) * all.dim);
    for (std::size_t k = 0; k < cells_.size(); ++k)
      g_.segment(index(k) * all.dim, all.dim) = g.segment(index(cells_[k]) * all.dim, all.dim);
    std::sort(moving_.begin(), moving_.end());
    for (std::size_t i = 0; i < moving_.size(); ++i) local_[moving_[i]] = static_cast<int>(i);
  }

  /// Minimises sum A (keep / 2 |G x|^2 + 1/2 max(0, |g + G x| - aim)^2), which is convex, by
  /// Newton's method, until no gradient is longer than `longest` or nothing more comes of it; true
  /// if the longest is shorter then.
  bool shorten(double aim, double longest, const Task& task) {
    x_ = VecX::Zero(index(moving_.size()));
    std::shared_ptr<const Elimination> structure;
    double value = value_at(x_, aim);
    const double before = longest_;
    for (int step = 0; step < most_steps && longest_ > longest; ++step) {
      task.checkpoint();
      VecX slope = VecX::Zero(x_.size());
      SpMat H(x_.size(), x_.size());
      add_derivatives(aim, slope, H);
      if (!structure) structure = std::make_shared<const Elimination>(H, dissection(H, task), task);
      const VecX move = -Cholesky<double>(H, structure, task).solve(slope);
      const double along = slope.dot(move);
      if (!(along < -settled * value)) break;
      double share = 1, next = value_at(x_ + move, aim);
      while (next > value + 1e-4 * share * along && share > 1e-3) {
        share /= 2;
        next = value_at(x_ + share * move, aim);
      }
      if (!(next < value)) break;
      x_ += share * move;
      value = next;
    }
    value_at(x_, aim);
    return longest_ < before;
  }

  VecX moved(VecX u) const {
    for (std::size_t i = 0; i < moving_.size(); ++i) u[moving_[i]] += x_[index(i)];
    return u;
  }

 private:
  template <class Body>
  void for_unknowns(int c, const Body& body) const {
    for (int r = all_.dim * c; r < all_.dim * (c + 1); ++r)
      for (SpRows::InnerIterator it(all_.G, r); it; ++it) body(static_cast<int>(it.col()));
  }
  template <class Body>
  void for_cells(int i, const Body& body) const {
    for (SpRows::InnerIterator it(all_.D, i); it; ++it) body(static_cast<int>(it.col() / all_.dim));
  }

  /// G x of a cell.
  Vec3 change(int c, const VecX& x) const {
    Vec3 out = Vec3::Zero();
    for (int d = 0; d < all_.dim; ++d)
      for (SpRows::InnerIterator it(all_.G, all_.dim * c + d); it; ++it)
        if (const int i = local_[it.col()]; i >= 0) out[d] += it.value() * x[i];
    return out;
  }
  Vec3 given(std::size_t k) const {
    Vec3 out = Vec3::Zero();
    out.head(all_.dim) = g_.segment(index(k) * all_.dim, all_.dim);
    return out;
  }

  /// Also finds the longest gradient.
  double value_at(const VecX& x, double aim) {
    struct Found {
      double sum = 0, longest = 0;
    };
    const auto found = of_pieces(
        cells_.size(), cells_looked_at, Found(),
        [&](std::size_t begin, std::size_t end) {
          Found here;
          for (std::size_t k = begin; k < end; ++k) {
            const Vec3 by = change(cells_[k], x);
            const double length = (given(k) + by).norm(), over = std::max(0.0, length - aim);
            here.sum += all_.A[cells_[k]] * (0.5 * keep * by.squaredNorm() + 0.5 * over * over);
            here.longest = std::max(here.longest, length);
          }
          return here;
        },
        [](const Found& a, const Found& b) {
          return Found{a.sum + b.sum, std::max(a.longest, b.longest)};
        });
    longest_ = found.longest;
    return found.sum;
  }

  void add_derivatives(double aim, VecX& slope, SpMat& H) const {
    Triplets entries;
    std::vector<int> who;      // moves in the cell
    std::vector<Vec3> slopes;  // its part of G
    for (std::size_t k = 0; k < cells_.size(); ++k) {
      const int c = cells_[k];
      const Vec3 by = change(c, x_), g = given(k) + by;
      const double length = g.norm();
      Vec3 first = keep * by;
      Eigen::Matrix3d second = keep * Eigen::Matrix3d::Identity();
      if (length > aim) {
        const Vec3 n = g / length;
        first += (length - aim) * n;
        second +=
            (1 - aim / length) * Eigen::Matrix3d::Identity() + aim / length * n * n.transpose();
      }
      who.clear();
      slopes.clear();
      for (int d = 0; d < all_.dim; ++d)
        for (SpRows::InnerIterator it(all_.G, all_.dim * c + d); it; ++it) {
          const int i = local_[it.col()];
          if (i < 0) continue;
          const auto at = std::size_t(std::find(who.begin(), who.end(), i) - who.begin());
          if (at == who.size()) {
            who.push_back(i);
            slopes.emplace_back(Vec3::Zero());
          }
          slopes[at][d] += it.value();
        }
      for (std::size_t a = 0; a < who.size(); ++a) {
        slope[who[a]] += all_.A[c] * slopes[a].dot(first);
        const Vec3 along = all_.A[c] * (second * slopes[a]);
        for (std::size_t b = 0; b < who.size(); ++b)
          if (who[b] <= who[a]) entries.emplace_back(who[a], who[b], along.dot(slopes[b]));
      }
    }
    H.setFromTriplets(entries.begin(), entries.end());
  }

  const CellGradients& all_;
  std::vector<int> cells_, moving_, local_;  // local_: unknowns -> their place in moving_, or -1
  VecX g_, x_;
  double longest_ = 0;
};

}  // namespace

std::optional<VecX> with_shortened_gradients(const CellGradients& cells, const VecX& u,
                                             const VecX& g, const std::vector<char>& fixed,
                                             double longest, const Task& task) {
  const auto most_cells = std::size_t(std::max(fewest, int(cells.A.size() / most)));
  const std::vector<int> too_long = of_pieces(
      std::size_t(cells.A.size()), cells_looked_at, std::vector<int>(),
      [&](std::size_t begin, std::size_t end) {
        std::vector<int> here;
        for (Eigen::Index c = index(begin); c < index(end) && here.size() <= most_cells; ++c)
          if (g.segment(c * cells.dim, cells.dim).norm() > longest)
            here.push_back(static_cast<int>(c));
        return here;
      },
      [](std::vector<int> all, const std::vector<int>& next) {
        all.insert(all.end(), next.begin(), next.end());
        return all;
      });
  if (too_long.empty() || too_long.size() > most_cells) return std::nullopt;
  Patch patch(cells, g, fixed, too_long);
  try {
    if (!patch.shorten(1 + below * (longest - 1), longest, task)) return std::nullopt;
  } catch (const SolveError&) {  // nothing holds the unknowns that may move
    return std::nullopt;
  }
  return patch.moved(u);
}

}  // namespace littoral
