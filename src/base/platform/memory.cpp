#include "base/platform/memory.h"

#if defined(__EMSCRIPTEN__)
#include <emscripten/heap.h>
#include <malloc.h>
#else
#include <sys/resource.h>
#endif
#if defined(__GLIBC__)
#include <malloc.h>
#endif

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <utility>

#include "base/option_table.h"
#include "littoral/error.h"

namespace littoral {

namespace {

#if !defined(__EMSCRIPTEN__)
/// Bytes at a line "key: kilobytes kB" of a file of the system, or `otherwise`.
double bytes_at(const char* file, const std::string& line, double otherwise) {
  std::ifstream info(file);
  for (std::string key; info >> key;) {
    double kilobytes = 0;
    if (key == line && info >> kilobytes) return 1024 * kilobytes;
    info.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  }
  return otherwise;
}
#endif

thread_local double limit_of_thread = 0;
constexpr const char* too_large = "too-large";

}  // namespace

void set_memory_limit(double bytes) { limit_of_thread = bytes; }
double memory_limit() { return limit_of_thread; }

void return_freed_memory() {
#if defined(__GLIBC__)
#if __GLIBC_PREREQ(2, 33)
  // Pages take long to come again: what is soon asked for anyway is kept.
  constexpr std::size_t kept = std::size_t(1) << 28;
  if (mallinfo2().fordblks < kept) return;
#endif
  malloc_trim(0);
#endif
}

#if defined(__EMSCRIPTEN__)

double peak_memory() { return static_cast<double>(emscripten_get_heap_size()); }
double writable_memory() { return 0; }

double available_memory() {
  return static_cast<double>(emscripten_get_heap_max()) -
         static_cast<double>(static_cast<unsigned>(mallinfo().uordblks));
}

#else

double peak_memory() { return bytes_at("/proc/self/status", "VmHWM:", 0); }
double writable_memory() { return bytes_at("/proc/self/status", "VmData:", 0); }

double available_memory() {
  double bytes = bytes_at("/proc/meminfo", "MemAvailable:", std::numeric_limits<double>::max());
  for (const auto& [resource, used] :
       {std::pair(RLIMIT_AS, "VmSize:"), std::pair(RLIMIT_DATA, "VmData:")}) {
    rlimit limit{};
    if (getrlimit(resource, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
      bytes = std::min(
          bytes, static_cast<double>(limit.rlim_cur) - bytes_at("/proc/self/status", used, 0));
  }
  return std::max(0.0, bytes);
}

#endif

double memory_to_use() {
  return limit_of_thread > 0 ? std::min(limit_of_thread, available_memory()) : available_memory();
}

void check_memory(double bytes, const std::string& what, const std::string& remedy) {
  const double available = memory_to_use();
  if (bytes <= available) return;
  const auto gigabytes = [](double x) { return number_text(std::round(x / 1e8) / 10) + " GB"; };
  throw IoError(what + " needs about " + gigabytes(bytes) + " of memory, " + gigabytes(available) +
                    " are available; " + remedy,
                too_large);
}

bool is_about_memory(const IoError& error) { return error.code() == too_large; }

}  // namespace littoral
