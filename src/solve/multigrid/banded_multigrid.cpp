#include "solve/multigrid/banded_multigrid.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/index.h"
#include "base/parallel.h"
#include "base/parallel_sum.h"
#include "base/thread_crew.h"
#include "littoral/error.h"

namespace littoral {

namespace {

constexpr int band_width = 4;  // neighbours of neighbours of ... the stiff unknowns
constexpr int max_iterations = 500;

constexpr std::size_t numbers_at_once = 1 << 15;

/// a . b, the same for any number of threads.
double dot(const VecX& a, const VecX& b) {
  return of_pieces(std::size_t(a.size()), numbers_at_once, 0.0, [&](auto begin, auto end) {
    const auto first = index(begin), size = index(end - begin);
    return a.segment(first, size).dot(b.segment(first, size));
  });
}

/// The unknowns within some steps of the given ones, ascending.
std::vector<int> around(const SpRows& A, const std::vector<int>& from, int steps) {
  std::vector<char> seen(A.rows(), 0);
  std::vector<int> out = from;
  for (int i : out) seen[i] = 1;
  for (std::size_t begin = 0; steps-- > 0;) {
    const std::size_t end = out.size();
    for (; begin < end; ++begin)
      for (SpRows::InnerIterator it(A, out[begin]); it; ++it)
        if (!seen[it.col()]) {
          seen[it.col()] = 1;
          out.push_back(it.col());
        }
  }
  std::sort(out.begin(), out.end());
  return out;
}

SpMat lower_block(const SpRows& A, const std::vector<int>& unknowns) {
  std::vector<int> local(A.rows(), -1);
  for (std::size_t k = 0; k < unknowns.size(); ++k) local[unknowns[k]] = k;
  const Eigen::Index n = unknowns.size();
  Triplets entries;
  for (int i : unknowns)
    for (SpRows::InnerIterator it(A, i); it && it.col() <= i; ++it)
      if (local[it.col()] >= 0) entries.emplace_back(local[i], local[it.col()], it.value());
  SpMat block(n, n);
  block.setFromTriplets(entries.begin(), entries.end());
  return block;
}

}  // namespace

BandedMultigrid::BandedMultigrid(SpMat&& lower, const std::vector<int>& stiff, const Task& task)
    : multigrid_(std::move(lower), task) {
  if (stiff.empty()) return;
  band_ = around(multigrid_.matrix(), stiff, band_width);
  band_factor_ = factor_for_preconditioning(lower_block(multigrid_.matrix(), band_), task);
}

double BandedMultigrid::nonzeros() const {
  return multigrid_.nonzeros() + (band_factor_ ? band_factor_->nonzeros() : 0);
}

void BandedMultigrid::precondition(const VecX& b, VecX& x, Work& work, const Task& task) const {
  if (band_.empty()) {
    multigrid_.cycle(b, x, work.cycle, task);
    return;
  }
  const SpRows& A = multigrid_.matrix();
  VecX& in_band = work.in_band;
  in_band.resize(index(band_.size()));
  for (std::size_t k = 0; k < band_.size(); ++k) in_band[k] = b[band_[k]];
  VecX dx = band_factor_->solve(in_band);
  work.r = b;
  for (std::size_t k = 0; k < band_.size(); ++k)
    for (SpRows::InnerIterator it(A, band_[k]); it; ++it) work.r[it.col()] -= it.value() * dx[k];
  multigrid_.cycle(work.r, x, work.cycle, task);
  x(band_) += dx;
  for (std::size_t k = 0; k < band_.size(); ++k) {
    double sum = b[band_[k]];
    for (SpRows::InnerIterator it(A, band_[k]); it; ++it) sum -= it.value() * x[it.col()];
    in_band[k] = sum;
  }
  x(band_) += band_factor_->solve(in_band);
}

VecX BandedMultigrid::solve(VecX b, double tolerance, const Task& task, Report& report) const {
  const KeepThreads keep_threads;  // loops as short as a level is small
  const SpRows& A = multigrid_.matrix();
  VecX x = VecX::Zero(b.size());
  if (!(b.cwiseAbs().maxCoeff() > 0)) return x;
  Work work;
  VecX &r = b, &Ap = work.r;  // few vectors: each of a hundred million faces has 0.4 GB
  VecX z, p;
  precondition(r, z, work, task);
  p = z;
  double rz = dot(r, z);
  const double start = rz, enough = tolerance * tolerance * start;
  int step = 0;
  for (; step < max_iterations && rz > enough; ++step) {
    task.checkpoint(std::clamp(std::log(start / rz) / std::log(start / enough), 0.0, 1.0));
    multiply(A, p, Ap, task);
    const double curvature = dot(p, Ap);
    if (!(curvature > 0)) break;
    const double along = rz / curvature;
    parallel_for(std::size_t(x.size()), numbers_at_once, [&](std::size_t begin, std::size_t end) {
      for (Eigen::Index i = index(begin); i < index(end); ++i) {
        x[i] += along * p[i];
        r[i] -= along * Ap[i];
      }
    });
    precondition(r, z, work, task);
    const double before = rz;
    rz = dot(r, z);
    const double keep = rz / before;
    parallel_for(std::size_t(p.size()), numbers_at_once, [&](std::size_t begin, std::size_t end) {
      for (Eigen::Index i = index(begin); i < index(end); ++i) p[i] = z[i] + keep * p[i];
    });
  }
  report.iterations.emplace_back("multigrid", step);
  if (!x.allFinite()) throw SolveError("the solution of a linear system is not finite");
  if (!(rz <= enough)) report.status = "not converged";
  return x;
}

}  // namespace littoral
