#pragma once
// Kernels are written once and compiled for two instruction sets; the processor that runs the
// program chooses.

/// The first for every processor; the second where it has AVX2, on others not even compiled. Both
/// give the same bits: without fused multiply-add, which rounds otherwise.
#if defined(__x86_64__)
#define LITTORAL_FASTEST(plain, avx2) (__builtin_cpu_supports("avx2") ? (avx2) : (plain))
#else
#define LITTORAL_FASTEST(plain, avx2) (plain)
#endif
