#pragma once
// The windows of every edge that are nearest somewhere on it.

#include <limits>
#include <utility>
#include <vector>

#include "methods/geodesic/polyhedral_window.h"

namespace littoral {

/// For every edge a list of windows from tail to head that do not overlap: the lower envelope of
/// all that was offered. Of two windows, from whichever triangles, only the nearer one at a point of
/// the edge can belong to a shortest path there; at a tie the older one stays, as a path that swaps
/// one for the other either coincides with it or bends at the edge and is not shortest.
class EdgeEnvelopes {
 public:
  static constexpr double slack_share = 1e-12;   // of the distance: nearer by less is a tie
  static constexpr double narrow_share = 1e-12;  // of the edge: narrower stretches are left out

  explicit EdgeEnvelopes(int n_edges) : head_(n_edges, -1) {}

  /// Takes what is nearest of the window on an edge of the given length; the least distance there,
  /// +inf if nothing is left of it.
  double insert(int edge, double length, const Window& w) {
    int before = -1, n = head_[edge];
    while (n >= 0 && pool_[n].b1 <= w.b0) {
      before = n;
      n = pool_[n].next;
    }
    if (n < 0 || pool_[n].b0 >= w.b1) {
      const int id = add(w, n);
      link(before, edge) = id;
      ++n_taken_;
      return w.least();
    }
    n = compare(w, n, length);
    return replace(edge, before, n, w, narrow_share * length);
  }

  /// Hands over the windows of an edge that have not gone on, from tail to head.
  void take_open(int edge, std::vector<Window>& out) {
    out.clear();
    for (int n = head_[edge]; n >= 0; n = pool_[n].next)
      if (std::exchange(pool_[n].open, false)) out.push_back(pool_[n]);
  }

  void forget(int edge) {
    for (int n = std::exchange(head_[edge], -1); n >= 0; n = pool_[n].next) free_.push_back(n);
  }

  double n_taken() const { return n_taken_; }               // windows ever held
  std::size_t n_held() const { return pool_.size() - free_.size(); }
  bool is_full() const { return free_.empty() && pool_.size() == pool_.capacity(); }
  void reserve(std::size_t n) { pool_.reserve(n); }

 private:
  struct Piece {
    int old;  // row of olds_; -1: of the new window
    double b0, b1, d0, d1;
  };

  int& link(int before, int edge) { return before < 0 ? head_[edge] : pool_[before].next; }

  int add(const Window& w, int next) {
    int id = static_cast<int>(pool_.size());
    if (free_.empty()) {
      pool_.push_back(w);
    } else {
      id = free_.back();
      free_.pop_back();
      pool_[id] = w;
    }
    pool_[id].next = next;
    return id;
  }

  void emit(int old, double b0, double b1, double d0, double d1) {
    if (!pieces_.empty() && pieces_.back().old == old) {
      pieces_.back().b1 = b1;
      pieces_.back().d1 = d1;
    } else {
      pieces_.push_back({old, b0, b1, d0, d1});
    }
  }

  /// Cuts the new window and the old ones it overlaps, from window n on, into pieces where one of
  /// them is nearest. The first old window beyond.
  int compare(const Window& w, int n, double length) {
    pieces_.clear();
    olds_.clear();
    double u = w.b0, wu = w.d0;
    while (u < w.b1) {
      if (n < 0 || pool_[n].b0 >= w.b1) {
        emit(-1, u, w.b1, wu, w.d1);
        break;
      }
      const Window& o = pool_[n];
      const int old = static_cast<int>(olds_.size());
      olds_.push_back(n);
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
      n = o.next;
    }
    return n;
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

  /// Where |p - I| - |p - J| = c: squared twice, (4 c^2 - b^2) p^2 - 2 (4 c^2 I_x - (a + c^2) b) p +
  /// 4 c^2 |I|^2 - (a + c^2)^2 = 0 with a = |I|^2 - |J|^2, b = 2 (I_x - J_x).
  static double hyperbola(const Window& w, const Window& o, double slack, double low,
                          double high) {
    const double c = o.behind - w.behind - slack, c4 = 4 * c * c;
    const double norm = w.x * w.x + w.y * w.y;
    const double a = norm - o.x * o.x - o.y * o.y + c * c, b = 2 * (w.x - o.x);
    const double square = c4 - b * b, half = c4 * w.x - a * b, rest = c4 * norm - a * a;
    const double root = std::sqrt(std::max(0.0, half * half - square * rest));
    const double q = half + (half < 0 ? -root : root);
    const double p = q / square;
    return p > low && p < high ? p : rest / q;
  }

  /// Puts the pieces in the place of the old windows after `before` and up to `rest`.
  double replace(int edge, int before, int rest, const Window& w, double narrow) {
    double least = std::numeric_limits<double>::infinity();
    bool taken = false;
    for (const Piece& p : pieces_) taken |= p.old < 0 && p.b1 - p.b0 > narrow;
    if (!taken) return least;
    std::size_t done = 0;  // of the old windows
    bool used = false;     // the next old window has its first piece
    const auto finish = [&](std::size_t until) {
      while (done < until) {
        if (!std::exchange(used, false)) free_.push_back(olds_[done]);
        ++done;
      }
    };
    int last = before;
    for (const Piece& p : pieces_) {
      if (!(p.b1 - p.b0 > narrow)) continue;
      int id;
      if (p.old < 0) {
        id = add(w, -1);
        ++n_taken_;
      } else {
        finish(p.old);
        id = olds_[p.old];
        if (std::exchange(used, true)) {
          const Window copy = pool_[id];
          id = add(copy, -1);
        }
      }
      Window& at = pool_[id];
      at.b0 = p.b0;
      at.b1 = p.b1;
      at.d0 = p.d0;
      at.d1 = p.d1;
      if (p.old < 0) least = std::min(least, at.least());
      link(last, edge) = id;
      last = id;
    }
    finish(olds_.size());
    link(last, edge) = rest;
    return least;
  }

  std::vector<int> head_;     // edges; its first window
  std::vector<Window> pool_;
  std::vector<int> free_;
  std::vector<Piece> pieces_;  // of the insertion under way
  std::vector<int> olds_;
  double n_taken_ = 0;
};

}  // namespace littoral
