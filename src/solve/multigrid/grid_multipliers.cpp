#include "solve/multigrid/grid_multipliers.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/index.h"
#include "solve/poisson/constrained_poisson.h"

namespace littoral {

namespace {
constexpr int wide = 4;            // cells along a side of a block
constexpr double wave_length = 1;  // half of one, in spacings: of what varies within blocks
constexpr double inner_tolerance = 0.03;
}  // namespace

GridMultipliers::GridMultipliers(std::array<int, 3> n, const Vec3& spacing, const Rows& A,
                                 const VecX& weight, const VecX& softness)
    : block_(A.rows()), share_(A.rows()), inverse_(A.rows()) {
  std::array<int, 3> coarse{};
  Vec3 coarse_spacing = spacing;
  for (int a = 0; a < 3; ++a) {
    const std::size_t s = a;
    coarse[s] = n[s] > 1 ? (n[s] - 2) / wide + 2 : 1;
    if (n[s] > 1) coarse_spacing[a] *= wide;
  }
  const double volume = spacing.prod();
  volumes_ = volume / coarse_spacing.prod();
  const double order = volume * std::cbrt(volume) * wave_length / (2 * M_PI);  // V / (2 k)

  const auto node = [&](const Eigen::Array3i& at) {
    return at[0] + index(coarse[0]) * (at[1] + index(coarse[1]) * at[2]);
  };
  std::map<Eigen::Index, int> blocks;
  Triplets entries;
  std::vector<double> total;
  for (Eigen::Index r = 0; r < A.rows(); ++r) {
    // The mean place of the row, in coarse spacings; linear functions have their values there.
    Eigen::Array3d place = Eigen::Array3d::Zero();
    for (Rows::InnerIterator it(A, r); it; ++it)
      place += it.value() *
               Eigen::Array3d(it.col() % n[0], it.col() / n[0] % n[1], it.col() / n[0] / n[1]);
    place /= wide;
    Eigen::Array3i low;
    for (int a = 0; a < 3; ++a)
      low[a] = std::clamp(static_cast<int>(place[a]), 0, std::max(0, coarse[a] - 2));
    const auto [found, fresh] = blocks.emplace(node(low), int_size(blocks));
    const int block = found->second;
    if (fresh) total.push_back(0);
    block_[r] = block;
    total[block] += weight[r];
    inverse_[r] = weight[r] / (order + softness[r] * weight[r]);
    const Eigen::Array3d t = place - low.cast<double>();
    for (int c = 0; c < 8; ++c) {
      const Eigen::Array3i step(c & 1, c >> 1 & 1, c >> 2);
      const double value = weight[r] * (step > 0).select(t, 1 - t).prod();
      if (value != 0) entries.emplace_back(block, static_cast<int>(node(low + step)), value);
    }
  }
  const Eigen::Map<const VecX> sums(total.data(), index(total.size()));
  A_.resize(sums.size(), index(coarse[0]) * coarse[1] * coarse[2]);
  A_.setFromTriplets(entries.begin(), entries.end());
  A_ = sums.cwiseInverse().asDiagonal() * A_;
  softness_ = VecX::Zero(sums.size());
  for (Eigen::Index r = 0; r < A.rows(); ++r) {
    const int block = block_[r];
    share_[r] = weight[r] / sums[block];
    softness_[block] += share_[r] * share_[r] * softness[r];
  }
  held_ = std::make_unique<HeldGrid>(coarse, coarse_spacing, A_);
}

VecX GridMultipliers::operator()(const VecX& residual, const Task& task) const {
  VecX mean = VecX::Zero(A_.rows());
  for (Eigen::Index r = 0; r < residual.size(); ++r) mean[block_[r]] += share_[r] * residual[r];
  VecX varying(residual.size()), excess = VecX::Zero(A_.rows());
  for (Eigen::Index r = 0; r < residual.size(); ++r) {
    const int block = block_[r];
    varying[r] = inverse_[r] * (residual[r] - mean[block]);
    excess[block] += varying[r];
  }
  const ConstraintSolver solver{
      [&](const VecX& v) -> VecX { return volumes_ * held_->across(v, task); }, {}, {}};
  mean.array() -= mean.mean();
  const double start = mean.norm() / std::sqrt(static_cast<double>(mean.size()));
  Report ignored;
  const VecX multiplier =
      constraint_multipliers(solver, {A_, softness_, inner_tolerance * start}, mean, task, ignored);
  for (Eigen::Index r = 0; r < residual.size(); ++r) {
    const int block = block_[r];
    varying[r] += share_[r] * (multiplier[block] - excess[block]);
  }
  return varying;
}

}  // namespace littoral
