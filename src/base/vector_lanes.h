#pragma once
// Lanes as the compiler's own vectors, of as many as a register holds.

#include <cstdint>

namespace littoral {

/// Comparisons of `Lanes` give masks of all bits, as `Bits`.
template <int width>
struct Wide;
template <>
struct Wide<2> {
  using Lanes = double __attribute__((vector_size(16)));
  using Bits = std::int64_t __attribute__((vector_size(16)));
};
template <>
struct Wide<4> {
  using Lanes = double __attribute__((vector_size(32)));
  using Bits = std::int64_t __attribute__((vector_size(32)));
};
template <>
struct Wide<8> {
  using Lanes = double __attribute__((vector_size(64)));
  using Bits = std::int64_t __attribute__((vector_size(64)));
};

/// The same of single precision.
template <int width>
struct WideFloats;
template <>
struct WideFloats<4> {
  using Lanes = float __attribute__((vector_size(16)));
  using Bits = std::int32_t __attribute__((vector_size(16)));
};
template <>
struct WideFloats<8> {
  using Lanes = float __attribute__((vector_size(32)));
  using Bits = std::int32_t __attribute__((vector_size(32)));
};

template <class Lanes, class Scalar>
[[gnu::always_inline]] inline void load(Lanes& to, const Scalar* from) {
  __builtin_memcpy(&to, from, sizeof to);
}
template <class Lanes, class Scalar>
[[gnu::always_inline]] inline void store(Scalar* to, const Lanes& from) {
  __builtin_memcpy(to, &from, sizeof from);
}

/// Is a bit set? By whole words, which takes few instructions.
template <class Bits>
[[gnu::always_inline]] inline bool any(const Bits& bits) {
  std::uint64_t word[sizeof(Bits) / 8], all = 0;
  store(word, bits);
  for (const std::uint64_t w : word) all |= w;
  return all != 0;
}

/// Of two numbers, by value: loops of these become vector instructions.
template <class S>
[[gnu::always_inline]] inline S smaller(S a, S b) {
  return a < b ? a : b;
}
template <class S>
[[gnu::always_inline]] inline S larger(S a, S b) {
  return a > b ? a : b;
}

/// The same of lanes, which become the smaller or larger ones.
template <class Lanes>
[[gnu::always_inline]] inline void take_smaller(Lanes& a, const Lanes& b) {
  a = a < b ? a : b;
}
template <class Lanes>
[[gnu::always_inline]] inline void take_larger(Lanes& a, const Lanes& b) {
  a = a > b ? a : b;
}

}  // namespace littoral
