#include "solve/multigrid/held_grid.h"

#include "base/index.h"
#include "base/parallel.h"

namespace littoral {

HeldGrid::HeldGrid(std::array<int, 3> n, const Vec3& spacing, const Rows& A)
    : line_(n[0]),
      A_(A),
      poisson_(n, spacing),
      used_(index(n[1]) * n[2], 0),
      nodes_(index(n[0]) * n[1] * n[2]) {
  for (Eigen::Index i = 0; i < A.nonZeros(); ++i) used_[A.innerIndexPtr()[i] / line_] = 1;
}

/// A^T v on lines that are used; others may hold anything.
void HeldGrid::spread(const VecX& v) {
  parallel_for(used_.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t line = begin; line < end; ++line)
      if (used_[line] != 0) nodes_.segment(index(line) * line_, line_).setZero();
  });
  for (Eigen::Index r = 0; r < A_.rows(); ++r)
    for (Rows::InnerIterator it(A_, r); it; ++it)
      nodes_[it.col()] += static_cast<float>(it.value() * v[r]);
}

VecX HeldGrid::across(const VecX& v, const Task& task) {
  spread(v);
  task.checkpoint();
  poisson_.solve(nodes_, task, used_, used_);
  VecX out(A_.rows());
  parallel_for(out.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (Eigen::Index r = begin; r < index(end); ++r) {
      double sum = 0;
      for (Rows::InnerIterator it(A_, r); it; ++it) sum += it.value() * double(nodes_[it.col()]);
      out[r] = sum;
    }
  });
  return out;
}

void HeldGrid::subtract(VecX& x, const VecX& v, const Task& task) {
  spread(v);
  task.checkpoint();
  poisson_.solve(nodes_, task, used_);
  parallel_for(x.size(), 1 << 18, [&](std::size_t begin, std::size_t end) {
    task.checkpoint();
    const Eigen::Index n = index(end - begin);
    x.segment(index(begin), n) -= nodes_.segment(index(begin), n).cast<double>();
  });
}

}  // namespace littoral
