// Products of dense blocks and solves with triangles beside BLAS, where it is installed.
// usage: littoral_dense_speed [ROUNDS]
//
// Billion operations a second of one thread, the best of ROUNDS (5) by turns, with the sets of
// instructions that this processor has; the largest difference beside BLAS. OpenBLAS: set
// OPENBLAS_NUM_THREADS=1.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <random>
#include <type_traits>
#include <vector>

#include "littoral/types.h"
#include "solve/direct/dense_products.h"

#if LITTORAL_BENCH_BLAS
extern "C" {
#define LITTORAL_DECLARE(S, p, herk)                                                              \
  void p##gemm_(const char*, const char*, const int*, const int*, const int*, const S*, const S*, \
                const int*, const S*, const int*, const S*, S*, const int*);                      \
  void p##herk(const char*, const char*, const int*, const int*, const double*, const S*,         \
               const int*, const double*, S*, const int*);                                        \
  void p##trsm_(const char*, const char*, const char*, const char*, const int*, const int*,       \
                const S*, const S*, const int*, S*, const int*);
LITTORAL_DECLARE(double, d, syrk_)
LITTORAL_DECLARE(littoral::Complex, z, herk_)
#undef LITTORAL_DECLARE
}
#endif

namespace littoral::dense {
namespace {

#if LITTORAL_BENCH_BLAS
template <class Scalar>
struct Blas {
  static constexpr auto gemm = dgemm_;
  static constexpr auto herk = dsyrk_;
  static constexpr auto trsm = dtrsm_;
};
template <>
struct Blas<Complex> {
  static constexpr auto gemm = zgemm_;
  static constexpr auto herk = zherk_;
  static constexpr auto trsm = ztrsm_;
};
#endif

enum class Job { square, product, triangle };

template <class Scalar>
std::vector<Scalar> random_block(int m, int n, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(-1, 1);
  std::vector<Scalar> block(std::size_t(m) * n);
  for (Scalar& x : block)
    if constexpr (std::is_same_v<Scalar, double>)
      x = u(random);
    else
      x = Scalar(u(random), u(random));
  return block;
}

double seconds_of(int repeats, const std::function<void()>& call) {
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < repeats; ++i) call();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() / repeats;
}

/// C := C - A A^*, lower part, m x m by k; C := C - A B^*, m x n by k; or B := B L^-*, m x n.
template <class Scalar>
void measure(Job job, int m, int n, int k, int rounds) {
  const double numbers = std::is_same_v<Scalar, double> ? 1 : 4;
  const double operations = job == Job::square    ? double(m) * m * k
                            : job == Job::product ? 2.0 * m * n * k
                                                  : double(m) * n * n;
  const int inner = job == Job::triangle ? n : k, rows = job == Job::triangle ? n : std::max(m, n);
  std::vector<Scalar> A = random_block<Scalar>(rows, inner, 1),
                      B = random_block<Scalar>(n, inner, 2);
  if (job == Job::triangle)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
        A[i + std::size_t(j) * n] = i == j ? 1.0 : A[i + std::size_t(j) * n] / double(n);
  const std::vector<Scalar> start = random_block<Scalar>(m, n, 3);
  std::vector<Scalar> C;
  const auto ours = [&](Instructions allowed) {
    if (job == Job::triangle)
      solve_right<Scalar>(m, n, A.data(), n, C.data(), m, allowed);
    else if (job == Job::square)
      subtract_product<Scalar>(m, m, k, {A.data(), 1, m}, {A.data(), m, 1, true}, C.data(), m,
                               {.lower = true, .allowed = allowed});
    else
      subtract_product<Scalar>(m, n, k, {A.data(), 1, rows}, {B.data(), n, 1, true}, C.data(), m,
                               {.allowed = allowed});
  };
  std::vector<std::function<void()>> ways{[&] { ours(Instructions::plain); },
                                          [&] { ours(Instructions::avx2); },
                                          [&] { ours(Instructions::any); }};
#if LITTORAL_BENCH_BLAS
  const Scalar one = 1, minus = -1;
  const double minus_real = -1, one_real = 1;
  ways.push_back([&] {
    if (job == Job::triangle)
      Blas<Scalar>::trsm("R", "L", "C", "N", &m, &n, &one, A.data(), &n, C.data(), &m);
    else if (job == Job::square)
      Blas<Scalar>::herk("L", "N", &m, &k, &minus_real, A.data(), &m, &one_real, C.data(), &m);
    else
      Blas<Scalar>::gemm("N", "C", &m, &n, &k, &minus, A.data(), &rows, B.data(), &n, &one,
                         C.data(), &m);
  });
#endif
  const int repeats = std::max(1, int(2e8 / (numbers * operations)));
  std::vector<double> best(ways.size(), 1e9);
  std::vector<std::vector<Scalar>> answers(ways.size());
  for (int round = 0; round < rounds; ++round)
    for (std::size_t w = 0; w < ways.size(); ++w) {
      C = start;
      ways[w]();
      answers[w] = C;
      best[w] = std::min(best[w], seconds_of(repeats, [&] {
                           if (job == Job::triangle) C = start;
                           ways[w]();
                         }));
    }
  double differ = 0;
  for (std::size_t i = 0; i < start.size(); ++i)
    differ = std::max(differ, std::abs(answers.back()[i] - answers[2][i]));
  const char* name[] = {"square", "product", "triangle"};
  std::printf("| %s, %s | %d x %d | %d |", name[int(job)],
              std::is_same_v<Scalar, double> ? "real" : "complex", m, n, inner);
  for (const double seconds : best) std::printf(" %.1f |", 1e-9 * numbers * operations / seconds);
  std::printf(" %.1e |\n", differ);
}

}  // namespace
}  // namespace littoral::dense

int main(int argc, char** argv) {
  using namespace littoral;
  using dense::Job;
  const int rounds = argc > 1 ? std::max(1, std::atoi(argv[1])) : 5;
  std::printf(
      "| job | size | depth | plain | AVX2 | best |%s differ |\n|---|---|---|---|---|---|%s---|\n",
      LITTORAL_BENCH_BLAS ? " BLAS |" : "", LITTORAL_BENCH_BLAS ? "---|" : "");
  struct Size {
    Job job;
    int m, n, k;
  };
  for (const auto& [job, m, n, k] :
       {Size{Job::square, 128, 128, 24}, Size{Job::square, 128, 128, 128},
        Size{Job::square, 512, 512, 24}, Size{Job::square, 512, 512, 128},
        Size{Job::product, 1000, 100, 128}, Size{Job::product, 1000, 1000, 256},
        Size{Job::triangle, 100, 60, 0}, Size{Job::triangle, 1000, 128, 0}}) {
    dense::measure<double>(job, m, n, k, rounds);
    dense::measure<Complex>(job, m, n, k, rounds);
  }
}
