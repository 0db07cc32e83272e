#pragma once
// Windows: straight rays of shortest paths through one stretch of an edge, unfolded into the plane.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace littoral {

inline constexpr double slack_share = 1e-12;   // of the distance: nearer by less is a tie
inline constexpr double same_share = 2e-15;    // of the distance: images this near are one
inline constexpr double narrow_share = 1e-12;  // of the edge: narrower stretches are left out

/// Rays that cross an edge within [b0, b1]. Coordinates: the edge on the real axis from its tail at
/// 0 to its length, and the rays going up, whichever triangle they came through: all triangles at
/// the edge but that one, laid above it, see them so. Rays come straight from the image of a point
/// below the axis, or are parallel (from a straight piece of a curve). A line of the cache each.
struct Window {
  static constexpr int no_page = 65535, deep = 255;

  double b0 = 0, b1 = 0;  // the stretch
  double d0 = 0, d1 = 0;  // distance at its ends
  double x = 0, y = 0;    // image of the point, y <= 0; parallel: the rays' unit direction, y >= 0
  double behind = 0;      // distance already behind: at the image; parallel: at the tail
  int source = -1;        // the number of what the path starts from
  std::uint16_t page = no_page;  // of the edge: the triangle that the rays came through, if known
  std::uint8_t depth = 0;        // triangles crossed since the source or the last bend
  std::uint8_t parallel : 1 = false;  // rays of a segment
  std::uint8_t open : 1 = true;       // has not gone on yet

  /// Distance along the rays to a point of the plane.
  double at(double px, double py = 0) const {
    if (parallel) return behind + x * px + y * py;
    const double u = px - x, v = py - y;
    return behind + std::sqrt(u * u + v * v);
  }
  /// How fast the distance grows along the edge.
  double slope(double px) const {
    return parallel ? x : (px - x) / std::sqrt((px - x) * (px - x) + y * y);
  }
  double direction_x(double px) const { return parallel ? x : px - x; }
  double direction_y() const { return parallel ? y : -y; }

  void measure_ends() {
    d0 = at(b0);
    d1 = at(b1);
  }

  /// Least distance over the window.
  double least() const {
    if (parallel || x <= b0 || x >= b1) return std::min(d0, d1);
    return behind - y;
  }

  /// Whether these and the rays of the next window on the edge are the same, to rounding.
  bool same_rays(const Window& next) const {
    const double image = same_share * (parallel ? 1 : std::abs(x) + std::abs(y));
    return source == next.source && page == next.page && parallel == next.parallel && open &&
           next.open && std::abs(behind - next.behind) <= same_share * d1 &&
           std::abs(x - next.x) <= image && std::abs(y - next.y) <= image;
  }

  /// Cuts off what is reached sooner along the edge from its tail, at distance `tail`: at every p
  /// where tail + p < at(p). at(p) - p never grows with p, so a stretch [b0, p*) goes.
  void trim_start(double tail, double slack) {
    if (d0 <= tail + b0 + slack) return;
    b0 = d1 > tail + b1 + slack ? b1 : std::clamp(meeting(x, behind, tail, b0), b0, b1);
    d0 = at(b0);
  }
  /// The same from the head of the edge, which is `length` long.
  void trim_end(double head, double length, double slack) {
    if (d1 <= head + (length - b1) + slack) return;
    if (d0 > head + (length - b0) + slack) {
      b1 = b0;
    } else {
      const double p =
          parallel ? meeting(-x, at(length), head, 0) : meeting(length - x, behind, head, 0);
      b1 = std::clamp(length - p, b0, b1);
    }
    d1 = at(b1);
  }

  /// Turns to coordinates along the edge from its head.
  void turn(double length) {
    if (parallel) behind = at(length);
    x = parallel ? -x : length - x;
    b0 = length - std::exchange(b1, length - b0);
    std::swap(d0, d1);
  }

 private:
  /// p where the distance of an image at height y is `end` + p; `otherwise` where rounding leaves
  /// none.
  double meeting(double image_x, double image_behind, double end, double otherwise) const {
    const double c = end - image_behind;
    const double p =
        parallel ? -c / (1 - image_x) : (image_x * image_x + y * y - c * c) / (2 * (c + image_x));
    return std::isfinite(p) ? p : otherwise;
  }
};

static_assert(sizeof(Window) == 64);

/// Distances at the ends of an edge, +inf where nothing is known.
struct EdgeEnds {
  EdgeEnds(double at_tail, double at_head, double edge_length)
      : tail(at_tail),
        head(at_head),
        length(edge_length),
        tail_slack(slack_share * (tail + length)),
        head_slack(slack_share * (head + length)) {}

  double tail, head, length;
  double tail_slack, head_slack;  // nearer by less is a tie

  double narrow() const { return narrow_share * length; }
  /// Whether the ends reach nothing of a window sooner.
  bool leave_be(const Window& w) const {
    return w.d0 <= tail + w.b0 + tail_slack && w.d1 <= head + (length - w.b1) + head_slack;
  }
  /// Cuts off what the ends reach sooner; false if nothing is left.
  bool trim(Window& w) const {
    if (!leave_be(w)) cut(w);  // seldom
    return w.b1 - w.b0 > narrow();
  }

 private:
  [[gnu::noinline]] void cut(Window& w) const {
    w.trim_start(tail, tail_slack);
    if (w.b1 > w.b0) w.trim_end(head, length, head_slack);
  }
};

}  // namespace littoral
