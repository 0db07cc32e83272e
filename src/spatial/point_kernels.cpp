// Loops over lanes that compilers turn into vector instructions: no calls, no branches. CMakeLists
// lets the compiler assume for this file that square roots set no error number and comparisons do
// not trap, and keeps it from fusing products and sums, which rounds otherwise.

#include "spatial/point_kernels.h"

#include "base/kernel_choice.h"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace littoral {

namespace {

[[gnu::always_inline]] inline void leaf_points(const PointLeaf& leaf, const double* q,
                                               double* squared) {
  const double qx = q[0], qy = q[1], qz = q[2];
  for (int l = 0; l < leaf_lanes; ++l) {
    const double x = leaf.x[0][l] - qx, y = leaf.x[1][l] - qy, z = leaf.x[2][l] - qz;
    squared[l] = x * x + y * y + z * z;
  }
}

unsigned used(const PointLeaf& leaf) { return (1u << leaf.size) - 1; }

unsigned leaf_plain(const PointLeaf& leaf, const double* q, double bound, double* squared) {
  leaf_points(leaf, q, squared);
  unsigned near = 0;
  for (int l = 0; l < leaf_lanes; ++l) near |= (squared[l] <= bound ? 1u : 0u) << l;
  return near & used(leaf);
}

#if defined(__x86_64__)
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

LeafKernel* leaf_kernel() {
  static LeafKernel* const best = LITTORAL_FASTEST(&leaf_plain, &leaf_avx2);
  return best;
}

}  // namespace littoral
