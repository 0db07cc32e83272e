#include "methods/geodesic/merge_windows.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace littoral {

namespace {

constexpr std::size_t fewest = 4;  // windows of an edge that it pays for

bool can_join(const Window& w, const Window& next, double length) {
  return w.open && next.open && !w.parallel && !next.parallel && w.source == next.source &&
         w.page == next.page && next.b0 - w.b1 <= narrow_share * length;
}

/// The rays of one point with the distances of both ends of a chain whose outermost rays enclose
/// those of the chain: of all such points the farthest.
std::optional<Window> enclosing(const Window& first, const Window& last) {
  Window w = first;
  w.b1 = last.b1;
  w.d1 = last.d1;
  w.depth = std::max(first.depth, last.depth);
  // r from the first end and r + rise from the last: r^2 + 2 r s l + l^2 = (r + rise)^2 with the
  // slope s at the first end, which falls as r falls, as that at the last rises.
  const double l = w.b1 - w.b0, rise = w.d1 - w.d0, squares = (l - rise) * (l + rise);
  double r = w.d0;
  const double over_first = 2 * (rise - l * first.slope(w.b0));
  if (over_first > 0) r = std::min(r, squares / over_first);
  const double over_last = 2 * (l * last.slope(w.b1) - rise);
  if (over_last > 0) r = std::min(r, squares / over_last - rise);
  const double s = rise / l - squares / (2 * r * l);
  if (!(r > 0) || !(std::abs(s) < 1)) return std::nullopt;
  w.behind = w.d0 - r;
  w.x = w.b0 - r * s;
  w.y = -r * std::sqrt((1 - s) * (1 + s));
  return w;
}

/// How fast the slope grows along the edge where the distance is `d`.
double bend(const Window& w, double p, double d) {
  const double r = d - w.behind, slope = (p - w.x) / r;
  return (1 - slope * slope) / r;
}

/// Bounds how far distances of two windows are apart on the stretch of the first.
double largest_difference(const Window& w, const Window& other) {
  const double o0 = other.at(w.b0), o1 = other.at(w.b1), width = w.b1 - w.b0;
  const double bends = std::max(std::abs(bend(w, w.b0, w.d0) - bend(other, w.b0, o0)),
                                std::abs(bend(w, w.b1, w.d1) - bend(other, w.b1, o1)));
  return std::max(std::abs(w.d0 - o0), std::abs(w.d1 - o1)) + 0.25 * width * width * bends;
}

class Merging {
 public:
  Merging(const WindowBlock& all, double tolerance, double error)
      : all_(all), tolerance_(tolerance), error_(error) {}

  /// One window in place of windows begin, ..., end - 1.
  std::optional<Window> joined(std::size_t begin, std::size_t end) {
    const auto one = enclosing(all_[begin], all_[end - 1]);
    if (!one) return one;
    double apart = 0, least = std::numeric_limits<double>::infinity();
    for (std::size_t i = begin; i < end; ++i) {
      const Window w = all_[i];
      apart = std::max(apart, largest_difference(w, *one));
      least = std::min(least, w.least());
      if (!(apart <= tolerance_ * least - error_)) return std::nullopt;
    }
    changed_ = std::max(changed_, apart);
    return one;
  }
  double changed() const { return changed_; }

 private:
  const WindowBlock& all_;
  double tolerance_, error_, changed_ = 0;
};

}  // namespace

double merge_windows(WindowBlock& all, double length, double tolerance, double error) {
  const std::size_t n = all.size();
  if (n < fewest) return 0;
  Merging merging(all, tolerance, error);
  std::size_t kept = 0;
  for (std::size_t begin = 0; begin < n;) {
    std::size_t run = begin + 1;
    while (run < n && can_join(all[run - 1], all[run], length)) ++run;
    while (begin < run) {
      Window best = all[begin];
      std::size_t count = 1;
      for (std::size_t more = 1; begin + count < run; more *= 2) {
        const std::size_t tried = std::min(count + more, run - begin);
        const auto one = merging.joined(begin, begin + tried);
        if (!one) break;
        best = *one;
        count = tried;
      }
      all.set(kept++, best);
      begin += count;
    }
  }
  all.resize(kept);
  return merging.changed();
}

}  // namespace littoral
