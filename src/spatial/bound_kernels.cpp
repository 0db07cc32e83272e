// Loops over lanes that compilers turn into vector instructions: no calls, no branches. CMakeLists
// lets the compiler assume for this file that square roots set no error number and comparisons do
// not trap, and keeps it from fusing products and sums, which rounds otherwise.

#include <cmath>

#include "base/kernel_choice.h"
#include "base/vector_lanes.h"
#include "spatial/bound_node.h"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace littoral {

namespace {

/// Distances of q to box and disk, each less by `slack` for lane l, squares less by `relative` of
/// what cancels.
template <class Node, class S, class Slack>
[[gnu::always_inline]] inline void bounds_of(const Node& n, const S* q, S relative, S kept,
                                             const Slack& slack_of, double* squared) {
  const S qx = q[0], qy = q[1], qz = q[2], none = 0;
  for (int l = 0; l < bound_lanes; ++l) {
    const S x = qx - n.centre[0][l], y = qy - n.centre[1][l], z = qz - n.centre[2][l];
    const S sum = std::abs(x) + std::abs(y) + std::abs(z), slack = slack_of(l, sum);
    const S gx = larger(larger<S>(n.low[0][l] - qx, qx - n.high[0][l]) - slack, none);
    const S gy = larger(larger<S>(n.low[1][l] - qy, qy - n.high[1][l]) - slack, none);
    const S gz = larger(larger<S>(n.low[2][l] - qz, qz - n.high[2][l]) - slack, none);
    const S box = gx * gx + gy * gy + gz * gz;
    const S h = x * n.axis[0][l] + y * n.axis[1][l] + z * n.axis[2][l];
    const S across = larger(x * x + y * y + z * z - h * h - relative * sum * sum, none);
    const S out = larger(std::sqrt(across) - n.radius[l] - slack, none);
    const S up = larger(std::abs(h) - n.half[l] - slack, none);
    squared[l] = kept * larger(box, out * out + up * up);
  }
}

[[gnu::always_inline]] inline void double_bounds(const BoundNode& n, const double* q,
                                                 double* squared) {
  bounds_of<BoundNode, double>(
      n, q, 1e-14, 1, [&](int l, double sum) { return 1e-14 * sum + n.slack[l]; }, squared);
}

// Coordinates and axes are rounded by 6e-8; so is every operation near by.
[[gnu::always_inline]] inline void near_bounds(const SmallBoundNode& n, const double* q,
                                               double* squared) {
  const float to[3] = {static_cast<float>(q[0]), static_cast<float>(q[1]),
                       static_cast<float>(q[2])};
  const float slack = 1e-6f * (1 + std::abs(to[0]) + std::abs(to[1]) + std::abs(to[2]));
  bounds_of<SmallBoundNode, float>(
      n, to, 4e-6f, 1 - 4e-6f, [=](int, float) { return slack; }, squared);
}
[[gnu::always_inline]] inline void far_bounds(const SmallBoundNode& n, const double* q,
                                              double* squared) {
  bounds_of<SmallBoundNode, double>(
      n, q, 1e-6, 1, [](int, double sum) { return 1e-14 * sum + 1e-6; }, squared);
}

void bounds_plain(const BoundNode& n, const double* q, double* squared) {
  double_bounds(n, q, squared);
}
unsigned within(const double* squared, double bound) {
  unsigned near = 0;
  for (int l = 0; l < bound_lanes; ++l) near |= (squared[l] <= bound ? 1u : 0u) << l;
  return near;
}
unsigned near_plain(const SmallBoundNode& n, const double* q, double bound, double* squared) {
  near_bounds(n, q, squared);
  return within(squared, bound);
}
unsigned far_plain_bounds(const SmallBoundNode& n, const double* q, double bound, double* squared) {
  far_bounds(n, q, squared);
  return within(squared, bound);
}

#if defined(__x86_64__)
[[gnu::target("avx2")]] void bounds_avx2(const BoundNode& n, const double* q, double* squared) {
  double_bounds(n, q, squared);
}
[[gnu::target("avx2"), gnu::always_inline]] inline unsigned within_avx2(const double* squared,
                                                                        double bound) {
  const __m256d most = _mm256_set1_pd(bound);
  unsigned near = 0;
  for (int l = 0; l < bound_lanes; l += 4)
    near |= static_cast<unsigned>(
                _mm256_movemask_pd(_mm256_cmp_pd(_mm256_load_pd(squared + l), most, _CMP_LE_OQ)))
            << l;
  return near;
}
[[gnu::target("avx2")]] unsigned near_avx2(const SmallBoundNode& n, const double* q, double bound,
                                           double* squared) {
  near_bounds(n, q, squared);
  return within_avx2(squared, bound);
}
[[gnu::target("avx2")]] unsigned far_avx2_bounds(const SmallBoundNode& n, const double* q,
                                                 double bound, double* squared) {
  far_bounds(n, q, squared);
  return within_avx2(squared, bound);
}
#endif

}  // namespace

BoundKernel* bound_kernel() {
  static BoundKernel* const best = LITTORAL_FASTEST(&bounds_plain, &bounds_avx2);
  return best;
}

const SmallBoundKernels& small_bound_kernels() {
  static const SmallBoundKernels best =
      LITTORAL_FASTEST((SmallBoundKernels{&near_plain, &far_plain_bounds}),
                       (SmallBoundKernels{&near_avx2, &far_avx2_bounds}));
  return best;
}

}  // namespace littoral
