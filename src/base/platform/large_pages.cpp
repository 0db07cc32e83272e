#include "base/platform/large_pages.h"

#if defined(__linux__)
#include <sys/mman.h>
#endif

#include <cstdint>
#include <utility>

namespace littoral {

#if defined(__linux__)
std::shared_ptr<void> large_pages(std::size_t bytes) {
  constexpr std::size_t page = std::size_t(1) << 21;
  if (bytes < 2 * page) return nullptr;
  const std::size_t whole = bytes + page;  // so that it can begin where a large page does
  void* const memory =
      mmap(nullptr, whole, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) return nullptr;
  std::shared_ptr<void> all(memory, [whole](void* at) { munmap(at, whole); });
  const std::size_t into = std::size_t(-reinterpret_cast<std::uintptr_t>(memory)) % page;
  void* const begin = static_cast<char*>(memory) + into;
#if defined(MADV_HUGEPAGE)
  (void)madvise(begin, bytes / page * page, MADV_HUGEPAGE);  // small pages do as well
#endif
  return {std::move(all), begin};
}
#else
std::shared_ptr<void> large_pages(std::size_t) { return nullptr; }
#endif

}  // namespace littoral
