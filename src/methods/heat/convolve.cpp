#include "methods/heat/convolve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/stable_length.h"

namespace littoral {

namespace {
constexpr int leaf = 8;             // samples
constexpr double reach = 8;         // in sqrt(t) beyond the nearest sample
constexpr double cancelled = 1e-5;  // of the sum of the kernels' sizes
}  // namespace

Convolution::Convolution(const OrientedPoints& source, double root_t, double tolerance)
    : tree_(yukawa_tree(source, leaf)),
      // At a sample itself the kernel is singular; there, its normal wins.
      scale_{static_cast<float>(1 / root_t), static_cast<float>(M_LOG2E / root_t),
             static_cast<float>(reach * root_t), static_cast<float>(1e-8 * root_t * root_t),
             static_cast<float>(tolerance)},
      sum_(yukawa_sum()) {}

Flow Convolution::operator()(const Vec3& x) const {
  Flow out;
  (*this)(&x, 1, &out);
  return out;
}

void Convolution::operator()(const Vec3* x, int n, Flow* out) const {
  constexpr int lanes = YukawaGroup::lanes, at_once = most_groups * lanes;
  std::array<YukawaGroup, most_groups> groups;
  std::vector<YukawaPart> room;
  for (int from = 0; from < n; from += at_once) {
    const int here = std::min(at_once, n - from), n_groups = (here + lanes - 1) / lanes;
    for (int i = 0; i < n_groups * lanes; ++i) {  // the last place fills its group
      const Eigen::Vector3f q = (x[from + std::min(i, here - 1)] - tree_.origin).cast<float>();
      YukawaGroup& group = groups[i / lanes];
      group.x[i % lanes] = q[0];
      group.y[i % lanes] = q[1];
      group.z[i % lanes] = q[2];
    }
    sum_(tree_, scale_, groups.data(), n_groups, room);
    for (int i = 0; i < here; ++i) {
      const YukawaGroup& group = groups[i / lanes];
      const int l = i % lanes;
      const Vec3 X(group.nx[l], group.ny[l], group.nz[l]);
      const double size = stable_length(X);
      Flow& flow = out[from + i];
      flow.distance = group.distance[l];
      // What is left of a sum that cancels is rounding.
      flow.direction = size > cancelled * group.total[l] ? Vec3(X / size) : Vec3::Zero();
    }
  }
}

}  // namespace littoral
