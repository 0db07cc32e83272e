#pragma once
// The windows of every edge that are nearest somewhere on it.

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "base/index.h"
#include "methods/geodesic/window_kernels.h"
#include "methods/geodesic/window_memory.h"

namespace littoral {

/// The windows of an edge.
struct alignas(32) WindowList {
  WindowBlock windows;      // from tail to head, do not overlap
  double error = 0;         // of distances: by how much merged windows may misstate them
  bool none_open = false;   // all have gone on, whatever they say themselves
  bool waits = false;       // the open ones, to go on
  bool is_watched = false;  // until the front has passed
};

/// For every edge a list of windows from tail to head that do not overlap: the lower envelope of
/// all that was offered. Of two windows, from whichever triangles, only the nearer one at a point
/// of the edge can belong to a shortest path there; at a tie the older one stays, as a path that
/// swaps one for the other either coincides with it or bends at the edge and is not shortest. One
/// of these for every thread that adds to lists.
class EdgeEnvelopes {
 public:
  explicit EdgeEnvelopes(WindowMemory& memory) : spare(memory) {}

  /// Takes what is nearest of the window on an edge of the given length; the least distance there,
  /// +inf if nothing is left of it.
  double insert(WindowList& list, double length, const Window& w) {
    close(list);
    const std::size_t before = list.windows.size();
    const double least = insert(list.windows, length, w);
    n_held_ += double(list.windows.size()) - double(before);
    return least;
  }

  /// Several windows for one list, in order from tail to head but for few: the last one of the
  /// batch has just been added, and what is nearest stays. False if it is gone, or is no longer the
  /// last.
  bool settle(WindowBlock& batch, double length) {
    const std::size_t n = batch.size();
    if (n == 1 || batch.column(WindowBlock::b1)[n - 2] <= batch.column(WindowBlock::b0)[n - 1])
      return true;
    Window o = batch[n - 2], w = batch[n - 1];
    const Fit fit = divide_neighbours(o, w, length);
    if (fit == Fit::both) {
      batch.set(n - 2, o);
      batch.set(n - 1, w);
      return true;
    }
    batch.pop_back();
    const double taken = n_taken_;
    if (fit == Fit::otherwise) insert(batch, length, w);
    n_taken_ = taken;
    return false;
  }

  /// Puts a batch into a list; the least distance of what is taken, +inf if nothing is, anything
  /// for a list that is to go on already.
  double take(WindowList& list, WindowBlock&& batch, double length) {
    double least = infinity;
    if (batch.empty()) return least;
    close(list);
    WindowBlock& all = list.windows;
    const std::size_t before = all.size(), n = batch.size();
    if (before == 0) {
      n_taken_ += double(n);
      n_held_ += double(n);
      spare.give(std::move(all));
      all = std::move(batch);
      return list.waits ? 0 : window_kernels().least(all, 0, n);
    }
    const double *b0 = batch.column(WindowBlock::b0), *b1 = batch.column(WindowBlock::b1);
    const double start = all.column(WindowBlock::b0)[0],
                 end = all.column(WindowBlock::b1)[before - 1];
    std::size_t first = 0, last = n;
    while (first != last && b1[first] <= start) ++first;
    while (last != first && b0[last - 1] >= end) --last;
    for (std::size_t i = first; i < last; ++i)
      least = std::min(least, insert(all, length, batch[i]));
    if (list.waits)
      least = 0;
    else
      least = std::min(
          {least, window_kernels().least(batch, 0, first), window_kernels().least(batch, last, n)});
    const std::size_t outside = first + (n - last);
    n_taken_ += double(outside);
    if (outside > 0) {
      WindowBlock joined = spare.take(all.size() + outside);
      joined.append(batch, 0, first);
      joined.append(all, 0, all.size());
      joined.append(batch, last, n);
      spare.give(std::exchange(all, std::move(joined)));
    }
    spare.give(std::move(batch));
    rejoin(all, start, length);
    rejoin(all, end, length);
    n_held_ += double(all.size()) - double(before);
    return least;
  }

  /// Hands over the windows of a list, from tail to head, that have not gone on.
  template <class Take>
  static void take_open(WindowList& list, const Take& take) {
    if (list.none_open) return;
    for (std::size_t i = 0; i < list.windows.size(); ++i) {
      Window w = list.windows[i];
      if (!w.open) continue;
      take(w);
      list.windows.set(i, w);
    }
    list.none_open = true;
  }

  static double least_open(const WindowList& list) {
    double least = infinity;
    if (list.none_open) return least;
    for (std::size_t i = 0; i < list.windows.size(); ++i) {
      const Window w = list.windows[i];
      if (w.open) least = std::min(least, w.least());
    }
    return least;
  }

  void forget(WindowList& list) {
    n_held_ -= double(list.windows.size());
    spare.give(std::move(list.windows));
    list.none_open = false;
  }

  double n_taken() const { return n_taken_; }  // windows ever held
  double n_held() const { return n_held_; }

  SpareBlocks spare;

 private:
  /// Neighbours near p whose rays are the same, to rounding, become one again: on a flat place the
  /// rays that a vertex divides come together behind it.
  static void rejoin(WindowBlock& all, double p, double length) {
    const std::size_t there = beyond(all, WindowBlock::b1, p, false);
    std::size_t i = std::max(there, std::size_t(1)) - 1;
    for (int pair = 0; pair < 2 && i + 1 < all.size(); ++pair) {
      const double* behind = all.column(WindowBlock::behind) + i;
      // Nearly always apart by what lies behind them already.
      if (std::abs(behind[0] - behind[1]) > same_share * all.column(WindowBlock::d1)[i]) {
        ++i;
        continue;
      }
      const Window w = all[i], next = all[i + 1];
      if (next.b0 - w.b1 > narrow_share * length || !w.same_rays(next)) {
        ++i;
        continue;
      }
      Window joined = next.b1 - next.b0 > w.b1 - w.b0 ? next : w;
      joined.b0 = w.b0;
      joined.b1 = next.b1;
      joined.depth = std::max(w.depth, next.depth);
      joined.measure_ends();
      all.set(i, joined);
      all.shift(i + 1, -1);
    }
  }

  /// The first window whose number in a column is not less than p (`or_more`: more than p).
  static std::size_t beyond(const WindowBlock& all, WindowBlock::Column c, double p, bool or_more) {
    const double *first = all.column(c), *last = first + all.size();
    return std::size_t(
        (or_more ? std::upper_bound(first, last, p) : std::lower_bound(first, last, p)) - first);
  }

  /// Lets every window say for itself that it has gone on.
  static void close(WindowList& list) {
    if (!list.none_open) return;
    std::int64_t* tags = list.windows.tags();
    for (std::size_t i = 0; i < list.windows.size(); ++i) tags[i] &= ~WindowTag::open;
    list.none_open = false;
  }

  double insert(WindowBlock& all, double length, const Window& w) {
    const std::size_t n = all.size();
    std::size_t at = n;
    if (n > 0 && all.column(WindowBlock::b1)[n - 1] > w.b0) {
      at = beyond(all, WindowBlock::b1, w.b0, true);
      if (at < n && all.column(WindowBlock::b0)[at] < w.b1)
        return replace(all, compare(w, all, at, length), w, narrow_share * length);
    }
    spare.insert(all, at, 1);
    all.set(at, w);
    ++n_taken_;
    return w.least();
  }

  struct Piece {
    int old;  // which window of the list; -1: the new one
    double b0, b1, d0, d1;
  };

  [[gnu::always_inline]] void emit(int old, double b0, double b1, double d0, double d1) {
    if (!pieces_.empty() && pieces_.back().old == old) {
      pieces_.back().b1 = b1;
      pieces_.back().d1 = d1;
    } else {
      pieces_.push_back({old, b0, b1, d0, d1});
    }
  }

  enum class Fit { both, first, otherwise };

  /// The commonest case: the second window, new, starts within the first and ends beyond it. Cuts
  /// both where they meet; `first` if the second is of no use, `otherwise`, and nothing done, if
  /// there is more to it.
  Fit divide_neighbours(Window& o, Window& w, double length) {
    if (!(o.b0 <= w.b0 && o.b1 <= w.b1)) return Fit::otherwise;
    const double narrow = narrow_share * length;
    const Both u = {w.b0, w.d0, o.at(w.b0)}, v = {o.b1, w.at(o.b1), o.d1};
    const double slack = slack_share * (u.o + length);
    const bool at_u = u.w + slack < u.o, at_v = v.w + slack < v.o;
    if (at_u) return Fit::otherwise;
    Both m = v;
    if (at_v) {
      m = meeting(w, o, u, v, slack, false);
      if (!(m.p - o.b0 > narrow)) return Fit::otherwise;
    } else {
      const double p = parallel_at(w, o);
      if (p > u.p && p < v.p && w.at(p) + slack < o.at(p)) return Fit::otherwise;
    }
    if (!(w.b1 - m.p > narrow)) return Fit::first;
    o.b1 = m.p;
    o.d1 = m.o;
    w.b0 = m.p;
    w.d0 = m.w;
    return Fit::both;
  }

  struct Range {
    std::size_t first, last;  // windows of the list that overlap the new one, and the one beyond
  };

  /// Cuts the new window and the old ones it overlaps into pieces where one of them is nearest.
  Range compare(const Window& w, const WindowBlock& all, std::size_t first, double length) {
    pieces_.clear();
    double u = w.b0, wu = w.d0;
    std::size_t i = first;
    while (u < w.b1) {
      if (i == all.size() || all.column(WindowBlock::b0)[i] >= w.b1) {
        emit(-1, u, w.b1, wu, w.d1);
        break;
      }
      const Window o = all[i];
      const int old = static_cast<int>(i++);
      double ou = o.d0;
      if (o.b0 > u) {
        const double d = w.at(o.b0);
        emit(-1, u, o.b0, wu, d);
        u = o.b0;
        wu = d;
      } else if (o.b0 < u) {
        ou = o.at(u);
        emit(old, o.b0, u, o.d0, ou);
      }
      const double v = std::min(o.b1, w.b1);
      const double wv = v == w.b1 ? w.d1 : w.at(v), ov = v == o.b1 ? o.d1 : o.at(v);
      divide(w, o, old, {u, wu, ou}, {v, wv, ov}, length);
      if (v < o.b1) emit(old, v, o.b1, ov, o.d1);
      u = v;
      wu = wv;
    }
    return {first, i};
  }

  /// A point of the edge and both windows' distances there.
  struct Both {
    double p, w, o;
  };

  void divide(const Window& w, const Window& o, int old, Both u, Both v, double length) {
    const double slack = slack_share * (u.o + length);
    const bool at_u = u.w + slack < u.o, at_v = v.w + slack < v.o;
    if (at_u != at_v) return cross(w, o, old, u, v, slack, at_u);
    // The difference of the distances is monotone but for where the rays are parallel.
    const double p = parallel_at(w, o);
    if (p > u.p && p < v.p) {
      const Both m = {p, w.at(p), o.at(p)};
      if ((m.w + slack < m.o) != at_u) {
        cross(w, o, old, u, m, slack, at_u);
        return cross(w, o, old, m, v, slack, !at_u);
      }
    }
    if (at_u)
      emit(-1, u.p, v.p, u.w, v.w);
    else
      emit(old, u.p, v.p, u.o, v.o);
  }

  /// The two are equally near between u and v; is the new one nearer at u?
  void cross(const Window& w, const Window& o, int old, const Both& u, const Both& v, double slack,
             bool new_first) {
    const Both m = meeting(w, o, u, v, slack, new_first);
    if (new_first) {
      emit(-1, u.p, m.p, u.w, m.w);
      emit(old, m.p, v.p, m.o, v.o);
    } else {
      emit(old, u.p, m.p, u.o, m.o);
      emit(-1, m.p, v.p, m.w, v.w);
    }
  }

  static double parallel_at(const Window& w, const Window& o) {
    if (w.parallel && o.parallel) return std::numeric_limits<double>::quiet_NaN();
    if (w.parallel) return o.x - o.y * w.x / w.y;
    if (o.parallel) return w.x - w.y * o.x / o.y;
    return (w.x * o.y - o.x * w.y) / (o.y - w.y);
  }

  /// Newton's method in a bracket, from the crossing of the hyperbola of two points with the edge.
  static Both meeting(const Window& w, const Window& o, const Both& u, const Both& v, double slack,
                      bool new_first) {
    double low = u.p, high = v.p;
    const double narrow = 1e-15 * (high - low);
    const double fu = u.w + slack - u.o, fv = v.w + slack - v.o;
    double p = std::numeric_limits<double>::quiet_NaN();
    if (!w.parallel && !o.parallel) {
      p = w.behind == o.behind ? bisector(w, o) : hyperbola(w, o, low, high);
      if (p > low && p < high) {
        const Both m = {p, w.at(p), o.at(p)};
        if (std::abs(m.w - m.o) <= slack) return m;
      }
    }
    if (!(p > low && p < high)) p = low - fu * (high - low) / (fv - fu);
    Both m = new_first ? u : v;
    for (int i = 0; i < 60; ++i) {
      if (!(p > low && p < high)) p = 0.5 * (low + high);
      m = {p, w.at(p), o.at(p)};
      const double f = m.w + slack - m.o;
      if (std::abs(f) <= 0.05 * slack || high - low <= narrow) break;
      ((f < 0) == new_first ? low : high) = p;
      p -= f / (w.slope(p) - o.slope(p));
    }
    return m;
  }

  static double bisector(const Window& w, const Window& o) {
    return 0.5 * (w.x + o.x + (w.y - o.y) * (w.y + o.y) / (w.x - o.x));
  }

  /// Where |p - I| - |p - J| = c: squared twice, (4 c^2 - b^2) p^2 - 2 (4 c^2 I_x - (a + c^2) b) p
  /// + 4 c^2 |I|^2 - (a + c^2)^2 = 0 with a = |I|^2 - |J|^2, b = 2 (I_x - J_x).
  static double hyperbola(const Window& w, const Window& o, double low, double high) {
    const double c = o.behind - w.behind, c4 = 4 * c * c;
    const double norm = w.x * w.x + w.y * w.y;
    const double a = norm - o.x * o.x - o.y * o.y + c * c, b = 2 * (w.x - o.x);
    const double square = c4 - b * b, half = c4 * w.x - a * b, rest = c4 * norm - a * a;
    const double root = std::sqrt(std::max(0.0, half * half - square * rest));
    const double q = half + (half < 0 ? -root : root);
    const double p = q / square;
    return p > low && p < high ? p : rest / q;
  }

  /// Puts the pieces in the place of the windows they were cut from.
  double replace(WindowBlock& all, Range range, const Window& w, double narrow) {
    double least = infinity;
    bool taken = false;
    for (const Piece& p : pieces_) taken |= p.old < 0 && p.b1 - p.b0 > narrow;
    if (!taken) return least;
    made_.clear();
    for (const Piece& p : pieces_) {
      if (!(p.b1 - p.b0 > narrow)) continue;
      Window& made = made_.emplace_back(p.old < 0 ? w : all[std::size_t(p.old)]);
      made.b0 = p.b0;
      made.b1 = p.b1;
      made.d0 = p.d0;
      made.d1 = p.d1;
      if (p.old >= 0) continue;
      ++n_taken_;
      least = std::min(least, made.least());
    }
    const std::ptrdiff_t more =
        std::ptrdiff_t(made_.size()) - std::ptrdiff_t(range.last - range.first);
    if (more > 0)
      spare.insert(all, range.last, std::size_t(more));
    else if (more < 0)
      all.shift(std::size_t(std::ptrdiff_t(range.last) + more), more);
    for (std::size_t i = 0; i < made_.size(); ++i) all.set(range.first + i, made_[i]);
    return least;
  }

  std::vector<Piece> pieces_;  // of the insertion under way
  std::vector<Window> made_;
  double n_taken_ = 0, n_held_ = 0;
};

}  // namespace littoral
