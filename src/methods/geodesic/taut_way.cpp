#include "methods/geodesic/taut_way.h"

#include <algorithm>

namespace littoral {

namespace {

constexpr double enough = 1 - 1e-13;  // a step that gains less is the last
constexpr double one = 1e-10;         // of the length: turns so close are one
constexpr int newton_steps = 40;
constexpr int halvings = 12;

class TautWay {
 public:
  TautWay(const MatX3& points, const std::function<Vec3(const Vec3&)>& start, const Vec3& end,
          std::vector<EdgeTurn>& turns)
      : points_(points), start_(start), end_(end), turns_(turns) {}

  /// Newton's method with bounds: the Hessian is tridiagonal.
  void solve() {
    place();
    std::vector<double> gradient(n()), diagonal(n()), next(n()), step(n());
    for (int k = 0; k < newton_steps; ++k) {
      for (std::size_t i = 0; i < n(); ++i) {
        const Vec3 d = along(i);
        gradient[i] = d.dot(direction_[i] - direction_[i + 1]);
        diagonal[i] = curvature(i, d, d) + curvature(i + 1, d, d);
        next[i] = i + 1 < n() ? -curvature(i + 1, d, along(i + 1)) : 0;
      }
      for (std::size_t i = 0; i < n(); ++i)
        if (!(diagonal[i] > 0) || (turns_[i].t <= 0 && gradient[i] > 0) ||
            (turns_[i].t >= 1 && gradient[i] < 0)) {
          gradient[i] = next[i] = 0;
          diagonal[i] = 1;
          if (i > 0) next[i - 1] = 0;
        }
      // Gauss: forward and back.
      for (std::size_t i = 0; i < n(); ++i) {
        diagonal[i] *= 1 + 1e-12;
        step[i] = -gradient[i];
        if (i == 0) continue;
        const double factor = next[i - 1] / diagonal[i - 1];
        diagonal[i] = std::max(diagonal[i] - factor * next[i - 1], 1e-12 * diagonal[i]);
        step[i] -= factor * step[i - 1];
      }
      for (std::size_t i = n(); i-- > 0;)
        step[i] = (step[i] - (i + 1 < n() ? next[i] * step[i + 1] : 0)) / diagonal[i];
      if (!try_step(step)) return;
    }
  }

 private:
  std::size_t n() const { return turns_.size(); }
  Vec3 along(std::size_t i) const {
    return points_.row(turns_[i].b).transpose() - points_.row(turns_[i].a).transpose();
  }

  /// Directions and lengths of the parts; part i leads to turn i, the last to the end.
  void place() {
    part_.resize(n() + 1);
    direction_.resize(n() + 1);
    length_ = 0;
    Vec3 last;
    for (std::size_t i = 0; i <= n(); ++i) {
      const Vec3 at = i < n() ? place_of(points_, turns_[i]) : end_;
      if (i == 0) last = start_(at);
      const Vec3 d = at - last;
      part_[i] = d.norm();
      direction_[i] = part_[i] > 0 ? Vec3(d / part_[i]) : Vec3::Zero();
      length_ += part_[i];
      last = at;
    }
  }

  bool try_step(const std::vector<double>& step) {
    const double before = length_;
    const std::vector<EdgeTurn> old = turns_;
    double share = 1;
    for (int k = 0; k < halvings; ++k, share /= 2) {
      for (std::size_t i = 0; i < n(); ++i)
        turns_[i].t = std::clamp(old[i].t + share * step[i], 0.0, 1.0);
      place();
      if (length_ < enough * before) return true;
    }
    turns_ = old;
    place();
    return false;
  }

  /// d . (second derivative of the length of part i) e.
  double curvature(std::size_t i, const Vec3& d, const Vec3& e) const {
    const double length = std::max(part_[i], one * length_);
    return (d.dot(e) - d.dot(direction_[i]) * e.dot(direction_[i])) / length;
  }

  const MatX3& points_;
  const std::function<Vec3(const Vec3&)>& start_;
  const Vec3 end_;
  std::vector<EdgeTurn>& turns_;
  std::vector<Vec3> direction_;
  std::vector<double> part_;
  double length_ = 0;
};

}  // namespace

Vec3 place_of(const MatX3& points, const EdgeTurn& turn) {
  const Vec3 a = points.row(turn.a), b = points.row(turn.b);
  return a + turn.t * (b - a);
}

void make_taut(const MatX3& points, const std::function<Vec3(const Vec3&)>& start, const Vec3& end,
               std::vector<EdgeTurn>& turns) {
  TautWay(points, start, end, turns).solve();
}

}  // namespace littoral
