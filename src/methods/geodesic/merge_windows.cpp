#include "methods/geodesic/merge_windows.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "methods/geodesic/window_kernels.h"

namespace littoral {

namespace {

constexpr std::size_t fewest = 4;  // windows of an edge that it pays for

bool can_join(const Window& w, const Window& next, double widest_gap) {
  return w.open && next.open && !w.parallel && !next.parallel && w.source == next.source &&
         w.page == next.page && next.b0 - w.b1 <= widest_gap;
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

}  // namespace

std::optional<Window> one_of(const WindowBlock& windows, std::size_t begin, std::size_t end,
                             const Joining& how, double& changed) {
  for (std::size_t i = begin + 1; i < end; ++i)
    if (!can_join(windows[i - 1], windows[i], how.widest_gap)) return std::nullopt;
  const auto one = enclosing(windows[begin], windows[end - 1]);
  if (!one) return one;
  double apart = 0, least = std::numeric_limits<double>::infinity();
  for (std::size_t i = begin; i < end; ++i) {
    const Window w = windows[i];
    apart = std::max(apart, largest_difference(w, *one));
    least = std::min(least, w.least());
    if (!(apart <= how.tolerance * least - how.error)) return std::nullopt;
  }
  changed = std::max(changed, apart);
  return one;
}

double merge_windows(WindowBlock& all, double length, double tolerance, double error) {
  const std::size_t n = all.size();
  if (n < fewest) return 0;
  const Joining how{narrow_share * length, tolerance, error};
  double changed = 0;
  std::size_t kept = 0, seen = 0;
  std::uint64_t pairs = 0;  // bits of the 64 windows before `seen`
  for (std::size_t begin = 0; begin < n;) {
    while (seen <= begin && seen + 1 < n) {
      pairs = window_kernels().pairs(all, seen, how);
      seen += 64;
    }
    const bool joins = begin + 1 < n && (pairs >> (begin % 64) & 1) != 0;
    Window best = all[begin];
    std::size_t count = 1;
    if (joins) {
      std::size_t run = begin + 2;
      while (run < n && can_join(all[run - 1], all[run], how.widest_gap)) ++run;
      for (std::size_t more = 1; begin + count < run; more *= 2) {
        const std::size_t tried = std::min(count + more, run - begin);
        const auto one = one_of(all, begin, begin + tried, how, changed);
        if (!one) break;
        best = *one;
        count = tried;
      }
    }
    if (count > 1 || kept < begin) all.set(kept, best);
    ++kept;
    begin += count;
  }
  all.resize(kept);
  return changed;
}

}  // namespace littoral
