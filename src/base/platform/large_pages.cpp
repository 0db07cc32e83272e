#include "base/platform/large_pages.h"

#if defined(__linux__)
#include <sys/mman.h>
#endif

#include <cstdint>
#include <utility>

namespace littoral {

void prefer_large_pages([[maybe_unused]] void* begin, [[maybe_unused]] std::size_t bytes) {
#if defined(MADV_HUGEPAGE)
  void* first = begin;
  std::size_t room = bytes;
  if (std::align(large_page, large_page, first, room))
    (void)madvise(first, room / large_page * large_page, MADV_HUGEPAGE);  // small pages do as well
#endif
}

#if defined(__linux__)

namespace {

/// Memory from the system: none, or to be given back.
struct Mapping {
  void* at = nullptr;
  std::size_t bytes = 0;
};

void unmap(const Mapping& mapping) {
  if (mapping.at) munmap(mapping.at, mapping.bytes);
}

thread_local int keepers = 0;
thread_local Mapping spare;

}  // namespace

KeepLargePages::KeepLargePages() { ++keepers; }

KeepLargePages::~KeepLargePages() {
  if (--keepers == 0) unmap(std::exchange(spare, {}));
}

std::shared_ptr<void> large_pages(std::size_t bytes) {
  if (bytes < 2 * large_page) return nullptr;
  // So that it can begin where a large page does; what is to be kept has room for a little more.
  const std::size_t least = bytes + large_page, whole = least + (keepers > 0 ? bytes / 8 : 0);
  Mapping mapping = std::exchange(spare, {});
  const bool again = mapping.bytes >= least;
  if (!again) {
    unmap(mapping);
    mapping = {mmap(nullptr, whole, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0),
               whole};
    if (mapping.at == MAP_FAILED) return nullptr;
  }
  std::shared_ptr<void> all(mapping.at, [mapping](void*) {
    if (keepers == 0 || spare.bytes >= mapping.bytes)
      unmap(mapping);
    else
      unmap(std::exchange(spare, mapping));
  });
  const std::size_t into = std::size_t(-reinterpret_cast<std::uintptr_t>(mapping.at)) % large_page;
  void* const begin = static_cast<char*>(mapping.at) + into;
  if (!again) prefer_large_pages(begin, bytes);
  return {std::move(all), begin};
}

#else
std::shared_ptr<void> large_pages(std::size_t) { return nullptr; }
KeepLargePages::KeepLargePages() = default;
KeepLargePages::~KeepLargePages() = default;
#endif

}  // namespace littoral
