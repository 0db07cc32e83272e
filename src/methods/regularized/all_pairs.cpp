#include "methods/regularized/all_pairs.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <optional>

#include "base/counted.h"
#include "base/index.h"
#include "base/parallel.h"
#include "base/platform/memory.h"
#include "littoral/error.h"
#include "methods/regularized/pace.h"
#include "solve/direct/strip_solve.h"

namespace littoral {

const OptionTable<Symmetric>& all_pairs_options() {
  using O = Symmetric;
  static const OptionTable<O> table =
      OptionTable<O>()
          .number(&O::alpha, "alpha", "", 0, 1e6,
                  "Smoothing, whatever the size of the mesh (alpha-hat).")
          .number(&O::tolerance, "tolerance", "", 1e-10, 1,
                  "Iterations stop when all residuals are below this share of what they compare.")
          .integer(&O::max_iterations, "max-iterations", "", 1, 1000000000,
                   "Iterations after which the best answer so far is given.")
          .choice(&O::storage, "storage", {"automatic", "full", "single"},
                  "Precision in which matrices are kept: full, or single above half of the memory "
                  "(automatic) or always.");
  return table;
}

double all_pairs_memory(double nodes, double cells, double bytes_per_number) {
  return bytes_per_number * nodes * (2 * cells + 4 * nodes);  // S; T, U, X, response
}

namespace {

constexpr Eigen::Index block = strip_width;  // columns worked on together
constexpr double relaxation = 1.8;           // Boyd et al. 2011, 3.4.3
constexpr int check_every = 5;

using Row = Eigen::Array<double, 1, block, Eigen::RowMajor>;

/// Row r of A x.
Row row_of_product(const SpRows& A, Eigen::Index r, const Strip& x) {
  Row sum = Row::Zero();
  for (SpRows::InnerIterator it(A, r); it; ++it) sum += it.value() * x.row(it.col()).array();
  return sum;
}

/// Shrinks the vectors (x, y) to length 1 at most.
void project(Row& x, Row& y) {
  const Row shrink = (x.square() + y.square()).max(1.0).sqrt().inverse();
  x *= shrink;
  y *= shrink;
}

/// Squared norms over the product of the domain with itself.
struct Norms {
  double gap = 0, g = 0, z = 0, dz = 0, w = 0;    // G X - Z, G X, Z; D (Z - Z_old), D W
  double split = 0, x = 0, u = 0, du = 0, h = 0;  // X - U, X, U; U - U_old, H
  void add(const Norms& o) {
    gap += o.gap, g += o.g, z += o.z, dz += o.dz, w += o.w;
    split += o.split, x += o.x, u += o.u, du += o.du, h += o.h;
  }
};

/// Alg. 2. Started from zero, with U symmetric, its two halves are the same in every step: R = X, Q
/// = Z, S = Y, K = H. So only X, Z, Y, H are kept; and of these, as z = Proj(s) and w = y / rho1 =
/// s - z, the sum s; and t = u + h, h here the paper's H / rho2. Unlike there the X-step holds the
/// diagonal at 0 as well, which takes a third of the iterations.
template <class Number>
class AllPairs {
 public:
  using Matrix = Eigen::Matrix<Number, Eigen::Dynamic, Eigen::Dynamic>;

  AllPairs(const Calculus& C, const Symmetric& options, const Task& task)
      : C_(C), o_(options), task_(task), n_(C.M.size()), cells_(C.A.size()), area_(C.M.sum()) {
    rho1_ = 2 * std::sqrt(area_);
    rho2_ = 50 / std::sqrt(area_);
    alpha_ = options.alpha * std::sqrt(area_);  // 7.1
    G_ = C.G.matrix();
    VecX A(2 * cells_);
    for (Eigen::Index c = 0; c < cells_; ++c) A.segment<2>(2 * c).setConstant(C.A[c]);
    D_ = SpRows(G_.transpose()) * A.asDiagonal();
    for (Eigen::Index j = 0; j < n_; j += block)
      S_.push_back(StripOf<Number>::Zero(2 * cells_, block));
    T_ = U_ = X_ = Matrix::Zero(n_, n_);
    factor();
  }

  MatX run(Report& report) {
    double worst = infinity;
    Pace pace;
    bool hopeful = true;
    int k = 0;
    const int last = o_.max_iterations;
    while (worst > 1 && k < last && hopeful) {
      ++k;
      const bool check = k % check_every == 0 || k == last;
      const Norms norms = iterate(check);
      if (!check) continue;
      worst = check_convergence(norms, k);
      hopeful = pace.hopeful(k, worst);
    }
    report.iterations.emplace_back("all pairs", k);
    report.residuals.emplace_back("all pairs, over what is compared", worst * o_.tolerance);
    report.residuals.emplace_back("largest gradient over 1", std::max(0.0, longest_ - 1));
    if (worst > 1) {
      report.status = "not converged";
      report.warn("not-converged",
                  "all pairs stopped after " + counted(k, "iteration", "iterations") +
                      " above the tolerance" +
                      (k < last ? ", as these no longer come nearer to it: raise option tolerance"
                                : ": raise option max-iterations or option tolerance"));
    }
    T_.resize(0, 0), X_.resize(0, 0), response_.resize(0, 0), S_.clear();
    return U_.template cast<double>();
  }

 private:
  /// W_P = (alpha + rho1) W_D + rho2 M_V, with ones for nodes in no cell, and what a force at a
  /// node does there.
  void factor() {
    Triplets entries;
    for (Eigen::Index i = 0; i < n_; ++i)
      entries.emplace_back(i, i, C_.component[i] < 0 ? 1.0 : rho2_ * C_.M[i]);
    SpMat K(n_, n_);
    K.setFromTriplets(entries.begin(), entries.end());
    K += (alpha_ + rho1_) * C_.L;
    if (!structure_) structure_ = std::make_shared<const Elimination>(K, dissection(K, task_));
    std::vector<int> own(n_);
    std::iota(own.begin(), own.end(), 0);
    factor_.emplace(raised_cholesky(K, structure_, task_).factor, own);
    response_.resize(n_, n_);
    parallel_for(n_, block, [&](std::size_t begin, std::size_t end) {
      task_.checkpoint(progress_);
      const Eigen::Index first = begin, width = index(end - begin);
      Strip unit = Strip::Zero(n_, block);
      for (Eigen::Index k = 0; k < width; ++k) unit(first + k, k) = 1;
      Strip spare;
      (*factor_)(unit, {}, spare, task_);
      response_.middleCols(first, width) = unit.leftCols(width).template cast<Number>();
    });
  }

  /// Of the columns from `begin` on; 0 beyond the last.
  Row masses(Eigen::Index begin) const {
    Row m = Row::Zero();
    for (Eigen::Index k = 0; k < std::min(block, n_ - begin); ++k) m[k] = C_.M[begin + k];
    return m;
  }

  Norms iterate(bool check) {
    const std::size_t columns = n_;
    std::vector<Norms> partial(S_.size());
    std::vector<double> longest(S_.size(), 0);
    parallel_for(columns, block, [&](std::size_t begin, std::size_t end) {
      task_.checkpoint(progress_);
      update_columns(begin, end, check, partial[begin / block], longest[begin / block]);
    });
    Norms norms;
    for (const Norms& p : partial) norms.add(p);
    longest_ = *std::max_element(longest.begin(), longest.end());
    std::fill(partial.begin(), partial.end(), Norms());
    parallel_for(columns, block, [&](std::size_t begin, std::size_t end) {
      task_.checkpoint(progress_);
      symmetrize(begin, end, check, partial[begin / block]);
    });
    for (const Norms& p : partial) norms.add(p);
    return norms;
  }

  /// Steps X, Z, Y, and T = H + X of columns. Of Z and Y only their sum s is read and written: z is
  /// its projection, and what is multiplied by D is p = z - w = 2 z - s.
  void update_columns(Eigen::Index begin, Eigen::Index end, bool check, Norms& norms,
                      double& longest) {
    const Eigen::Index width = end - begin;
    StripOf<Number>& S = S_[begin / block];
    Strip p(2 * cells_, block);
    for (Eigen::Index c = 0; c < 2 * cells_; c += 2) {
      const Row sx = S.row(c).template cast<double>(), sy = S.row(c + 1).template cast<double>();
      Row x = sx, y = sy;
      project(x, y);
      p.row(c) = 2 * x - sx;
      p.row(c + 1) = 2 * y - sy;
    }
    // M_P - D Y + rho1 D Z - M H + rho2 M U; h = t - u.
    Strip X(n_, block);
    for (Eigen::Index i = 0; i < n_; ++i)
      X.row(i) = rho1_ * row_of_product(D_, i, p) + 0.5 * C_.M[i];
    X.rightCols(block - width).setZero();
    for (Eigen::Index k = 0; k < width; ++k) {
      const Eigen::Index j = begin + k;
      X.col(k) += rho2_ * C_.M.cwiseProduct((2 * U_.col(j) - T_.col(j)).template cast<double>());
    }
    Strip spare;
    (*factor_)(X, {}, spare, task_);
    for (Eigen::Index k = 0; k < width; ++k) {
      const Eigen::Index j = begin + k;
      const double pull = X(j, k) / double(response_(j, j));
      X.col(k) -= pull * response_.col(j).template cast<double>();
    }
    const Row mass = masses(begin);
    Strip before, multiplier;  // z - old z and w, where norms of D times them are wanted
    if (check) before.resize(2 * cells_, block), multiplier.resize(2 * cells_, block);
    for (Eigen::Index c = 0; c < 2 * cells_; c += 2) {
      const Row gx = row_of_product(G_, c, X), gy = row_of_product(G_, c + 1, X);
      Row sx = S.row(c).template cast<double>(), sy = S.row(c + 1).template cast<double>();
      const Row zx = 0.5 * (p.row(c).array() + sx), zy = 0.5 * (p.row(c + 1).array() + sy);
      sx += relaxation * (gx - zx);
      sy += relaxation * (gy - zy);
      S.row(c) = sx.template cast<Number>();
      S.row(c + 1) = sy.template cast<Number>();
      if (!check) continue;
      Row x = sx, y = sy;
      project(x, y);
      const double area = C_.A[c / 2];
      const Row length2 = gx.square() + gy.square();
      norms.gap += area * (mass * ((gx - x).square() + (gy - y).square())).sum();
      norms.g += area * (mass * length2).sum();
      norms.z += area * (mass * (x.square() + y.square())).sum();
      longest = std::max(longest, length2.maxCoeff());
      before.row(c) = x - zx;
      before.row(c + 1) = y - zy;
      multiplier.row(c) = sx - x;
      multiplier.row(c + 1) = sy - y;
    }
    if (check) {
      longest = std::sqrt(longest);
      norms.dz = forces2(before, mass);
      norms.w = forces2(multiplier, mass);
    }
    for (Eigen::Index k = 0; k < width; ++k) {
      const auto x = X.col(k).template cast<Number>().eval();
      if (check) X_.col(begin + k) = x;
      // h + relaxed x = t - u + 1.8 x - .8 u
      T_.col(begin + k) += Number(relaxation) * (x - U_.col(begin + k));
    }
  }

  double forces2(const Strip& z, const Row& mass) const {
    double sum = 0;
    for (Eigen::Index i = 0; i < n_; ++i) sum += (mass * row_of_product(D_, i, z).square()).sum();
    return sum;
  }

  /// U = max((T + T^T) / 2, 0), 0 on the diagonal: columns begin to end of it.
  void symmetrize(Eigen::Index begin, Eigen::Index end, bool check, Norms& norms) {
    const Matrix across = T_.middleRows(begin, end - begin).transpose();
    for (Eigen::Index j = begin; j < end; ++j) {
      Eigen::Matrix<Number, Eigen::Dynamic, 1> next =
          (Number(0.5) * (T_.col(j) + across.col(j - begin))).cwiseMax(Number(0));
      next[j] = 0;
      if (check) {
        const auto norm2 = [&](const auto& v) {
          return C_.M[j] * C_.M.dot(v.template cast<double>().cwiseAbs2().matrix());
        };
        norms.split += norm2(X_.col(j) - next);
        norms.x += norm2(X_.col(j));
        norms.u += norm2(next);
        norms.du += norm2(next - U_.col(j));
        norms.h += norm2(T_.col(j) - next);
      }
      U_.col(j) = next;
    }
  }

  /// The largest residual over its tolerance; adapts the penalties (Boyd et al. 3.4.1). What the
  /// X-step's equation lacks is compared with the largest of its terms, that of the objective among
  /// them: 1/2 M_i at each (i, j). Multipliers alone may vanish, where no gradient reaches length 1
  /// (large alpha) or X is symmetric by itself.
  double check_convergence(const Norms& s, int k) {
    auto over = [this](double residual, double compared) {
      return std::sqrt(residual) / (o_.tolerance * (std::sqrt(compared) + 1e-300));
    };
    const double given1 = 0.25 * area_ * C_.M.squaredNorm() / (rho1_ * rho1_);
    const double given2 = 0.25 * area_ * area_ / (rho2_ * rho2_);
    const double primal1 = over(s.gap, std::max(s.g, s.z));
    const double primal2 = over(s.split, std::max(s.x, s.u));
    const double dual1 = over(s.dz, std::max(s.w, given1));
    const double dual2 = over(s.du, std::max(s.h, given2));
    const double worst = std::max({primal1, dual1, primal2, dual2});
    if (!std::isfinite(worst))
      throw SolveError("all pairs diverged: non-finite iterate; a larger option alpha helps",
                       "diverged");
    progress_ = std::max(progress_, 0.95 / (1 + std::log10(std::max(1.0, worst))));
    if (worst <= 1 || k < next_change_) return worst;
    auto factor_of = [](double primal, double dual) {
      return primal > 5 * dual ? 2 : dual > 5 * primal ? 0.5 : 1;
    };
    const double f1 = factor_of(primal1, dual1), f2 = factor_of(primal2, dual2);
    if (f1 == 1 && f2 == 1) return worst;
    rho1_ *= f1;
    rho2_ *= f2;
    rescale(f1, f2);
    factor();
    next_change_ = k + k / 5 + check_every;
    return worst;
  }

  /// Keeps Y = rho1 w and H = rho2 h where the penalties change.
  void rescale(double f1, double f2) {
    parallel_for(S_.size(), 1, [&](std::size_t at, std::size_t) {
      StripOf<Number>& S = S_[at];
      for (Eigen::Index c = 0; c < 2 * cells_; c += 2) {
        const Row sx = S.row(c).template cast<double>(), sy = S.row(c + 1).template cast<double>();
        Row x = sx, y = sy;
        project(x, y);
        S.row(c) = (x + (sx - x) / f1).template cast<Number>();
        S.row(c + 1) = (y + (sy - y) / f1).template cast<Number>();
      }
      const auto begin = index(at) * block, width = std::min(block, n_ - begin);
      auto T = T_.middleCols(begin, width);
      const auto U = U_.middleCols(begin, width);
      T = U + (T - U) / Number(f2);
    });
  }

  const Calculus& C_;
  const Symmetric& o_;
  const Task& task_;
  Eigen::Index n_, cells_;
  double area_, rho1_ = 0, rho2_ = 0, alpha_ = 0, longest_ = 0, progress_ = 0;
  int next_change_ = 50;
  SpRows G_, D_;
  std::shared_ptr<const Elimination> structure_;
  std::optional<StripSolve> factor_;
  std::vector<StripOf<Number>> S_;  // 2 cells x nodes, by blocks of columns
  Matrix T_, U_, X_;                // nodes x nodes
  Matrix response_;                 // to a force at each node
};

}  // namespace

MatX all_pairs(const Operators& ops, const Symmetric& options, const Task& task, Report& report) {
  const Calculus& C = ops.scalar;
  if (C.n_components != 1)
    throw UnsupportedError(
        "symmetric distances are computed on one component at a time, this surface has " +
        std::to_string(C.n_components));
  if (C.G.rows != 2 * C.A.size())
    throw UnsupportedError("symmetric distances need a triangle mesh; triangulate it first");
  const auto nodes = static_cast<double>(C.M.size()), cells = static_cast<double>(C.A.size());
  const auto storage = options.storage;
  const double full = all_pairs_memory(nodes, cells, 8);
  const bool single = storage == Storage::single ||
                      (storage == Storage::automatic && full > 0.5 * available_memory());
  const double bytes = single ? 0.5 * full + 8 * nodes * nodes : full;
  report.sizes.emplace_back("matrices, bytes", bytes);
  check_memory(bytes, "all pairs of " + std::to_string(C.M.size()) + " vertices",
               "simplify the mesh, or measure from some vertices with another method");
  const auto in_full = [&] { return AllPairs<double>(C, options, task).run(report); };
  const auto in_single = [&] {
    try {
      return AllPairs<float>(C, options, task).run(report);
    } catch (const SolveError&) {  // thin triangles take more digits
      check_memory(full, "all pairs of " + std::to_string(C.M.size()) + " vertices",
                   "simplify the mesh: its thin triangles take full precision");
      report.warn("option-without-effect",
                  "thin triangles take full precision: option storage was not followed");
      return in_full();
    }
  };
  MatX U = single ? in_single() : in_full();
  U *= ops.unit;
  for (Eigen::Index i = 0; i < U.rows(); ++i)
    if (C.component[i] < 0) {
      U.row(i).setConstant(infinity);
      U.col(i).setConstant(infinity);
      U(i, i) = 0;
    }
  return U;
}

}  // namespace littoral
