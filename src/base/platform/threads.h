#pragma once
// Threads of this system.

namespace littoral {

/// Can threads be started?
#if defined(__EMSCRIPTEN__) && !defined(__EMSCRIPTEN_PTHREADS__)
inline constexpr bool has_threads = false;
#else
inline constexpr bool has_threads = true;
#endif

}  // namespace littoral
