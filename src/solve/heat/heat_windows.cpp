#include "solve/heat/heat_windows.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/index.h"
#include "base/now_and_then.h"
#include "base/parallel.h"
#include "base/platform/large_pages.h"
#include "solve/direct/cholesky.h"

namespace littoral {

namespace {
constexpr int window = 40;            // decay lengths kept of every window
constexpr int shortest_overlap = 20;  // and solved for beyond: the error made at the far end
                                      // arrives at what is kept exp(-2 * overlap) times smaller
constexpr int longest_overlap = 80;
constexpr double around_prescribed =
    18;  // what lies beyond does not change a source that prescribes values
constexpr double negligible = 1e-250;
/// The same with several layers made one where the range of numbers allows it.
template <class Scalar>
ScaledField<Scalar> with_fewer_layers(ScaledField<Scalar> field, int block) {
  constexpr double range = 1e-60;
  std::vector<double> scale, unit;  // new layers; old layers in units of their new one
  std::vector<int> layer;           // old layers: the new one
  for (double s : field.scale) {
    if (unit.empty() || unit.back() * s < range) {
      scale.push_back(unit.empty() ? s : unit.back() * s);
      unit.push_back(1);
    } else {
      unit.push_back(unit.back() * s);
    }
    layer.push_back(int_size(scale) - 1);
  }
  for (std::size_t i = 0; i < field.layer.size(); ++i) {
    int& p = field.layer[i];
    if (p < 0) continue;
    field.x.segment(index(i) * block, block) *= unit[p];
    p = layer[p];
  }
  field.scale = std::move(scale);
  return field;
}

Outward in_steps(const std::vector<double>& d) {
  Outward out;
  for (const double at : d) {
    if (!(at < infinity)) continue;
    const auto k = static_cast<std::size_t>(at);
    if (k + 1 >= out.begin.size()) out.begin.resize(k + 2, 0);
    ++out.begin[k + 1];
  }
  std::partial_sum(out.begin.begin(), out.begin.end(), out.begin.begin());
  out.blocks.resize(out.begin.back());
  std::vector<std::size_t> next = out.begin;
  for (std::size_t i = 0; i < d.size(); ++i)
    if (d[i] < infinity) out.blocks[next[static_cast<std::size_t>(d[i])]++] = static_cast<int>(i);
  return out;
}

}  // namespace

VecX decay_lengths(const VecX& M, double t) { return (M.array().max(0.0) / t).sqrt(); }

template <class Scalar>
HeatWindows<Scalar>::HeatWindows(std::shared_ptr<const Matrix> lower, int block, VecX size,
                                 const Ordering& order)
    : A_(std::move(lower)), block_(block), size_(std::move(size)), position_(order.size()) {
  for (std::size_t k = 0; k < order.size(); ++k) position_[order[k]] = k;
  auto for_edges = [&](const auto& put) {
    for (int j = 0; j < A_->outerSize(); j += block_)  // the first unknown's column names them all
      for (typename Matrix::InnerIterator it(*A_, j); it; ++it)
        if (it.row() % block_ == 0 && it.row() != j) put(it.row() / block_, j / block_);
  };
  begin_.assign(order.size() + 1, 0);
  for_edges([&](int i, int j) {
    ++begin_[i];
    ++begin_[j];
  });
  int sum = 0;
  for (int& b : begin_) sum += std::exchange(b, sum);
  to_.resize(sum);
  std::vector<int> at = begin_;
  for_edges([&](int i, int j) {
    to_[at[i]++] = j;
    to_[at[j]++] = i;
  });
}

template <class Scalar>
Ordering HeatWindows<Scalar>::order() const {
  Ordering order(position_.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[position_[i]] = static_cast<int>(i);
  return order;
}

template <class Scalar>
std::vector<double> HeatWindows<Scalar>::distances(const std::vector<int>& from, double limit,
                                                   const Task& task) const {
  // Dijkstra's algorithm with buckets one decay length wide, settled in any order inside of one.
  std::vector<double> d(position_.size(), infinity);
  std::vector<std::vector<std::pair<double, int>>> buckets(1);
  for (int i : from) {
    d[i] = 0;
    buckets[0].emplace_back(0, i);
  }
  for (std::size_t b = 0; b < buckets.size() && static_cast<double>(b) <= limit; ++b) {
    stop_if_cancelled(task);
    for (std::size_t k = 0; k < buckets[b].size(); ++k) {  // grows meanwhile
      const auto [at, i] = buckets[b][k];
      if (at > d[i]) continue;
      for (int e = begin_[i]; e < begin_[i + 1]; ++e) {
        const int j = to_[e];
        const double next = at + 2 * std::asinh(0.25 * (size_[i] + size_[j]) + 1e-3);
        if (!(next < d[j])) continue;
        d[j] = next;
        const std::size_t bucket = next;
        if (bucket >= buckets.size()) buckets.resize(bucket + 1);
        buckets[bucket].emplace_back(next, j);
      }
    }
    std::vector<std::pair<double, int>>().swap(buckets[b]);
  }
  return d;
}

template <class Scalar>
std::vector<std::vector<int>> HeatWindows<Scalar>::parts(std::span<const int> blocks) const {
  constexpr int outside = -2, in_none = -1;
  std::vector<int> part(position_.size(), outside), in_order(position_.size(), -1);
  for (const int i : blocks) {
    part[i] = in_none;
    in_order[position_[i]] = i;
  }
  std::vector<std::size_t> sizes;
  std::vector<int> own;
  for (const int first : blocks) {
    if (part[first] != in_none) continue;
    const int number = int_size(sizes);
    own.assign(1, first);
    part[first] = number;
    for (std::size_t k = 0; k < own.size(); ++k)  // grows meanwhile
      for (int e = begin_[own[k]]; e < begin_[own[k] + 1]; ++e)
        if (part[to_[e]] == in_none) {
          part[to_[e]] = number;
          own.push_back(to_[e]);
        }
    sizes.push_back(own.size());
  }
  std::vector<std::vector<int>> out(sizes.size());
  for (std::size_t p = 0; p < out.size(); ++p) out[p].reserve(sizes[p]);
  for (const int i : in_order)
    if (i >= 0) out[part[i]].push_back(i);
  return out;
}

template <class Scalar>
typename HeatWindows<Scalar>::Vector HeatWindows<Scalar>::solve_region(
    const std::vector<int>& blocks, const std::vector<char>& known, const Vector& x, Vector r,
    std::vector<int>& local, const Task& task) const {
  // Columns that hold entries of these rows: their own and those of known neighbours.
  std::vector<int> columns = blocks;
  for (std::size_t k = 0; k < blocks.size(); ++k) local[blocks[k]] = k;
  std::vector<int> neighbours;
  for (int i : blocks)
    for (int e = begin_[i]; e < begin_[i + 1]; ++e)
      if (known[to_[e]]) neighbours.push_back(to_[e]);
  std::sort(neighbours.begin(), neighbours.end());
  neighbours.erase(std::unique(neighbours.begin(), neighbours.end()), neighbours.end());
  columns.insert(columns.end(), neighbours.begin(), neighbours.end());

  const auto n = index(blocks.size()) * block_;
  Matrix K(n, n);
  auto for_entries = [&](const auto& put) {
    for (int block_column : columns)
      for (int j = block_column * block_; j < (block_column + 1) * block_; ++j)
        for (typename Matrix::InnerIterator it(*A_, j); it; ++it) {
          const int i = it.row(), li = local[i / block_], lj = local[j / block_];
          const int a = li < 0 ? -1 : li * block_ + i % block_;
          const int b = lj < 0 ? -1 : lj * block_ + j % block_;
          put(i, j, a, b, it.value());
        }
  };
  int* begin = K.outerIndexPtr();
  std::fill(begin, begin + n + 1, 0);
  for_entries([&](int i, int j, int a, int b, const Scalar& z) {
    if (a >= 0 && b >= 0) ++begin[std::min(a, b)];
    if (a >= 0 && b < 0 && known[j / block_]) r[a] -= z * x[j];
    if (b >= 0 && a < 0 && known[i / block_]) r[b] -= Eigen::numext::conj(z) * x[i];
  });
  int sum = 0;
  for (Eigen::Index k = 0; k <= n; ++k) sum += std::exchange(begin[k], sum);
  K.resizeNonZeros(sum);
  std::vector<int> at(begin, begin + n);
  for_entries([&](int, int, int a, int b, const Scalar& z) {
    if (a < 0 || b < 0) return;
    const int e = at[std::min(a, b)]++;
    K.innerIndexPtr()[e] = std::max(a, b);
    K.valuePtr()[e] = a >= b ? z : Eigen::numext::conj(z);
  });
  for (int i : blocks) local[i] = -1;
  Ordering in_order(n);
  std::iota(in_order.begin(), in_order.end(), 0);
  const auto structure = std::make_shared<const Elimination>(K, in_order, task);
  return raised_cholesky(K, structure, task).factor.solve(r);
}

template <class Scalar>
std::optional<ScaledField<Scalar>> HeatWindows<Scalar>::solve(const HeatSource<Scalar>& b,
                                                              const std::vector<int>& piece,
                                                              const Task& task,
                                                              Report& report) const {
  const FlushSubnormals flush;
  const KeepLargePages keep;
  std::vector<int> from;
  for (const int i : b.blocks)
    if (piece[i] >= 0) from.push_back(i);
  const Outward outward = in_steps(distances(from, infinity, task));

  std::optional<ScaledField<Scalar>> best;
  double least = 1e-9;  // more is not an answer
  int best_windows = 0;
  for (int overlap = shortest_overlap; overlap <= longest_overlap; overlap *= 2) {
    auto field = solve(b, outward, overlap, task);
    if (!field) break;
    const double error = misfit(*field, b, task);
    if (best && !(error < 0.1 * least)) break;  // round-off
    if (!(error < least)) continue;
    best_windows = field->scale.size();
    best = std::move(field);
    least = error;
    if (error < 1e-12) break;
  }
  if (!best) return std::nullopt;
  report.iterations.emplace_back("heat windows", best_windows);
  report.residuals.emplace_back("heat, between windows", least);
  return with_fewer_layers(std::move(*best), block_);
}

template <class Scalar>
std::optional<ScaledField<Scalar>> HeatWindows<Scalar>::solve(const HeatSource<Scalar>& b,
                                                              const Outward& outward, int overlap,
                                                              const Task& task) const {
  const std::vector<int>& order = outward.blocks;
  ScaledField<Scalar> field{Vector::Zero(A_->rows()), std::vector<int>(position_.size(), -1), {}};
  std::vector<int> local(position_.size(), -1);
  std::vector<char> known(position_.size(), 0), inside(position_.size(), 0);
  int windows = 0;
  for (std::size_t before = 0, start = 0; start < order.size(); ++windows) {
    task.checkpoint(double(start) / double(order.size()));
    const int reach = (windows + 1) * window;
    const std::size_t kept = outward.nearer_than(reach);
    const std::size_t end = outward.nearer_than(reach + overlap);
    if (kept == start) return std::nullopt;  // steps longer than a window
    for (std::size_t k = start; k < kept; ++k) inside[order[k]] = 1;
    double top = 0;
    for (const std::vector<int>& blocks : parts({&order[start], &order[start] + (end - start)})) {
      Vector r = Vector::Zero(index(blocks.size()) * block_);
      if (windows == 0)
        for (std::size_t k = 0; k < blocks.size(); ++k)
          if (const Scalar* value = b.at(blocks[k]))
            for (int c = 0; c < block_; ++c) r[index(k) * block_ + c] = value[c];
      const Vector z = solve_region(blocks, known, field.x, std::move(r), local, task);
      for (Eigen::Index k = 0; k < Eigen::Index(blocks.size()); ++k) {
        if (!inside[blocks[k]]) continue;
        top = std::max(top, block_magnitude(z, k, block_));
        field.x.segment(Eigen::Index(blocks[k]) * block_, block_) = z.segment(k * block_, block_);
      }
    }
    if (!(top > 0) || !std::isfinite(top)) return std::nullopt;
    for (std::size_t k = start; k < kept; ++k) {
      const Eigen::Index i = order[k];
      if (!(block_magnitude(field.x, i, block_) > negligible * top)) return std::nullopt;
      field.x.segment(i * block_, block_) /= top;
      field.layer[i] = windows;
      known[i] = 1;
    }
    field.scale.push_back(top);
    for (; before < start; ++before) known[order[before]] = 0;
    start = kept;
  }
  return field;
}

template <class Scalar>
double HeatWindows<Scalar>::misfit(const ScaledField<Scalar>& field, const HeatSource<Scalar>& b,
                                   const Task& task) const {
  // (A x)_i at blocks with neighbours in the next layer, in units of their own, relative to the
  // size of its terms; where b is 0, as it is away from the sources.
  std::vector<int> front(position_.size(), -1);  // blocks: place among those
  int n_front = 0;
  for (std::size_t i = 0; i < front.size(); ++i)
    for (int e = begin_[i]; e < begin_[i + 1] && front[i] < 0; ++e)
      if (field.layer[i] >= 0 && field.layer[to_[e]] > field.layer[i]) front[i] = n_front++;
  Vector sum = Vector::Zero(Eigen::Index{n_front} * block_);
  VecX size = VecX::Zero(sum.size());
  auto add = [&](Eigen::Index i, Eigen::Index j, const Scalar& a) {
    const Eigen::Index bi = i / block_, bj = j / block_;
    if (front[bi] < 0 || field.layer[bj] < 0) return;
    double unit = 1;
    if (field.layer[bj] > field.layer[bi]) {
      unit = field.scale[field.layer[bj]];
    } else if (field.layer[bj] < field.layer[bi]) {
      unit = 1 / field.scale[field.layer[bi]];
    }
    const Scalar term = a * field.x[j] * unit;
    const Eigen::Index at = Eigen::Index{front[bi]} * block_ + i % block_;
    sum[at] += term;
    size[at] += magnitude(term);
  };
  for (int j = 0; j < A_->outerSize(); ++j) {
    stop_now_and_then(j, task);
    for (typename Matrix::InnerIterator it(*A_, j); it; ++it) {
      add(it.row(), j, it.value());
      if (it.row() != j) add(j, it.row(), Eigen::numext::conj(it.value()));
    }
  }
  double worst = 0;
  for (std::size_t i = 0; i < front.size(); ++i) {
    if (front[i] < 0) continue;
    const Scalar* value = b.at(static_cast<int>(i));
    for (int k = 0; k < block_; ++k) {
      const Eigen::Index at = Eigen::Index{front[i]} * block_ + k;
      if (size[at] > 0 && (!value || value[k] == Scalar(0)))
        worst = std::max(worst, magnitude(sum[at]) / size[at]);
    }
  }
  return worst;
}

template <class Scalar>
typename HeatWindows<Scalar>::Vector HeatWindows<Scalar>::source_prescribing(
    const Vector& values, const Task& task) const {
  const FlushSubnormals flush;
  const int n = position_.size();
  std::vector<char> known(position_.size(), 0);
  std::vector<int> from, blocks, local(position_.size(), -1);
  for (int i = 0; i < n; ++i)
    if (block_magnitude(values, i, block_) > 0) {
      known[i] = 1;
      from.push_back(i);
    }
  const std::vector<double> d = distances(from, around_prescribed, task);
  for (int i = 0; i < n; ++i)
    if (!known[i] && d[i] <= around_prescribed) blocks.push_back(i);
  std::sort(blocks.begin(), blocks.end(),
            [&](int i, int j) { return position_[i] < position_[j]; });
  Vector x = values;
  const Vector z =
      solve_region(blocks, known, values, Vector::Zero(index(blocks.size()) * block_), local, task);
  for (std::size_t k = 0; k < blocks.size(); ++k)
    x.segment(Eigen::Index(blocks[k]) * block_, block_) = z.segment(index(k) * block_, block_);
  // b = A x in the rows of prescribed blocks, whose entries are in their own columns and their
  // neighbours'.
  std::vector<int> columns = from;
  for (int i : from)
    for (int e = begin_[i]; e < begin_[i + 1]; ++e)
      if (!known[to_[e]]) columns.push_back(to_[e]);
  std::sort(columns.begin(), columns.end());
  columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
  Vector b = Vector::Zero(values.size());
  for (int c : columns)
    for (int j = c * block_; j < (c + 1) * block_; ++j)
      for (typename Matrix::InnerIterator it(*A_, j); it; ++it) {
        const Eigen::Index i = it.row();
        if (known[i / block_]) b[i] += it.value() * x[j];
        if (i != j && known[c]) b[j] += Eigen::numext::conj(it.value()) * x[i];
      }
  return b;
}

template class HeatWindows<double>;
template class HeatWindows<Complex>;

}  // namespace littoral
