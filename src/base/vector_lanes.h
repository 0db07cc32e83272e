#pragma once
// Lanes as the compiler's own vectors, of as many as a register holds.

#include <cstdint>
#include <type_traits>

namespace littoral {

/// Comparisons of `Lanes` give masks of all bits, as `Bits`.
template <int width, class Real = double>
struct Wide {
  using Word = std::conditional_t<sizeof(Real) == 8, std::int64_t, std::int32_t>;
  using Lanes [[gnu::vector_size(width * sizeof(Real))]] = Real;
  using Bits [[gnu::vector_size(width * sizeof(Real))]] = Word;
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
