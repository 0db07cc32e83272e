#pragma once
// How this thread's processor treats numbers below the normal range.

#include <cstdint>

namespace littoral {

/// Rounds subnormal numbers to zero on this thread, where the processor can. The factors of heat
/// matrices decay into the subnormal range, where arithmetic is several times slower and the digits
/// are worthless.
void flush_subnormals();

/// The calling thread's floating-point mode; 0 where there is none to know.
std::uint64_t floating_point_mode();

/// Takes over a mode that floating_point_mode() returned, perhaps on another thread.
void set_floating_point_mode(std::uint64_t mode);

/// Restores the calling thread's floating-point mode when it goes out of scope.
class FlushSubnormals {
 public:
  FlushSubnormals() : saved_(floating_point_mode()) { flush_subnormals(); }
  ~FlushSubnormals() { set_floating_point_mode(saved_); }
  FlushSubnormals(const FlushSubnormals&) = delete;
  FlushSubnormals& operator=(const FlushSubnormals&) = delete;

 private:
  std::uint64_t saved_;
};

}  // namespace littoral
