// Loops over lanes that compilers turn into vector instructions: no calls, no branches. CMakeLists
// lets the compiler assume for this file that square roots set no error number and comparisons do
// not trap, and keeps it from fusing products and sums: the side of an edge must be the same
// number, but for the sign, whichever end comes first.

#include "spatial/crossing_kernels.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/kernel_choice.h"
#include "base/vector_lanes.h"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace littoral {

namespace {

// In the plane z = 0 an edge from a to b that passes it is the point (x, y) = (g, f) / (b_z - a_z).
double side_y(const double* a, const double* b) { return a[1] * b[2] - a[2] * b[1]; }
double side_x(const double* a, const double* b) { return a[0] * b[2] - a[2] * b[0]; }

/// Whether an edge that passes z = 0 upward does so at y > 0.
bool beyond(const double* low, const double* high) {
  const double f = side_y(low, high);
  return f > 0 || (f == 0 && high[1] > low[1]);
}

int exact_crossings(const TriangleLanes& t, const double* q) {
  int sum = 0;
  for (int l = 0; l < winding_lanes; ++l) {
    double p[3][3];
    for (int c = 0; c < 9; ++c) p[c / 3][c % 3] = t.corner[c][l] - q[c % 3];
    sum += crossing(p[0], p[1], p[2]);
  }
  return sum;
}

/// The cut of z = 0 with a triangle goes between the edge that passes z = 0 upward and the one that
/// does so downward; it counts 1 where the former has y > 0, the latter has not and the cut meets
/// y = 0 at x > 0.
template <int width>
[[gnu::always_inline]] inline void add_crossings(const TriangleLanes& t, int first, const double* q,
                                                 typename Wide<width>::Bits& sum,
                                                 typename Wide<width>::Bits& tied) {
  using Lanes = typename Wide<width>::Lanes;
  using Bits = typename Wide<width>::Bits;
  struct Corner {
    Lanes x, y, z;
    Bits above;
  };
  const auto corner = [&](int c) {
    Corner p;
    load(p.x, t.corner[c].data() + first);
    load(p.y, t.corner[c + 1].data() + first);
    load(p.z, t.corner[c + 2].data() + first);
    p.x -= q[0];
    p.y -= q[1];
    p.z -= q[2];
    p.above = (Bits)(p.z > 0);
    return p;
  };
  const Corner a = corner(0), b = corner(3), c = corner(6);
  Bits up_f{}, up_g{}, down_f{}, down_g{};
  const auto add_edge = [&](const Corner& i, const Corner& j) {
    const Bits f = (Bits)(i.y * j.z - i.z * j.y), g = (Bits)(i.x * j.z - i.z * j.x);
    const Bits up = ~i.above & j.above, down = i.above & ~j.above;
    up_f |= up & f;
    up_g |= up & g;
    down_f |= down & f;
    down_g |= down & g;
  };
  add_edge(a, b);
  add_edge(b, c);
  add_edge(c, a);
  // Of the edge that goes down f and g have the other sign.
  const Lanes rise = (Lanes)up_f, fall = (Lanes)down_f;
  const Bits passes = (a.above ^ b.above) | (b.above ^ c.above);
  const Lanes x = (Lanes)up_g * fall - (Lanes)down_g * rise;
  tied |= passes & ((Bits)(rise == 0) | (Bits)(fall == 0));
  sum += ((Bits)(rise < 0) & (Bits)(fall < 0) & (Bits)(x < 0)) -
         ((Bits)(rise > 0) & (Bits)(fall > 0) & (Bits)(x > 0));
}

template <int width>
[[gnu::always_inline]] inline int crossings_of(const TriangleLanes& t, const double* q) {
  typename Wide<width>::Bits sum{}, tied{};
  for (int l = 0; l < winding_lanes; l += width) add_crossings<width>(t, l, q, sum, tied);
  std::int64_t total = 0, ties = 0;
  for (int l = 0; l < width; ++l) {
    total += sum[l];
    ties |= tied[l];
  }
  return ties == 0 ? static_cast<int>(total) : exact_crossings(t, q);
}

/// Products of complex numbers and the whole turns of their angles, lane by lane: a sum of two
/// angles of one sign that gets the other one has turned. The arc tangent tells 0 from -0 and pi
/// from -pi by the same signs.
template <int width>
struct TurnLanes {
  using Lanes = typename Wide<width>::Lanes;
  using Bits = typename Wide<width>::Bits;
  Lanes re = Lanes{} + 1, im = Lanes{};
  Bits turns = Bits{};

  [[gnu::always_inline]] void turn_by(const Lanes& more_re, const Lanes& more_im) {
    const Lanes r = re * more_re - im * more_im, i = re * more_im + im * more_re;
    const Bits a = (Bits)im, b = (Bits)more_im, c = (Bits)i;
    // -1 where the sign is set; shifts of signed numbers are not vector instructions.
    turns += (Bits)((a & b & ~c) < 0) - (Bits)((~a & ~b & c) < 0);
    re = r;
    im = i;
  }
};

/// With s = |a| - a_x the angle of an edge is that of s_a s_b + a_yz . b_yz - i (a_yz x b_yz), from
/// the stereographic projection along x. Each lane multiplies every eighth. Four angles below pi /
/// 4 make no turn, so that turns are mostly looked for in their products.
template <int width>
[[gnu::always_inline]] inline bool walk_of(const WalkView& walk, const double* q, WalkAngle& out) {
  using Lanes = typename Wide<width>::Lanes;
  using Bits = typename Wide<width>::Bits;
  constexpr int block = 256, parts = winding_lanes / width, together = 4;
  constexpr double narrow = 1e-6;
  alignas(64) double s[block + winding_lanes], y[block + winding_lanes], z[block + winding_lanes];
  TurnLanes<width> angle[parts];
  const Lanes zero{};
  const Bits sign = (Bits)(-zero);
  Lanes apart = zero + 1;             // not above 0: an edge meets the ray
  Lanes nearest = zero + walk.reach;  // of the s
  const double qx = q[0], qy = q[1], qz = q[2];
  for (int from = 0; from < walk.n_edges; from += block) {
    const int n = std::min(block, walk.n_edges - from);
    const double *X = walk.x + from, *Y = walk.y + from, *Z = walk.z + from;
    for (int i = 0; i < n + winding_lanes; i += winding_lanes)
      for (int l = 0; l < winding_lanes; ++l) {
        const double x = X[i + l] - qx, v = Y[i + l] - qy, w = Z[i + l] - qz;
        s[i + l] = std::sqrt(x * x + (v * v + w * w)) - x;
        y[i + l] = v;
        z[i + l] = w;
      }
    for (int i = 0; i < n; i += together * winding_lanes) {
      Lanes dens[parts][together], nums[parts][together], steepest = zero + walk.reach;
      for (int p = 0; p < parts; ++p)
        for (int k = 0; k < together; ++k) {
          const int at = i + k * winding_lanes + p * width;
          Lanes sa, sb, ya, yb, za, zb;
          load(sa, s + at), load(sb, s + at + 1);
          load(ya, y + at), load(yb, y + at + 1);
          load(za, z + at), load(zb, z + at + 1);
          nearest = sa < nearest ? sa : nearest;
          const Lanes den = sa * sb + (ya * yb + za * zb), num = za * yb - ya * zb;
          const Lanes room = den - (Lanes)((Bits)num & ~sign);
          steepest = room < steepest ? room : steepest;
          dens[p][k] = den;
          nums[p][k] = num;
        }
      // Of all lanes, however many there are in a register: rounding must not depend on it.
      bool small = true;
      for (int l = 0; l < width; ++l) small = small & (steepest[l] > 0);
      for (int p = 0; p < parts; ++p) {
        TurnLanes<width>& so_far = angle[p];
        const Lanes *d = dens[p], *m = nums[p];
        if (small) {
          const auto times = [](const Lanes& a, const Lanes& b, const Lanes& c, const Lanes& e,
                                Lanes& re, Lanes& im) {
            re = a * c - b * e;
            im = a * e + b * c;
          };
          Lanes re1, im1, re2, im2, re, im;
          times(d[0], m[0], d[1], m[1], re1, im1);
          times(d[2], m[2], d[3], m[3], re2, im2);
          times(re1, im1, re2, im2, re, im);
          so_far.turn_by(re, im);
        } else {
          for (int k = 0; k < together; ++k) {
            const Lanes size = (Lanes)((Bits)m[k] & ~sign);
            const Lanes larger = d[k] > size ? d[k] : size;
            apart = larger < apart ? larger : apart;
            so_far.turn_by(d[k], m[k]);
          }
        }
        const Lanes scale =
            1 / ((Lanes)((Bits)so_far.re & ~sign) + (Lanes)((Bits)so_far.im & ~sign));
        so_far.re *= scale;
        so_far.im *= scale;
      }
    }
  }
  bool fine = true;
  for (int l = 0; l < width; ++l) fine = fine && apart[l] > 0 && nearest[l] > narrow * walk.reach;
  if (!fine) return false;
  out = {};
  for (const TurnLanes<width>& part : angle)
    for (int l = 0; l < width; ++l) {
      out.turn_by(part.re[l], part.im[l]);
      out.turns += static_cast<double>(part.turns[l]);
    }
  return true;
}

unsigned pierced_plain(const ShadowNode& n, const float* q) {
  unsigned bits = 0;
  for (int l = 0; l < winding_lanes; ++l) {
    const bool in = n.low_y[l] <= q[1] && q[1] <= n.high_y[l] && n.low_z[l] <= q[2] &&
                    q[2] <= n.high_z[l] && q[0] <= n.high_x[l];
    bits |= (in ? 1u : 0u) << l;
  }
  return bits;
}
int crossings_plain(const TriangleLanes& t, const double* q) { return crossings_of<2>(t, q); }
bool walk_plain(const WalkView& walk, const double* q, WalkAngle& out) {
  return walk_of<2>(walk, q, out);
}

#if defined(__x86_64__)
[[gnu::target("avx2")]] unsigned pierced_avx2(const ShadowNode& n, const float* q) {
  const __m256 x = _mm256_set1_ps(q[0]), y = _mm256_set1_ps(q[1]), z = _mm256_set1_ps(q[2]);
  const __m256 in_y = _mm256_and_ps(_mm256_cmp_ps(_mm256_load_ps(n.low_y.data()), y, _CMP_LE_OQ),
                                    _mm256_cmp_ps(y, _mm256_load_ps(n.high_y.data()), _CMP_LE_OQ));
  const __m256 in_z = _mm256_and_ps(_mm256_cmp_ps(_mm256_load_ps(n.low_z.data()), z, _CMP_LE_OQ),
                                    _mm256_cmp_ps(z, _mm256_load_ps(n.high_z.data()), _CMP_LE_OQ));
  const __m256 ahead = _mm256_cmp_ps(x, _mm256_load_ps(n.high_x.data()), _CMP_LE_OQ);
  return static_cast<unsigned>(_mm256_movemask_ps(_mm256_and_ps(_mm256_and_ps(in_y, in_z), ahead)));
}
[[gnu::target("avx2")]] int crossings_avx2(const TriangleLanes& t, const double* q) {
  return crossings_of<4>(t, q);
}
[[gnu::target("avx2")]] bool walk_avx2(const WalkView& walk, const double* q, WalkAngle& out) {
  return walk_of<4>(walk, q, out);
}
[[gnu::target(LITTORAL_AVX512)]] bool walk_avx512(const WalkView& walk, const double* q,
                                                  WalkAngle& out) {
  return walk_of<8>(walk, q, out);
}
#endif

}  // namespace

int crossing(const double* a, const double* b, const double* c) {
  const double* corner[3] = {a, b, c};
  const bool up[3] = {a[2] > 0, b[2] > 0, c[2] > 0};
  const double *rise[2] = {}, *fall[2] = {};  // ends of the edges that pass, the lower first
  for (int k = 0; k < 3; ++k) {
    const int n = (k + 1) % 3;
    if (!up[k] && up[n]) rise[0] = corner[k], rise[1] = corner[n];
    if (up[k] && !up[n]) fall[0] = corner[n], fall[1] = corner[k];
  }
  if (rise[0] == nullptr) return 0;
  const bool rises_beyond = beyond(rise[0], rise[1]);
  if (rises_beyond == beyond(fall[0], fall[1])) return 0;
  const double rise_x = side_x(rise[0], rise[1]), fall_x = side_x(fall[0], fall[1]);
  // Of the cut's two ends, the one with y > 0 minus the other; both may have y = 0.
  const double x = side_y(rise[0], rise[1]) * fall_x - side_y(fall[0], fall[1]) * rise_x;
  const bool ahead = (rise_x > 0) == (fall_x > 0) ? rise_x > 0 : (rises_beyond ? x : -x) > 0;
  if (!ahead) return 0;
  return rises_beyond ? 1 : -1;
}

double careful_angle(const double* a, const double* b) {
  struct Seen {
    double s, y, z;
  };
  const auto see = [](const double* p) {
    const double across = p[1] * p[1] + p[2] * p[2];
    const double length = std::sqrt(p[0] * p[0] + across);
    if (p[0] > 0 && across == 0) return Seen{0, 0, -1};  // on the ray: as the query moves
    return Seen{p[0] > 0 ? across / (length + p[0]) : length - p[0], p[1], p[2]};
  };
  const Seen i = see(a), j = see(b);
  const double den = i.s * j.s + (i.y * j.y + i.z * j.z), num = i.z * j.y - i.y * j.z;
  if (num != 0 || den > 0) return std::atan2(num, den);
  if (den == 0) return 0;
  const double moved = b[1] != a[1] ? a[1] - b[1] : b[2] - a[2];
  return moved > 0 ? M_PI : -M_PI;
}

const CrossingKernels& crossing_kernels() {
  static const CrossingKernels best = [] {
    CrossingKernels kernels =
        LITTORAL_FASTEST((CrossingKernels{&pierced_plain, &crossings_plain, &walk_plain}),
                         (CrossingKernels{&pierced_avx2, &crossings_avx2, &walk_avx2}));
#if defined(__x86_64__)
    if (LITTORAL_HAS_AVX512) kernels.walk_angle = &walk_avx512;
#endif
    return kernels;
  }();
  return best;
}

}  // namespace littoral
