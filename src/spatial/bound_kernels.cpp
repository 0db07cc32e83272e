// Loops over lanes that compilers turn into vector instructions: no calls, no branches. CMakeLists
// lets the compiler assume for this file that square roots set no error number and comparisons do
// not trap, and keeps it from fusing products and sums, which rounds otherwise.

#include <cmath>

#include "spatial/bound_node.h"

namespace littoral {

namespace {

[[gnu::always_inline]] inline double larger(double a, double b) { return a > b ? a : b; }

[[gnu::always_inline]] inline void bounds_of(const BoundNode& n, const double* q, double* squared) {
  const double qx = q[0], qy = q[1], qz = q[2];
  for (int l = 0; l < bound_lanes; ++l) {
    const double x = qx - n.centre[0][l], y = qy - n.centre[1][l], z = qz - n.centre[2][l];
    const double sum = std::abs(x) + std::abs(y) + std::abs(z);
    const double slack = 1e-14 * sum + n.slack[l];
    const double gx = larger(larger(n.low[0][l] - qx, qx - n.high[0][l]) - slack, 0);
    const double gy = larger(larger(n.low[1][l] - qy, qy - n.high[1][l]) - slack, 0);
    const double gz = larger(larger(n.low[2][l] - qz, qz - n.high[2][l]) - slack, 0);
    const double box = gx * gx + gy * gy + gz * gz;
    const double h = x * n.axis[0][l] + y * n.axis[1][l] + z * n.axis[2][l];
    const double across = larger(x * x + y * y + z * z - h * h - 1e-14 * sum * sum, 0);
    const double out = larger(std::sqrt(across) - n.radius[l] - slack, 0);
    const double up = larger(std::abs(h) - n.half[l] - slack, 0);
    squared[l] = larger(box, out * out + up * up);
  }
}

void bounds_plain(const BoundNode& n, const double* q, double* squared) {
  bounds_of(n, q, squared);
}

#if defined(__x86_64__)
[[gnu::target("avx2")]] void bounds_avx2(const BoundNode& n, const double* q, double* squared) {
  bounds_of(n, q, squared);
}
#endif

}  // namespace

BoundKernel* bound_kernel() {
#if defined(__x86_64__)
  static BoundKernel* const best = __builtin_cpu_supports("avx2") ? &bounds_avx2 : &bounds_plain;
  return best;
#else
  return &bounds_plain;
#endif
}

}  // namespace littoral
