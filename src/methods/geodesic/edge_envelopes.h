#pragma once
// The windows of every edge that are nearest somewhere on it.

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "methods/geodesic/polyhedral_window.h"

namespace littoral {

/// For every edge a list of windows from tail to head that do not overlap: the lower envelope of
/// all that was offered. Of two windows, from whichever triangles, only the nearer one at a point
/// of the edge can belong to a shortest path there; at a tie the older one stays, as a path that
/// swaps one for the other either coincides with it or bends at the edge and is not shortest.
class EdgeEnvelopes {
 public:
  static constexpr double slack_share = 1e-12;   // of the distance: nearer by less is a tie
  static constexpr double narrow_share = 1e-12;  // of the edge: narrower stretches are left out

  struct List {
    std::vector<Window> windows;
    double due = std::numeric_limits<double>::infinity();  // when the open ones are to go on
  };

  explicit EdgeEnvelopes(int n_edges) : lists_(n_edges) {}

  List& operator[](int edge) { return lists_[edge]; }
  const List& operator[](int edge) const { return lists_[edge]; }

  /// Takes what is nearest of the window on an edge of the given length; the least distance there,
  /// +inf if nothing is left of it.
  double insert(List& list, double length, const Window& w) {
    std::vector<Window>& all = list.windows;
    if (all.capacity() == 0 && !spare_.empty()) {
      all.swap(spare_.back());
      spare_.pop_back();
    }
    const auto beyond =
        std::partition_point(all.begin(), all.end(), [&](const Window& o) { return o.b1 <= w.b0; });
    if (beyond != all.end() && beyond->b0 < w.b1)
      return replace(all, compare(w, all, beyond - all.begin(), length), w, narrow_share * length);
    all.insert(beyond, w);
    ++n_taken_;
    ++n_held_;
    return w.least();
  }

  /// Hands over the windows of a list, from tail to head, that have not gone on and whose least
  /// distance is up to `now`; the least distance of the others.
  static double take_open(List& list, double now, std::vector<Window>& out) {
    double least = std::numeric_limits<double>::infinity();
    out.clear();
    for (Window& w : list.windows) {
      if (!w.open) continue;
      const double d = w.least();
      if (d > now) {
        least = std::min(least, d);
      } else {
        w.open = false;
        out.push_back(w);
      }
    }
    return least;
  }

  static double least_open(const List& list) {
    double least = std::numeric_limits<double>::infinity();
    for (const Window& w : list.windows)
      if (w.open) least = std::min(least, w.least());
    return least;
  }

  void forget(List& list) {
    n_held_ -= double(list.windows.size());
    list.windows.clear();
    spare_.emplace_back().swap(list.windows);
  }

  double n_taken() const { return n_taken_; }  // windows ever held
  double n_held() const { return n_held_; }

 private:
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

  struct Range {
    std::size_t first, last;  // windows of the list that overlap the new one, and the one beyond
  };

  /// Cuts the new window and the old ones it overlaps into pieces where one of them is nearest.
  Range compare(const Window& w, const std::vector<Window>& all, std::size_t first, double length) {
    pieces_.clear();
    double u = w.b0, wu = w.d0;
    std::size_t i = first;
    while (u < w.b1) {
      if (i == all.size() || all[i].b0 >= w.b1) {
        emit(-1, u, w.b1, wu, w.d1);
        break;
      }
      const Window& o = all[i];
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
    if (!w.parallel && !o.parallel) p = hyperbola(w, o, slack, low, high);
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

  /// Where |p - I| - |p - J| = c: squared twice, (4 c^2 - b^2) p^2 - 2 (4 c^2 I_x - (a + c^2) b) p
  /// + 4 c^2 |I|^2 - (a + c^2)^2 = 0 with a = |I|^2 - |J|^2, b = 2 (I_x - J_x).
  static double hyperbola(const Window& w, const Window& o, double slack, double low, double high) {
    const double c = o.behind - w.behind - slack, c4 = 4 * c * c;
    const double norm = w.x * w.x + w.y * w.y;
    const double a = norm - o.x * o.x - o.y * o.y + c * c, b = 2 * (w.x - o.x);
    const double square = c4 - b * b, half = c4 * w.x - a * b, rest = c4 * norm - a * a;
    const double root = std::sqrt(std::max(0.0, half * half - square * rest));
    const double q = half + (half < 0 ? -root : root);
    const double p = q / square;
    return p > low && p < high ? p : rest / q;
  }

  /// Puts the pieces in the place of the windows they were cut from.
  double replace(std::vector<Window>& all, Range range, const Window& w, double narrow) {
    double least = std::numeric_limits<double>::infinity();
    bool taken = false;
    for (const Piece& p : pieces_) taken |= p.old < 0 && p.b1 - p.b0 > narrow;
    if (!taken) return least;
    made_.clear();
    for (const Piece& p : pieces_) {
      if (!(p.b1 - p.b0 > narrow)) continue;
      Window& made = made_.emplace_back(p.old < 0 ? w : all[p.old]);
      made.b0 = p.b0;
      made.b1 = p.b1;
      made.d0 = p.d0;
      made.d1 = p.d1;
      if (p.old >= 0) continue;
      ++n_taken_;
      least = std::min(least, made.least());
    }
    const auto at = all.begin() + std::ptrdiff_t(range.first);
    const std::size_t before = range.last - range.first, kept = std::min(before, made_.size());
    n_held_ += double(made_.size()) - double(before);
    std::copy_n(made_.begin(), kept, at);
    if (made_.size() > before)
      all.insert(at + std::ptrdiff_t(kept), made_.begin() + std::ptrdiff_t(kept), made_.end());
    else
      all.erase(at + std::ptrdiff_t(kept), at + std::ptrdiff_t(before));
    return least;
  }

  std::vector<List> lists_;                 // edges
  std::vector<std::vector<Window>> spare_;  // empty, with room
  std::vector<Piece> pieces_;               // of the insertion under way
  std::vector<Window> made_;
  double n_taken_ = 0, n_held_ = 0;
};

}  // namespace littoral
