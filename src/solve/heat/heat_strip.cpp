#include "solve/heat/heat_strip.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "base/index.h"
#include "base/now_and_then.h"

namespace littoral {

namespace {

constexpr int columns_of_strip = strip_width;
using Columns = std::array<double, strip_width>;
constexpr std::uint8_t older = 0, outside = 1, fresh = 2;  // earlier layers, none, this one

}  // namespace

StripHeat::StripHeat(std::shared_ptr<const HeatSystem<double>> system,
                     const std::vector<int>& row_of, std::vector<int> component, int n_components)
    : system_(std::move(system)),
      row_of_(row_of),
      component_(std::move(component)),
      size_(std::size_t(n_components), 0),
      solve_(*system_->factor(), row_of) {
  for (const int c : component_)
    if (c >= 0) ++size_[c];
}

void StripHeat::scale_components(ScaledStrip& field, std::span<const int> given,
                                 std::vector<double>& unreached) const {
  std::vector<double> largest(size_.size() * columns_of_strip, 0);
  for (const int i : given)
    for (int k = 0; k < columns_of_strip && component_[i] >= 0; ++k) {
      double& most = largest[component_[i] * columns_of_strip + k];
      most = std::max(most, std::abs(field.x(i, k)));
    }
  for (const int i : given)
    for (int k = 0; k < columns_of_strip; ++k) {
      const double most = component_[i] < 0 ? 0 : largest[component_[i] * columns_of_strip + k];
      field.x(i, k) = most > 0 ? field.x(i, k) / most : 0;
    }
  field.missed.fill(0);
  unreached.resize(largest.size());
  for (std::size_t at = 0; at < largest.size(); ++at) {
    const bool any = largest[at] > 0;
    unreached[at] = any ? 0 : infinity;
    if (any) field.missed[at % columns_of_strip] += size_[at / columns_of_strip];
  }
}

void StripHeat::solve(ScaledStrip& field, std::span<const int> given, bool first_layer,
                      Strip& spare, const Task& task) const {
  std::vector<double> unreached;  // +inf for components and columns without a source
  scale_components(field, given, unreached);
  field.layer.clear();
  for (auto& scale : field.scale) scale.assign(1, 1.0);
  if (given.empty()) return field.passes.fill(0);
  solve_(field.x, given, spare, task);
  Columns least, top;
  least.fill(infinity);
  top.fill(0);
  for (std::size_t i = 0; i < component_.size(); ++i) {
    if (component_[i] < 0) continue;
    const double* x = field.x.data() + i * columns_of_strip;
    const double* beside = unreached.data() + component_[i] * columns_of_strip;
    for (int k = 0; k < columns_of_strip; ++k) {
      const double m = std::abs(x[k]), n = m + beside[k];
      top[k] = m > top[k] ? m : top[k];
      least[k] = n < least[k] ? n : least[k];
    }
  }
  bool deep = false;
  for (int k = 0; k < columns_of_strip; ++k) deep = deep || !(least[k] >= heat_front * top[k]);
  if (!deep) {
    for (int k = 0; k < columns_of_strip; ++k) {
      field.passes[k] = field.missed[k] > 0;
      if (top[k] > 0 && std::isfinite(top[k])) field.missed[k] = 0;
    }
    return;
  }
  if (!first_layer) return solve_in_passes(field, spare, task);
  field.passes.fill(1);
  for (Eigen::Index i = 0; i < field.x.rows(); ++i)
    for (int k = 0; k < columns_of_strip; ++k)
      if (!(std::abs(field.x(i, k)) >= heat_front * top[k])) field.x(i, k) = 0;
}

void StripHeat::solve_in_passes(ScaledStrip& field, Strip& spare, const Task& task) const {
  const Eigen::Index n = field.x.rows();
  const SpMat& A = system_->lower();
  Strip r = field.x;  // the solution of the pass, and what is left after it
  field.layer.assign(field.x.size(), -1);
  field.passes.fill(0);
  std::vector<std::uint8_t> side(field.x.size(), outside);
  std::array<bool, strip_width> going{};
  for (int k = 0; k < columns_of_strip; ++k) going[k] = field.missed[k] > 0;
  const auto any_going = [&] { return std::find(going.begin(), going.end(), true) != going.end(); };
  std::vector<int> given;
  for (std::int16_t p = 0; any_going(); ++p) {
    if (p > 0) solve_(r, given, spare, task);
    stop_if_cancelled(task);
    Columns top{};
    for (Eigen::Index i = 0; i < r.size(); ++i)
      if (side[i] == outside)
        top[i % columns_of_strip] = std::max(top[i % columns_of_strip], std::abs(r.data()[i]));
    for (int k = 0; k < columns_of_strip; ++k) {
      if (going[k]) ++field.passes[k];
      going[k] = going[k] && top[k] > 0 && std::isfinite(top[k]);
    }
    std::array<Eigen::Index, strip_width> taken{};
    for (Eigen::Index i = 0; i < r.size(); ++i) {
      const auto k = i % columns_of_strip;
      if (!going[k] || side[i] != outside) continue;
      field.x.data()[i] = r.data()[i];
      if (std::abs(r.data()[i]) < heat_front * top[k]) continue;
      field.layer[i] = p;
      side[i] = fresh;
      ++taken[k];
    }
    for (int k = 0; k < columns_of_strip; ++k) {
      field.missed[k] -= taken[k];
      going[k] = going[k] && field.missed[k] > 0 && taken[k] > 0;
    }
    if (!any_going()) break;

    // b - A (x truncated to the layers so far): nonzero on both sides of the front only.
    r.setZero();
    for (int j = 0; j < A.outerSize(); ++j) {
      stop_now_and_then(j, task);
      const auto to_j = index(row_of_[j]) * columns_of_strip;
      for (SpMat::InnerIterator it(A, j); it; ++it) {
        const auto to_i = index(row_of_[it.row()]) * columns_of_strip;
        if (std::memcmp(&side[to_i], &side[to_j], columns_of_strip) == 0) continue;
        for (int k = 0; k < columns_of_strip; ++k) {
          const auto i_k = to_i + k, j_k = to_j + k;
          if (!going[k] || (side[i_k] ^ side[j_k]) != (outside | fresh)) continue;
          const double sign = side[j_k] == fresh ? -it.value() : it.value();
          r.data()[i_k] += sign * field.x.data()[j_k];
          r.data()[j_k] -= sign * field.x.data()[i_k];
        }
      }
    }
    for (std::uint8_t& s : side)
      if (s == fresh) s = older;
    given.clear();
    Columns most{};
    for (Eigen::Index i = 0; i < n; ++i) {
      const double* row = r.data() + i * columns_of_strip;
      bool any = false;
      for (int k = 0; k < columns_of_strip; ++k) {
        any = any || row[k] != 0;
        most[k] = std::max(most[k], std::abs(row[k]));
      }
      if (any) given.push_back(static_cast<int>(i));
    }
    for (int k = 0; k < columns_of_strip; ++k) {
      going[k] = going[k] && most[k] > 0;
      if (!going[k]) continue;
      r.col(k) *= 1 / most[k];
      field.scale[k].push_back(most[k]);
    }
  }
  for (Eigen::Index i = 0; i < r.size(); ++i)
    if (field.layer[i] < 0) field.x.data()[i] = 0;
}

}  // namespace littoral
