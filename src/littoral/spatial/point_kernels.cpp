// Loops over lanes that compilers turn into vector instructions: no calls, no branches. CMakeLists
// lets the compiler assume for this file that square roots set no error number and comparisons do
// not trap, and keeps it from fusing products and sums, which rounds otherwise.

#include "littoral/spatial/point_kernels.h"

#include <cmath>
#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace littoral {

namespace {

[[gnu::always_inline]] inline double larger(double a, double b) { return a > b ? a : b; }

[[gnu::always_inline]] inline void node_lanes(const PointNode& n, const double* q,
                                              double* squared) {
  const double qx = q[0], qy = q[1], qz = q[2];
  for (int l = 0; l < point_lanes; ++l) {
    const double gx = larger(larger(n.low[0][l] - qx, qx - n.high[0][l]), 0);
    const double gy = larger(larger(n.low[1][l] - qy, qy - n.high[1][l]), 0);
    const double gz = larger(larger(n.low[2][l] - qz, qz - n.high[2][l]), 0);
    const double box = gx * gx + gy * gy + gz * gz;
    const double x = qx - n.centre[0][l], y = qy - n.centre[1][l], z = qz - n.centre[2][l];
    const double h = x * n.axis[0][l] + y * n.axis[1][l] + z * n.axis[2][l];
    const double sum = std::abs(x) + std::abs(y) + std::abs(z);
    const double slack = 1e-14 * sum;  // for rounding, so that the bound is one
    const double across = larger(x * x + y * y + z * z - h * h - slack * sum, 0);
    const double out = larger(std::sqrt(across) - n.radius[l], 0);
    const double up = larger(std::abs(h) - n.half[l] - slack, 0);
    squared[l] = larger(box, (out * out + up * up) * (1 - 1e-14));
  }
}

[[gnu::always_inline]] inline void leaf_points(const PointLeaf& leaf, const double* q,
                                               double* squared) {
  const double qx = q[0], qy = q[1], qz = q[2];
  for (int l = 0; l < leaf_lanes; ++l) {
    const double x = leaf.x[0][l] - qx, y = leaf.x[1][l] - qy, z = leaf.x[2][l] - qz;
    squared[l] = x * x + y * y + z * z;
  }
}

unsigned used(const PointLeaf& leaf) { return (1u << leaf.size) - 1; }

void node_plain(const PointNode& n, const double* q, double* squared) { node_lanes(n, q, squared); }
unsigned leaf_plain(const PointLeaf& leaf, const double* q, double bound, double* squared) {
  leaf_points(leaf, q, squared);
  unsigned near = 0;
  for (int l = 0; l < leaf_lanes; ++l) near |= (squared[l] <= bound ? 1u : 0u) << l;
  return near & used(leaf);
}

#if defined(__x86_64__)
[[gnu::target("avx2")]] void node_avx2(const PointNode& n, const double* q, double* squared) {
  node_lanes(n, q, squared);
}
[[gnu::target("avx2")]] unsigned leaf_avx2(const PointLeaf& leaf, const double* q, double bound,
                                           double* squared) {
  leaf_points(leaf, q, squared);
  const __m256d most = _mm256_set1_pd(bound);
  unsigned near = 0;
  for (int l = 0; l < leaf_lanes; l += 4) {
    const __m256d within = _mm256_cmp_pd(_mm256_load_pd(squared + l), most, _CMP_LE_OQ);
    near |= static_cast<unsigned>(_mm256_movemask_pd(within)) << l;
  }
  return near & used(leaf);
}
#endif

}  // namespace

const PointKernels& point_kernels() {
  static constexpr PointKernels plain{&node_plain, &leaf_plain};
#if defined(__x86_64__)
  static constexpr PointKernels avx2{&node_avx2, &leaf_avx2};
  static const PointKernels& best = __builtin_cpu_supports("avx2") ? avx2 : plain;
  return best;
#else
  return plain;
#endif
}

}  // namespace littoral
