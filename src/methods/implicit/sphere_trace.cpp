#include "methods/implicit/sphere_trace.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace littoral {

namespace {

/// Illinois: the root of f between a and b, whose values differ in sign, to `tolerance` in place or
/// in value.
template <class F>
double bracketed(const F& f, double a, double fa, double b, double fb, double tolerance) {
  int kept = 0;  // steps that moved a (less than 0) or b alone
  for (int i = 0; i < 60 && b - a > tolerance; ++i) {
    double t = (a * fb - b * fa) / (fb - fa);
    // Every third step halves: values on both sides of a jump would never narrow the bracket.
    if (i % 3 == 2 || !(t > a && t < b)) t = 0.5 * (a + b);
    const double ft = f(t);
    if (std::abs(ft) < tolerance) return t;
    if ((ft < 0) == (fa < 0)) {
      a = t;
      fa = ft;
      if (kept < 0) fb /= 2;
      kept = -1;
    } else {
      b = t;
      fb = ft;
      if (kept > 0) fa /= 2;
      kept = 1;
    }
  }
  return 0.5 * (a + b);
}

}  // namespace

TraceHit sphere_trace(const PointwiseDistance& field, const Vec3& origin, const Vec3& direction,
                      double from, double to, const TraceOptions& options) {
  const auto f = [&](double t) { return field.value(origin + t * direction) - options.level; };
  TraceHit hit;
  if (!(from < to)) return hit;
  double t = from, here = f(t);
  for (int step = 0; step < options.max_steps; ++step) {
    const double size = std::abs(here);
    if (size < options.tolerance && step > 0) {
      hit.found = true;
    } else {
      if (t >= to || !std::isfinite(here)) return hit;
      const double next = std::min(to, t + std::max(size / options.steepness, options.tolerance));
      const double there = f(next);
      if ((there < 0) == (here < 0)) {
        t = next;
        here = there;
        continue;
      }
      const double root = bracketed(f, t, here, next, there, 0.1 * options.tolerance);
      // Across a surface values change no faster than the field is steep, with room for error.
      hit.found = std::abs(f(root)) < 4 * options.tolerance;
      t = hit.found ? root : next;
      here = there;
    }
    if (!hit.found) continue;
    hit.t = t;
    hit.normal = field.at(origin + t * direction).gradient;
    const double length = hit.normal.norm();
    hit.normal = length > 0 ? Vec3(hit.normal / length) : Vec3(-direction);
    return hit;
  }
  return hit;
}

double trace_steepness(const PointwiseDistance& field, const Vec3& low, const Vec3& high,
                       double level) {
  constexpr int places = 1024;
  std::mt19937 random(1);
  const auto unit = [&random] { return static_cast<double>(random()) / 4294967296.0; };
  std::vector<double> slopes;
  for (int i = 0; i < places; ++i) {
    Vec3 x;
    for (int a = 0; a < 3; ++a) x[a] = low[a] + unit() * (high[a] - low[a]);
    for (int beside = 0; beside < 2; ++beside) {
      const DistanceSample sample = field.at(x);
      const double slope = sample.gradient.norm();
      if (std::isfinite(slope)) slopes.push_back(slope);
      x -= (sample.value - level) * (0.9 + 0.2 * unit()) * sample.gradient;
      if (!x.allFinite()) break;
    }
  }
  if (slopes.empty()) return 1;
  const auto at = slopes.begin() + slopes.size() * 99 / 100;
  std::nth_element(slopes.begin(), at, slopes.end());
  return std::clamp(1.05 * *at, 1.0, 2.0);
}

}  // namespace littoral
