#pragma once
// Kernels are written once and compiled for two instruction sets; the processor that runs the
// program chooses.

#include <algorithm>

/// The first for every processor; the second where it has AVX2, on others not even compiled. Both
/// give the same bits: without fused multiply-add, which rounds otherwise.
#if defined(__x86_64__)
#define LITTORAL_FASTEST(plain, avx2) (__builtin_cpu_supports("avx2") ? (avx2) : (plain))
#else
#define LITTORAL_FASTEST(plain, avx2) (plain)
#endif

/// Of some kernels a third one, with vectors of eight doubles, is faster still. Compilers use half
/// of these registers unless told.
#if defined(__x86_64__)
#if defined(__clang__)
#define LITTORAL_AVX512 "avx512f,avx512dq,avx512vl"
#else
#define LITTORAL_AVX512 "avx512f,avx512dq,avx512vl,prefer-vector-width=512"
#endif
#define LITTORAL_HAS_AVX512 \
  (__builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
#endif

namespace littoral {

/// What a processor may be asked for: tests compare the ways that this one has.
enum class Instructions { plain, avx2, any };

/// The most of what is allowed that this processor has together with fused multiply-add; `any`:
/// AVX-512.
inline Instructions fused_instructions([[maybe_unused]] Instructions allowed = Instructions::any) {
#if defined(__x86_64__)
  static const Instructions has = !__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")
                                      ? Instructions::plain
                                  : LITTORAL_HAS_AVX512 ? Instructions::any
                                                        : Instructions::avx2;
  return std::min(has, allowed);
#else
  return Instructions::plain;
#endif
}

}  // namespace littoral
