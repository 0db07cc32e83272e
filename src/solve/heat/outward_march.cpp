#include "solve/heat/outward_march.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/index.h"
#include "base/now_and_then.h"

namespace littoral {

namespace {
constexpr int buckets_per_length = 4;  // blocks of one are settled in any order
constexpr double least_step = 1e-3;    // decay lengths
}  // namespace

template <class Scalar>
OutwardMarch<Scalar>::OutwardMarch(const HermitianRows<Scalar>& A, const VecX& M,
                                   const std::vector<int>& from)
    : A_(A), M_(M), place_(A.size(), untouched), blocks_(A.size()) {
  if (from.empty()) return;
  buckets_.push_back(from);
  for (const int i : from) {
    place_[i] = int_size(ahead_);
    ahead_.push_back({0, 0});
  }
}

template <class Scalar>
void OutwardMarch<Scalar>::reach(int strides, const Task& task) {
  constexpr std::size_t of_stride = std::size_t(stride) * buckets_per_length;
  for (; !ended() && present_ < std::size_t(strides) * of_stride; ++present_) {
    for (std::size_t k = 0; k < buckets_.front().size(); ++k) {  // grows meanwhile
      stop_now_and_then(k, task);
      const std::vector<int>& bucket = buckets_.front();
      const int i = bucket[k];
      if (k + blocks_ahead < bucket.size()) A_.fetch(bucket[k + blocks_ahead]);
      if (place_[i] == settled) continue;
      const int place = std::exchange(place_[i], settled);
      free_.push_back(place);
      blocks_[reached_++] = i;
      settle(i, ahead_[place].d);
    }
    buckets_.pop_front();
    if ((present_ + 1) % of_stride == 0 || ended()) nearer_than_.push_back(reached_);
  }
  if (!ended()) return;
  std::vector<int>().swap(place_);
  std::vector<Ahead>().swap(ahead_);
  std::vector<int>().swap(free_);
  buckets_.clear();
}

template <class Scalar>
void OutwardMarch<Scalar>::settle(int i, double d) {
  A_.couplings(i, beside_);
  for (const auto& [j, w] : beside_) {
    if (place_[j] == settled || !(w > 0)) continue;
    if (place_[j] == untouched) {
      place_[j] = free_.empty() ? int_size(ahead_) : free_.back();
      if (free_.empty())
        ahead_.emplace_back();
      else
        free_.pop_back();
      ahead_[place_[j]] = {infinity, d};
    }
    Ahead& at = ahead_[place_[j]];
    if (!(d < at.d)) continue;
    // With X = exp(d_j - first), P and Q the sums of w exp(-x) and w exp(x): P X + Q / X = 2 w + M.
    const double x = d - at.first, e = std::expm1(x), f = e / (1 + e);
    at.w += w;
    at.s += w * e * f;
    at.a += w * (e + f);
    const double m = M_[j] > 0 ? M_[j] : 1, rest = m - at.s, P2 = 2 * at.w + at.s - at.a;
    const double root = std::sqrt(std::max(0.0, rest * (4 * at.w + m + at.s) + at.a * at.a));
    const double step = std::log1p(std::min((rest + at.a + root) / P2, 1e300));
    const double next = std::max(at.first + step, d + least_step);
    if (!(next < at.d)) continue;
    at.d = next;
    const std::size_t bucket = std::size_t(next * buckets_per_length) - present_;
    if (bucket >= buckets_.size()) buckets_.resize(bucket + 1);
    buckets_[bucket].push_back(j);
  }
}

template class OutwardMarch<double>;
template class OutwardMarch<Complex>;

}  // namespace littoral
