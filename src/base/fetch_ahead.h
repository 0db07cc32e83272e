#pragma once
// Memory asked for before it is needed.

namespace littoral {

/// Asks for the line of memory at `at`, which need not be readable. GCC takes a function that does
/// nothing but __builtin_prefetch for one without effect and drops its calls; the empty statement
/// keeps them.
inline void fetch_ahead(const void* at) {
  __builtin_prefetch(at);
  asm volatile("");
}

}  // namespace littoral
