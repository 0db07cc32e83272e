// Loops over lanes that compilers turn into vector instructions, with no calls and no branches, and
// lanes as vectors where they do not. CMakeLists lets the compiler assume for this file that square
// roots set no error number and comparisons do not trap, and keeps it from fusing products and
// sums, which rounds otherwise.

#include "spatial/nearest_kernels.h"

#include <cmath>
#include <cstdint>

#include "base/kernel_choice.h"
#include "base/vector_lanes.h"

namespace littoral {

namespace {

[[gnu::always_inline]] inline float least_of(const std::array<float, nearest_lanes>& s) {
  return smaller(smaller(smaller(s[0], s[4]), smaller(s[2], s[6])),
                 smaller(smaller(s[1], s[5]), smaller(s[3], s[7])));
}

/// To the nearest side, or to the plane where the point lies above the triangle.
[[gnu::always_inline]] inline float ways_of(const CornerLanes& t, const float* from, WayLanes& out,
                                            std::array<float, nearest_lanes>* sides = nullptr) {
  const float qx = from[0], qy = from[1], qz = from[2];
  for (int l = 0; l < nearest_lanes; ++l) {
    const float ax = t.corner[0][l] - qx, ay = t.corner[1][l] - qy, az = t.corner[2][l] - qz;
    const float bx = t.corner[3][l] - qx, by = t.corner[4][l] - qy, bz = t.corner[5][l] - qz;
    const float cx = t.corner[6][l] - qx, cy = t.corner[7][l] - qy, cz = t.corner[8][l] - qz;
    const float ux = bx - ax, uy = by - ay, uz = bz - az;
    const float vx = cx - bx, vy = cy - by, vz = cz - bz;
    const float wx = ax - cx, wy = ay - cy, wz = az - cz;
    const float nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
    const float tiny = 1e-30f;
    const auto along = [&](float px, float py, float pz, float ex, float ey, float ez) {
      const float s = -(px * ex + py * ey + pz * ez) / (ex * ex + ey * ey + ez * ez + tiny);
      return smaller(larger(s, 0.0f), 1.0f);
    };
    const float ta = along(ax, ay, az, ux, uy, uz), tb = along(bx, by, bz, vx, vy, vz),
                tc = along(cx, cy, cz, wx, wy, wz);
    float x = ax + ta * ux, y = ay + ta * uy, z = az + ta * uz;
    float best = x * x + y * y + z * z;
    const float x1 = bx + tb * vx, y1 = by + tb * vy, z1 = bz + tb * vz;
    const float s1 = x1 * x1 + y1 * y1 + z1 * z1;
    x = s1 < best ? x1 : x, y = s1 < best ? y1 : y, z = s1 < best ? z1 : z;
    best = smaller(s1, best);
    const float x2 = cx + tc * wx, y2 = cy + tc * wy, z2 = cz + tc * wz;
    const float s2 = x2 * x2 + y2 * y2 + z2 * z2;
    x = s2 < best ? x2 : x, y = s2 < best ? y2 : y, z = s2 < best ? z2 : z;
    if (sides) (*sides)[l] = smaller(s2, best);
    // n . (p x e): on which side of an edge the origin's foot lies.
    const auto side = [&](float px, float py, float pz, float ex, float ey, float ez) {
      return nx * (py * ez - pz * ey) + ny * (pz * ex - px * ez) + nz * (px * ey - py * ex);
    };
    const float in = smaller(side(ax, ay, az, ux, uy, uz),
                             smaller(side(bx, by, bz, vx, vy, vz), side(cx, cy, cz, wx, wy, wz)));
    const float up = (nx * ax + ny * ay + nz * az) / (nx * nx + ny * ny + nz * nz + tiny);
    x = in > 0 ? nx * up : x, y = in > 0 ? ny * up : y, z = in > 0 ? nz * up : z;
    out.way[0][l] = x;
    out.way[1][l] = y;
    out.way[2][l] = z;
    out.squared[l] = x * x + y * y + z * z;
  }
  return least_of(out.squared);
}

template <int width>
[[gnu::always_inline]] inline float ways_to_middles_of(const CornerLanes& t, const float* from,
                                                       WayLanes& out) {
  for (int l = 0; l < nearest_lanes; l += width) {
    typename Wide<width, float>::Lanes squared{}, a, b, c;
    for (int d = 0; d < 3; ++d) {
      load(a, &t.corner[d][l]);
      load(b, &t.corner[d + 3][l]);
      load(c, &t.corner[d + 6][l]);
      a = (a + b + c) * (1.0f / 3) - from[d];
      squared += a * a;
      store(&out.way[d][l], a);
    }
    store(&out.squared[l], squared);
  }
  return least_of(out.squared);
}

/// How far the balls of a box reach in a direction of some length.
[[gnu::always_inline]] inline float reach_of(const BoxWithBalls& b, float x, float y, float z,
                                             float length) {
  const float hx = x * b.half[0], hy = y * b.half[1], hz = z * b.half[2];
  const float yz = hy + hz, zy = hy - hz;
  float most = hx + yz + length * b.radius[7];
  most = larger(most, yz - hx + length * b.radius[6]);
  most = larger(most, hx - zy + length * b.radius[5]);
  most = larger(most, -hx - zy + length * b.radius[4]);
  most = larger(most, hx + zy + length * b.radius[3]);
  most = larger(most, zy - hx + length * b.radius[2]);
  most = larger(most, hx - yz + length * b.radius[1]);
  most = larger(most, -hx - yz + length * b.radius[0]);
  return most + length * b.slack;
}

using Flags = std::array<std::int32_t, nearest_lanes>;

[[gnu::always_inline]] inline unsigned bits_of(const Flags& flags) {
  unsigned bits = 0;
  for (int l = 0; l < nearest_lanes; ++l) bits |= static_cast<unsigned>(flags[l]) << l;
  return bits;
}

/// How far the nearest corner of a triangle is along its way from a point, times the way's length.
[[gnu::always_inline]] inline float least_along(const CornerLanes& t, const WayLanes& w, int l,
                                                const float* from) {
  const auto along = [&](int k) {
    return w.way[0][l] * (t.corner[k][l] - from[0]) + w.way[1][l] * (t.corner[k + 1][l] - from[1]) +
           w.way[2][l] * (t.corner[k + 2][l] - from[2]);
  };
  return smaller(along(0), smaller(along(3), along(6)));
}

/// Along its way every point of the triangle lies beyond all balls.
[[gnu::always_inline]] inline unsigned within_of(const CornerLanes& t, const WayLanes& w,
                                                 const BoxWithBalls& b) {
  alignas(32) Flags met;
  for (int l = 0; l < nearest_lanes; ++l) {
    const float x = w.way[0][l], y = w.way[1][l], z = w.way[2][l];
    const float least = least_along(t, w, l, b.centre.data());
    met[l] = least > reach_of(b, x, y, z, std::sqrt(w.squared[l])) ? 0 : 1;
  }
  return bits_of(met);
}

/// Along its way, which need not be the shortest, no point of the triangle is nearer than its
/// nearest corner; none of the sides is farther than the triangle.
[[gnu::always_inline]] inline unsigned bounds_of(const CornerLanes& t, const float* from,
                                                 float& most, float* squared) {
  constexpr float tiny = 1e-30f, rounding = 4e-6f;
  const float slack = 2e-6f * (2 + std::abs(from[0]) + std::abs(from[1]) + std::abs(from[2]));
  WayLanes w;
  alignas(32) std::array<float, nearest_lanes> sides;
  ways_of(t, from, w, &sides);
  const float reach = std::sqrt(least_of(sides)) * (1 + rounding) + slack;
  most = smaller(most, reach * reach);
  alignas(32) Flags met;
  for (int l = 0; l < nearest_lanes; ++l) {
    const float least = least_along(t, w, l, from);
    const float length = std::sqrt(w.squared[l] + tiny);
    const float away = larger((1 - rounding) * least / length - slack, 0.0f);
    squared[l] = away * away;
    met[l] = squared[l] <= most ? 1 : 0;
  }
  return bits_of(met);
}

[[gnu::always_inline]] inline unsigned balls_of(const BallLanes& t, const BoxWithBalls& b,
                                                unsigned& far) {
  constexpr float small = 0.25f;
  const float qx = b.centre[0], qy = b.centre[1], qz = b.centre[2];
  alignas(32) Flags met, small_beside;
  for (int l = 0; l < nearest_lanes; ++l) {
    const float x = t.x[l] - qx, y = t.y[l] - qy, z = t.z[l] - qz;
    const float squared = x * x + y * y + z * z, length = std::sqrt(squared);
    met[l] = squared - length * t.radius[l] > reach_of(b, x, y, z, length) ? 0 : 1;
    small_beside[l] = t.radius[l] < small * length ? 1 : 0;
  }
  far = bits_of(small_beside);
  return bits_of(met);
}

[[gnu::always_inline]] inline void put_ball_of(const CornerLanes& t, BallLanes& out, int lane) {
  float middle[3], squared = 0;
  for (int d = 0; d < 3; ++d) {
    constexpr int width = 4;
    Wide<width, float>::Lanes low, high, more;
    load(low, &t.corner[d][0]);
    high = low;
    for (const int c : {d, d + 3, d + 6})
      for (int l = 0; l < nearest_lanes; l += width) {
        load(more, &t.corner[c][l]);
        take_smaller(low, more);
        take_larger(high, more);
      }
    const float least = smaller(smaller(low[0], low[1]), smaller(low[2], low[3])),
                most = larger(larger(high[0], high[1]), larger(high[2], high[3]));
    middle[d] = (least + most) / 2;
    squared += (most - least) * (most - least);
  }
  out.x[lane] = middle[0];
  out.y[lane] = middle[1];
  out.z[lane] = middle[2];
  out.radius[lane] = std::sqrt(squared) / 2;
}

/// The squared distances of places, or `best` where that is less: to a plane or to three sides, by
/// the same sums wherever the place is.
template <class Lanes, class Real>
[[gnu::always_inline]] inline void squared_to(const NearTriangle<Real>& t, const Lanes& x,
                                              const Lanes& y, const Lanes& z, const Lanes& best,
                                              Lanes& out) {
  const Lanes zero{}, one = zero + 1;
  Lanes side = best, above = one;
  const auto add_side = [&](int k) {
    const Lanes px = x - t.corner[k][0], py = y - t.corner[k][1], pz = z - t.corner[k][2];
    const Real ex = t.edge[k][0], ey = t.edge[k][1], ez = t.edge[k][2];
    Lanes at = (px * ex + py * ey + pz * ez) * t.per_length[k];
    take_larger(at, zero);
    take_smaller(at, one);
    const Lanes ox = px - at * ex, oy = py - at * ey, oz = pz - at * ez;
    take_smaller<Lanes>(side, ox * ox + oy * oy + oz * oz);
    take_smaller<Lanes>(above, px * t.inward[k][0] + py * t.inward[k][1] + pz * t.inward[k][2]);
  };
  add_side(0);
  add_side(1);
  add_side(2);
  const Lanes up = (x - t.corner[0][0]) * t.normal[0] + (y - t.corner[0][1]) * t.normal[1] +
                   (z - t.corner[0][2]) * t.normal[2];
  Lanes plane = up * up * t.per_normal;
  take_smaller(plane, best);
  out = above > zero ? plane : side;
}

template <int width>
[[gnu::always_inline]] inline void candidates_of(const RoughTriangle* triangles, int n,
                                                 const PlaceLanes& at, float slack, float* room) {
  using Lanes = typename Wide<width, float>::Lanes;
  using Bits = typename Wide<width, float>::Bits;
  constexpr float rounding = 4e-6f, most = 3e38f;
  for (int i = 0; i < n; ++i) *triangles[i].may_be = 0;
  for (int l = 0; l < nearest_lanes; l += width) {
    Lanes x, y, z, squared, least = Lanes{} + most;
    const Lanes all = least;
    load(x, &at.x[l]);
    load(y, &at.y[l]);
    load(z, &at.z[l]);
    for (int i = 0; i < n; ++i) {
      squared_to(*triangles[i].triangle, x, y, z, all, squared);
      take_smaller(least, squared);
      store(room + i * width, squared);
    }
    alignas(32) std::array<float, width> reach;
    store(reach.data(), least);
    for (int w = 0; w < width; ++w) {
      reach[w] = std::sqrt(reach[w]) * (1 + rounding) + slack;
      reach[w] *= reach[w];
    }
    load(least, reach.data());
    for (int i = 0; i < n; ++i) {
      load(squared, room + i * width);
      const Bits met = (Bits)(squared <= least);
      *triangles[i].may_be |= static_cast<char>(any(met));
    }
  }
}

template <int width>
[[gnu::always_inline]] inline void look_of(const NearTriangle<double>& t, double number,
                                           const NearNodes& nodes) {
  using Lanes = typename Wide<width>::Lanes;
  const Lanes here = Lanes{} + number;
  Lanes x, y, z, best, found, before;
  for (int i = 0; i < nodes.n; i += width) {
    load(x, nodes.x + i);
    load(y, nodes.y + i);
    load(z, nodes.z + i);
    load(best, nodes.squared + i);
    load(before, nodes.nearest + i);
    squared_to(t, x, y, z, best, found);
    store<Lanes>(nodes.nearest + i, found < best ? here : before);
    store(nodes.squared + i, found);
  }
}

void put_ball_plain(const CornerLanes& t, BallLanes& out, int lane) { put_ball_of(t, out, lane); }
unsigned balls_plain(const BallLanes& t, const BoxWithBalls& b, unsigned& far) {
  return balls_of(t, b, far);
}
float ways_to_middles_plain(const CornerLanes& t, const float* from, WayLanes& out) {
  return ways_to_middles_of<4>(t, from, out);
}
float ways_plain(const CornerLanes& t, const float* from, WayLanes& out) {
  return ways_of(t, from, out);
}
unsigned within_plain(const CornerLanes& t, const WayLanes& w, const BoxWithBalls& b) {
  return within_of(t, w, b);
}
unsigned bounds_plain(const CornerLanes& t, const float* from, float& most, float* squared) {
  return bounds_of(t, from, most, squared);
}
void candidates_plain(const RoughTriangle* triangles, int n, const PlaceLanes& at, float slack,
                      float* room) {
  candidates_of<4>(triangles, n, at, slack, room);
}
void look_plain(const NearTriangle<double>& t, double number, const NearNodes& nodes) {
  look_of<2>(t, number, nodes);
}

#if defined(__x86_64__)
[[gnu::target("avx2")]] void put_ball_avx2(const CornerLanes& t, BallLanes& out, int lane) {
  put_ball_of(t, out, lane);
}
[[gnu::target("avx2")]] unsigned balls_avx2(const BallLanes& t, const BoxWithBalls& b,
                                            unsigned& far) {
  return balls_of(t, b, far);
}
[[gnu::target("avx2")]] float ways_to_middles_avx2(const CornerLanes& t, const float* from,
                                                   WayLanes& out) {
  return ways_to_middles_of<8>(t, from, out);
}
[[gnu::target("avx2")]] float ways_avx2(const CornerLanes& t, const float* from, WayLanes& out) {
  return ways_of(t, from, out);
}
[[gnu::target("avx2")]] unsigned within_avx2(const CornerLanes& t, const WayLanes& w,
                                             const BoxWithBalls& b) {
  return within_of(t, w, b);
}
[[gnu::target("avx2")]] unsigned bounds_avx2(const CornerLanes& t, const float* from, float& most,
                                             float* squared) {
  return bounds_of(t, from, most, squared);
}
[[gnu::target("avx2")]] void candidates_avx2(const RoughTriangle* triangles, int n,
                                             const PlaceLanes& at, float slack, float* room) {
  candidates_of<8>(triangles, n, at, slack, room);
}
[[gnu::target("avx2")]] void look_avx2(const NearTriangle<double>& t, double number,
                                       const NearNodes& nodes) {
  look_of<4>(t, number, nodes);
}
#endif

}  // namespace

const NearestKernels& nearest_kernels() {
  static const NearestKernels best = LITTORAL_FASTEST(
      (NearestKernels{&put_ball_plain, &balls_plain, &ways_plain, &ways_to_middles_plain,
                      &within_plain, &bounds_plain, &candidates_plain, &look_plain}),
      (NearestKernels{&put_ball_avx2, &balls_avx2, &ways_avx2, &ways_to_middles_avx2, &within_avx2,
                      &bounds_avx2, &candidates_avx2, &look_avx2}));
  return best;
}

}  // namespace littoral
