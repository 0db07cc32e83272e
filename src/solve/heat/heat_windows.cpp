#include "solve/heat/heat_windows.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/beside.h"
#include "base/disjoint_sets.h"
#include "base/index.h"
#include "base/now_and_then.h"
#include "base/parallel_sum.h"
#include "base/platform/large_pages.h"
#include "solve/heat/heat_region.h"

namespace littoral {

namespace {
// In strides of 16 decay lengths.
constexpr int window = 2;            // kept of every window
constexpr int shortest_overlap = 1;  // and solved for beyond: the error made at the far end arrives
                                     // at what is kept exp(-2 * 16 * overlap) times smaller
constexpr int longest_overlap = 4;
constexpr int around_prescribed = 1;  // what lies beyond does not change a source that prescribes
                                      // values
constexpr double negligible = 1e-250;
constexpr std::size_t window_grain = 4096;
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
  parallel_for(field.layer.size(), window_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      int& p = field.layer[i];
      if (p < 0) continue;
      field.x.segment(index(i) * block, block) *= unit[p];
      p = layer[p];
    }
  });
  field.scale = std::move(scale);
  return field;
}

/// How many parts of a window, the largest first, are solved one by one, each by all threads. The
/// others are solved side by side, a thread each, as some steps of a factorization are work for one
/// thread: where that keeps nearly all threads busy and takes hardly more memory than the largest
/// part so far.
std::size_t solved_alone(const std::vector<std::vector<int>>& parts, std::size_t largest) {
  const std::size_t threads = std::size_t(thread_count());
  std::size_t rest = 0, k = 0;
  for (const std::vector<int>& part : parts) rest += part.size();
  for (; k < parts.size(); rest -= parts[k++].size())
    if (4 * threads * parts[k].size() <= 5 * std::min(largest, rest)) break;
  return k;
}

}  // namespace

template <class Scalar>
HeatWindows<Scalar>::HeatWindows(std::shared_ptr<const Rows> A, const VecX& M,
                                 const Ordering& order)
    : A_(std::move(A)), block_(A_->block()), M_(M), position_(order.size()) {
  for (std::size_t k = 0; k < order.size(); ++k) position_[order[k]] = k;
}

template <class Scalar>
Ordering HeatWindows<Scalar>::order() const {
  Ordering order(position_.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[position_[i]] = static_cast<int>(i);
  return order;
}

template <class Scalar>
std::vector<std::vector<int>> HeatWindows<Scalar>::parts(std::span<const int> blocks,
                                                         std::vector<int>& local) const {
  std::vector<int> in_order(position_.size(), -1);
  for (const int i : blocks) in_order[position_[i]] = i;
  in_order.erase(std::remove(in_order.begin(), in_order.end(), -1), in_order.end());
  const std::size_t n = in_order.size();
  for (std::size_t k = 0; k < n; ++k) local[in_order[k]] = static_cast<int>(k);
  // Parts of runs of the order, which are joined along what couples them to runs before.
  struct Run {
    int parts = 0;
    std::vector<std::pair<int, int>> joins;  // own parts and blocks of runs before, by their places
  };
  std::vector<Run> runs((n + window_grain - 1) / window_grain);
  std::vector<int> part(n, -1);  // in its run
  parallel_for(n, window_grain, [&](std::size_t begin, std::size_t end) {
    Run here;
    std::vector<int> own, beside;
    for (std::size_t first = begin; first < end; ++first) {
      if (part[first] >= 0) continue;
      own.assign(1, static_cast<int>(first));
      part[first] = here.parts;
      for (std::size_t k = 0; k < own.size(); ++k) {  // grows meanwhile
        if (k + blocks_ahead < own.size()) A_->fetch(in_order[own[k + blocks_ahead]]);
        A_->neighbours(in_order[own[k]], beside);
        for (const int j : beside) {
          const int to = local[j];
          if (to < 0 || std::size_t(to) >= end) continue;
          if (std::size_t(to) < begin) {
            here.joins.emplace_back(here.parts, to);
          } else if (part[to] < 0) {
            part[to] = here.parts;
            own.push_back(to);
          }
        }
      }
      ++here.parts;
    }
    runs[begin / window_grain] = std::move(here);
  });
  DisjointSets sets;
  std::vector<int> first_set;
  for (const Run& r : runs) {
    first_set.push_back(sets.size());
    for (int p = 0; p < r.parts; ++p) sets.add();
  }
  const auto set_of = [&](std::size_t k) { return first_set[k / window_grain] + part[k]; };
  for (std::size_t r = 0; r < runs.size(); ++r)
    for (const auto& [p, k] : runs[r].joins) sets.join(first_set[r] + p, set_of(std::size_t(k)));
  int count = 0;
  const std::vector<int> number = sets.numbered(count);
  std::vector<std::size_t> sizes(count, 0);
  for (std::size_t k = 0; k < n; ++k) ++sizes[number[set_of(k)]];
  std::vector<std::vector<int>> out(count);
  for (int p = 0; p < count; ++p) out[p].reserve(sizes[p]);
  for (std::size_t k = 0; k < n; ++k) {
    local[in_order[k]] = -1;
    out[number[set_of(k)]].push_back(in_order[k]);
  }
  return out;
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
  OutwardMarch<Scalar> march(*A_, M_, from);

  std::optional<ScaledField<Scalar>> best;
  double least = 1e-9;  // more is not an answer
  int best_windows = 0;
  for (int overlap = shortest_overlap; overlap <= longest_overlap; overlap *= 2) {
    auto field = solve(b, march, overlap, task);
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
                                                              OutwardMarch<Scalar>& march,
                                                              int overlap, const Task& task) const {
  const std::size_t n = position_.size();
  ScaledField<Scalar> field{Vector(index(n) * block_), std::vector<int>(n, -1), {}};
  std::vector<int> local(n, -1), local_of_next = local;
  std::vector<char> known(n, 0), inside(n, 0);
  const int* const order = march.blocks();
  struct Window {
    int number;
    std::size_t start, kept, end;  // in the order
    bool last;
    std::vector<std::vector<int>> parts;  // the largest first
  } next{-1, 0, 0, 0, false, {}};
  const auto make_next = [&](const Task& stop) {
    const int from = ++next.number * window, kept = from + window;
    march.reach(kept + overlap, stop);
    next.start = march.nearer_than(from);
    next.kept = march.nearer_than(kept);
    next.end = march.nearer_than(kept + overlap);
    next.last = march.ended() && next.kept == next.end;
    next.parts = parts({order + next.start, next.end - next.start}, local_of_next);
    std::stable_sort(next.parts.begin(), next.parts.end(),
                     [](const auto& p, const auto& q) { return p.size() > q.size(); });
  };
  make_next(task);
  std::size_t before = 0, largest = 0;
  for (bool more = next.end > 0; more;) {
    Window here = std::move(next);
    task.checkpoint(double(here.start) / double(n));
    if (here.kept == here.start) return std::nullopt;  // steps longer than a window
    for (std::size_t k = here.start; k < here.kept; ++k) inside[order[k]] = 1;
    // How far a window reaches and its parts do not depend on the window before: the next one is
    // made ready beside.
    std::optional<Beside> beside;
    if (!here.last) beside.emplace(make_next);
    // Keeps what is inside of a part; returns the largest there.
    const auto solve_part = [&](std::vector<int> own, const Task& stop) {
      const HeatRegion<Scalar> region(*A_, std::move(own), local, stop);
      const std::vector<int>& blocks = region.blocks;
      Vector r = Vector::Zero(index(blocks.size()) * block_);
      if (here.number == 0)
        for (std::size_t k = 0; k < blocks.size(); ++k)
          if (const Scalar* value = b.at(blocks[k]))
            for (int c = 0; c < block_; ++c) r[index(k) * block_ + c] = value[c];
      const Vector z = region.solve(*A_, known, field.x, std::move(r), stop);
      const auto keep = [&](std::size_t begin, std::size_t end) {
        double top_here = 0;
        for (std::size_t k = begin; k < end; ++k) {
          if (!inside[blocks[k]]) continue;
          top_here = std::max(top_here, block_magnitude(z, index(k), block_));
          field.x.segment(Eigen::Index(blocks[k]) * block_, block_) =
              z.segment(index(k) * block_, block_);
        }
        return top_here;
      };
      return of_pieces(blocks.size(), window_grain, 0.0, keep, Larger());
    };
    largest = std::max(largest, here.parts.front().size());
    const std::size_t alone = solved_alone(here.parts, largest);
    double top = 0;
    for (std::size_t p = 0; p < alone; ++p)
      top = std::max(top, solve_part(std::move(here.parts[p]), task));
    const auto side_by_side = [&](std::size_t p, std::size_t) {
      return solve_part(std::move(here.parts[alone + p]), task.silent());
    };
    top = of_pieces(here.parts.size() - alone, 1, top, side_by_side, Larger());
    if (beside) beside->finish(task);
    if (!(top > 0) || !std::isfinite(top)) return std::nullopt;
    const auto scale = [&](std::size_t begin, std::size_t end) {
      std::size_t too_small = 0;
      for (std::size_t k = here.start + begin; k < here.start + end; ++k) {
        const Eigen::Index i = order[k];
        if (!(block_magnitude(field.x, i, block_) > negligible * top)) ++too_small;
        field.x.segment(i * block_, block_) /= top;
        field.layer[i] = here.number;
        known[i] = 1;
      }
      return too_small;
    };
    if (of_pieces(here.kept - here.start, window_grain, std::size_t(0), scale) > 0)
      return std::nullopt;
    field.scale.push_back(top);
    for (; before < here.start; ++before) known[order[before]] = 0;
    more = !here.last;
  }
  const auto clear = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (field.layer[i] < 0) field.x.segment(index(i) * block_, block_).setZero();
  };
  parallel_for(n, window_grain, clear);  // where heat does not come to
  return field;
}

template <class Scalar>
double HeatWindows<Scalar>::misfit(const ScaledField<Scalar>& field, const HeatSource<Scalar>& b,
                                   const Task& task) const {
  // (A x)_i at blocks with neighbours in the next layer, in units of their own, relative to the
  // size of its terms; where b is 0, as it is away from the sources.
  const std::size_t n = position_.size();
  const auto worst = [&](std::size_t first, std::size_t end) {
    std::vector<int> beside;
    BlockRow<Scalar> row;
    double here = 0;
    stop_if_cancelled(task);
    for (std::size_t k = first; k < end; ++k) {
      const int i = static_cast<int>(k), layer = field.layer[i];
      if (layer < 0) continue;
      A_->neighbours(i, beside);
      if (std::ranges::none_of(beside, [&](int j) { return field.layer[j] > layer; })) continue;
      A_->row(i, row);
      const Scalar* value = b.at(i);
      for (int c = 0; c < block_; ++c) {
        if (value && value[c] != Scalar(0)) continue;
        Scalar sum = 0;
        double size = 0;
        for (std::size_t s = 0; s < row.blocks.size(); ++s) {
          const int j = row.blocks[s];
          if (field.layer[j] < 0) continue;
          double unit = 1;
          if (field.layer[j] > layer) {
            unit = field.scale[field.layer[j]];
          } else if (field.layer[j] < layer) {
            unit = 1 / field.scale[layer];
          }
          for (int d = 0; d < block_; ++d) {
            const Scalar term =
                row.values[(s * block_ + c) * block_ + d] * field.x[j * block_ + d] * unit;
            sum += term;
            size += magnitude(term);
          }
        }
        if (size > 0) here = std::max(here, magnitude(sum) / size);
      }
    }
    return here;
  };
  return of_pieces(n, window_grain, 0.0, worst, Larger());
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
  OutwardMarch<Scalar> march(*A_, M_, from);
  march.reach(around_prescribed, task);
  for (std::size_t k = from.size(); k < march.nearer_than(around_prescribed); ++k)
    blocks.push_back(march.blocks()[k]);
  std::sort(blocks.begin(), blocks.end(),
            [&](int i, int j) { return position_[i] < position_[j]; });
  Vector x = values;
  const HeatRegion<Scalar> region(*A_, blocks, local, task);
  const Vector z =
      region.solve(*A_, known, values, Vector::Zero(index(blocks.size()) * block_), task);
  for (std::size_t k = 0; k < blocks.size(); ++k)
    x.segment(Eigen::Index(blocks[k]) * block_, block_) = z.segment(index(k) * block_, block_);
  Vector b = Vector::Zero(values.size());  // A x, in the rows of prescribed blocks
  BlockRow<Scalar> row;
  for (const int i : from) {
    A_->row(i, row);
    const Scalar* value = row.values.data();
    for (const int j : row.blocks)
      for (int c = 0; c < block_; ++c)
        for (int k = 0; k < block_; ++k) b[i * block_ + c] += *value++ * x[j * block_ + k];
  }
  return b;
}

template class HeatWindows<double>;
template class HeatWindows<Complex>;

}  // namespace littoral
