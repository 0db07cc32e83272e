// Lanes are places. CMakeLists lets the compiler assume for this file that square roots set no
// error number, comparisons do not trap, and numbers are finite, so that the larger of two is one
// instruction.

#include "methods/heat/yukawa_sum.h"

#include <array>
#include <cmath>
#include <cstdint>

#include "base/kernel_choice.h"
#include "base/vector_lanes.h"

namespace littoral {

namespace {

constexpr int lanes = YukawaGroup::lanes;
using Floats = Wide<lanes, float>::Lanes;
using Whole = Wide<lanes, float>::Bits;

[[gnu::always_inline]] inline bool all(const Whole& mask) { return !any<Whole>(~mask); }

[[gnu::always_inline]] inline void root(const Floats& x, Floats& out) {
  alignas(sizeof x) float from[lanes], to[lanes];
  store(from, x);
  for (int l = 0; l < lanes; ++l) to[l] = std::sqrt(from[l]);
  load(out, to);
}

/// 2^x to 3e-6, x taken to at least -90.
[[gnu::always_inline]] inline void power_of_two(const Floats& x, Floats& out) {
  const Floats z = x > -90.0f ? x : Floats{} - 90.0f;
  // Adding this rounds to a whole number, found in the lowest bits; the others leave on the left.
  constexpr float whole = 12582912.0f;
  const Floats rounded = z + whole;
  const Floats f = z - (rounded - whole);  // in [-1/2, 1/2]
  const Floats p =
      0.99999926f + f * (0.69312181f + f * (0.24024745f + f * (0.05591786f + f * 0.0095701f)));
  Whole n, bits;
  __builtin_memcpy(&n, &rounded, sizeof n);
  __builtin_memcpy(&bits, &p, sizeof bits);
  bits += n << 23;
  __builtin_memcpy(&out, &bits, sizeof out);
}

/// Squared distance to a box.
[[gnu::always_inline]] inline void gap(const YukawaBox& c, const Floats* q, Floats& squared) {
  squared = Floats{};
  for (int a = 0; a < 3; ++a) {
    const Floats below = c.low[a] - q[a], above = q[a] - c.high[a];
    const Floats out = below > above ? below : above;
    const Floats positive = out > 0.0f ? out : Floats{};
    squared += positive * positive;
  }
}

/// Squared distance to the nearest sample, and `least` more. Children whose boxes' middles are near
/// that of the places come first.
[[gnu::always_inline]] inline void find_nearest(const YukawaTree& tree, const Floats* q,
                                                float least, Floats& best) {
  float middle[3];
  for (int a = 0; a < 3; ++a) {
    float sum = 0;
    for (int l = 0; l < lanes; ++l) sum += q[a][l];
    middle[a] = sum * (2.0f / lanes);
  }
  const auto far = [&middle](const YukawaBox& c) {
    const float x = c.low[0] + c.high[0] - middle[0], y = c.low[1] + c.high[1] - middle[1],
                z = c.low[2] + c.high[2] - middle[2];
    return x * x + y * y + z * z;
  };
  best = Floats{} + 1e37f;
  std::array<int, 128> stack;  // medians: a path is at most 32 clusters deep
  int top = 0;
  stack[top++] = 0;
  while (top > 0) {
    const YukawaBox& c = tree.boxes[stack[--top]];
    Floats box;
    gap(c, q, box);
    if (!any(box < best)) continue;
    if (c.child >= 0) {
      const int first = far(tree.boxes[c.child]) <= far(tree.boxes[c.child + 1]) ? 0 : 1;
      stack[top++] = c.child + 1 - first;
      stack[top++] = c.child + first;
      continue;
    }
    for (int i = c.begin; i < c.end; ++i) {
      const YukawaSample& s = tree.samples[i];
      const Floats x = q[0] - s.x, y = q[1] - s.y, z = q[2] - s.z;
      const Floats squared = x * x + y * y + z * z;
      best = squared < best ? squared : best;
    }
  }
  best += least;
}

/// A cluster seen from places: unit vectors from its centre, 1 / r and exp((d - r) / sqrt(t)).
struct Seen {
  Floats ux, uy, uz, inverse, kernel;
};

[[gnu::always_inline]] inline void see(const YukawaMoments& c, const YukawaScale& scale,
                                       const Floats* q, const Floats& nearest, Seen& seen) {
  const Floats x = q[0] - c.centre[0], y = q[1] - c.centre[1], z = q[2] - c.centre[2];
  Floats r;
  root(x * x + y * y + z * z + scale.least, r);
  seen.inverse = 1.0f / r;
  seen.ux = x * seen.inverse;
  seen.uy = y * seen.inverse;
  seen.uz = z * seen.inverse;
  power_of_two((nearest - r) * scale.decay, seen.kernel);
}

constexpr float most_first = 1, most_second = 0.5f;
constexpr float most_radius = 3;  // in sqrt(t), of groups whose middles speak for their places

/// Where moments up to the second order do. They leave out what is of third order in d / sqrt(t)
/// along the way to the place, and of second order in |d|^2 / (r sqrt(t)).
[[gnu::always_inline]] inline void is_good(const YukawaMoments& c, const YukawaScale& scale,
                                           const Seen& seen, Whole& good) {
  const Floats slope = scale.inverse + seen.inverse;  // of the logarithm of the kernel
  const Floats along = seen.ux * (c.spread[0] * seen.ux + 2.0f * c.spread[3] * seen.uy) +
                       seen.uy * (c.spread[1] * seen.uy + 2.0f * c.spread[5] * seen.uz) +
                       seen.uz * (c.spread[2] * seen.uz + 2.0f * c.spread[4] * seen.ux);
  const Floats first = along * slope * slope;  // square of the one small number; the other:
  const Floats second =
      (c.spread[0] + c.spread[1] + c.spread[2] - along) * seen.inverse * slope * 0.5f;
  const Floats second_squared = second * second;
  const Floats error = seen.kernel * seen.kernel *
                       (first * (first * first * 0.0625f + second_squared) +
                        second_squared * second_squared * 0.25f);
  good = (error <= scale.tolerance * scale.tolerance) & (first <= most_first) &
         (second <= most_second);
}

[[gnu::always_inline]] inline void add_cluster(const YukawaMoments& c, const YukawaScale& scale,
                                               const Seen& seen, Floats* n, Floats& total) {
  const Floats kernel = seen.kernel * seen.inverse;
  total += c.area * kernel;
  // Derivatives of the kernel over the kernel.
  const Floats slope = scale.inverse + seen.inverse;
  const Floats curved = scale.inverse * scale.inverse + 3.0f * seen.inverse * slope;
  const Floats level = 0.5f * slope * seen.inverse;
  const Floats gx = slope * seen.ux, gy = slope * seen.uy, gz = slope * seen.uz;
  const Floats cx = curved * seen.ux, cy = curved * seen.uy, cz = curved * seen.uz;
  const Floats hxx = 0.5f * cx * seen.ux - level, hyy = 0.5f * cy * seen.uy - level,
               hzz = 0.5f * cz * seen.uz - level;
  const Floats hxy = cx * seen.uy, hxz = cx * seen.uz, hyz = cy * seen.uz;
  for (int i = 0; i < 3; ++i) {
    const float* const d = c.first[i];
    const float* const dd = c.second[i];
    n[i] += kernel *
            (c.normal[i] + (d[0] * gx + d[1] * gy + d[2] * gz) +
             (dd[0] * hxx + dd[1] * hyy + dd[2] * hzz) + (dd[3] * hxy + dd[4] * hxz + dd[5] * hyz));
  }
}

[[gnu::always_inline]] inline void add_samples(const YukawaTree& tree, const YukawaBox& box,
                                               const YukawaScale& scale, const Floats* q,
                                               const Floats& nearest, Floats* n, Floats& total) {
  for (int i = box.begin; i < box.end; ++i) {
    const YukawaSample& s = tree.samples[i];
    const Floats x = q[0] - s.x, y = q[1] - s.y, z = q[2] - s.z;
    Floats r, w;
    root(x * x + y * y + z * z + scale.least, r);
    power_of_two((nearest - r) * scale.decay, w);
    w /= r;
    total += s.area * w;
    n[0] += s.nx * w;
    n[1] += s.ny * w;
    n[2] += s.nz * w;
  }
}

/// The middles of groups, a lane each, and how far they reach.
[[gnu::always_inline]] inline void outline(const YukawaGroup* groups, int count, Floats* middle,
                                           Floats& radius, Floats& nearest) {
  for (int g = 0; g < lanes; ++g) {
    const YukawaGroup& group = groups[g < count ? g : count - 1];
    const float* const place[3] = {group.x, group.y, group.z};
    float squared = 0, d = 0;
    for (int a = 0; a < 3; ++a) {
      float low = place[a][0], high = low;
      for (int l = 1; l < lanes; ++l) {
        low = place[a][l] < low ? place[a][l] : low;
        high = place[a][l] > high ? place[a][l] : high;
      }
      middle[a][g] = 0.5f * (low + high);
      squared += 0.25f * (high - low) * (high - low);
    }
    for (int l = 0; l < lanes; ++l) d = group.distance[l] > d ? group.distance[l] : d;
    radius[g] = std::sqrt(squared);
    nearest[g] = d;
  }
}

/// Clusters within reach of some group, as large as their moments do in the middle of every group.
[[gnu::always_inline]] inline void choose(const YukawaTree& tree, const YukawaScale& scale,
                                          const Floats* middle, const Floats& radius,
                                          const Floats& nearest, std::vector<YukawaPart>& room) {
  room.clear();
  const Floats far = (nearest + radius + scale.reach) * (nearest + radius + scale.reach);
  std::array<int, 128> stack;
  int top = 0;
  stack[top++] = 0;
  while (top > 0) {
    const int at = stack[--top];
    const YukawaBox& box = tree.boxes[at];
    Floats squared;
    gap(box, middle, squared);
    const Whole near = squared <= far;
    if (!any(near)) continue;
    Seen seen;
    see(tree.moments[at], scale, middle, nearest, seen);
    Whole good;
    is_good(tree.moments[at], scale, seen, good);
    if (box.child < 0 || all(good | ~near)) {
      YukawaPart& part = room.emplace_back();
      part.cluster = at;
      store(part.moments.data(), ~near | (good & 1));
    } else {
      stack[top++] = box.child + 1;
      stack[top++] = box.child;
    }
  }
}

[[gnu::always_inline]] inline void sum(const YukawaTree& tree, const YukawaScale& scale,
                                       YukawaGroup* groups, int count,
                                       std::vector<YukawaPart>& room) {
  Floats q[3];
  for (YukawaGroup* group = groups; group != groups + count; ++group) {
    Floats squared, nearest;
    load(q[0], group->x);
    load(q[1], group->y);
    load(q[2], group->z);
    find_nearest(tree, q, scale.least, squared);
    root(squared, nearest);
    store(group->distance, nearest);
  }
  Floats middle[3], radius, farthest;
  outline(groups, count, middle, radius, farthest);
  choose(tree, scale, middle, radius, farthest, room);
  const Whole wide = radius * scale.inverse > most_radius;
  for (int g = 0; g < count; ++g) {
    YukawaGroup& group = groups[g];
    Floats n[3] = {}, total = {}, nearest;
    load(q[0], group.x);
    load(q[1], group.y);
    load(q[2], group.z);
    load(nearest, group.distance);
    const Floats far = (nearest + scale.reach) * (nearest + scale.reach);
    for (const YukawaPart& part : room) {
      if (part.moments[g] < 0) continue;
      Floats squared;
      gap(tree.boxes[part.cluster], q, squared);
      if (!any(squared <= far)) continue;
      const YukawaMoments& moments = tree.moments[part.cluster];
      Whole good = {};
      Seen seen;
      if (part.moments[g] > 0) {
        see(moments, scale, q, nearest, seen);
        good = ~good;
        if (wide[g] != 0) is_good(moments, scale, seen, good);
      }
      if (all(good))
        add_cluster(moments, scale, seen, n, total);
      else
        add_samples(tree, tree.boxes[part.cluster], scale, q, nearest, n, total);
    }
    store(group.nx, n[0]);
    store(group.ny, n[1]);
    store(group.nz, n[2]);
    store(group.total, total);
  }
}

void plain_sum(const YukawaTree& tree, const YukawaScale& scale, YukawaGroup* groups, int n,
               std::vector<YukawaPart>& room) {
  sum(tree, scale, groups, n, room);
}
#if defined(__x86_64__)
[[gnu::target("avx2")]] void avx2_sum(const YukawaTree& tree, const YukawaScale& scale,
                                      YukawaGroup* groups, int n, std::vector<YukawaPart>& room) {
  sum(tree, scale, groups, n, room);
}
#endif

}  // namespace

YukawaSum* yukawa_sum() {
  static YukawaSum* const best = LITTORAL_FASTEST(&plain_sum, &avx2_sum);
  return best;
}

}  // namespace littoral
