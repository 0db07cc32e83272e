#include "base/platform/floating_point.h"

#if defined(__SSE2__) && !defined(__EMSCRIPTEN__)
#include <xmmintrin.h>
#endif

namespace littoral {

#if defined(__SSE2__) && !defined(__EMSCRIPTEN__)

std::uint64_t floating_point_mode() { return _mm_getcsr(); }

void set_floating_point_mode(std::uint64_t mode) { _mm_setcsr(static_cast<unsigned>(mode)); }

void flush_subnormals() {
  constexpr std::uint64_t ftz_and_daz = 0x8040;
  set_floating_point_mode(floating_point_mode() | ftz_and_daz);
}

#elif defined(__aarch64__)

std::uint64_t floating_point_mode() {
  std::uint64_t mode = 0;
  asm volatile("mrs %0, fpcr" : "=r"(mode));
  return mode;
}

void set_floating_point_mode(std::uint64_t mode) { asm volatile("msr fpcr, %0" : : "r"(mode)); }

void flush_subnormals() {
  constexpr std::uint64_t flush_to_zero = std::uint64_t{1} << 24;
  set_floating_point_mode(floating_point_mode() | flush_to_zero);
}

#else

std::uint64_t floating_point_mode() { return 0; }
void set_floating_point_mode(std::uint64_t) {}
void flush_subnormals() {}

#endif

}  // namespace littoral
