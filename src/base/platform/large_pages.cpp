#include "base/platform/large_pages.h"

#if defined(__linux__)
#include <sys/mman.h>
#endif

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

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

/// Memory from the system, to be given back.
struct Range {
  char *begin, *end;
  std::size_t bytes() const { return end - begin; }
};

void unmap(const Range& range) { munmap(range.begin, range.bytes()); }

char* at_large_page(char* at) {
  return at + std::size_t(-reinterpret_cast<std::uintptr_t>(at)) % large_page;
}

/// What is kept, by all threads: who takes it need not be who gave it back.
struct Kept {
  std::mutex mutex;  // of all that follows
  int keepers = 0;
  std::vector<Range> spare;  // ascending, with gaps between
};

Kept& kept() {
  static auto* const all = new Kept;  // outlives what gives back at the end of the program
  return *all;
}

/// Of the smallest spare range that holds so many bytes. Where there is none, the largest makes
/// room for one that has to come from the system.
std::optional<Range> take_spare(std::size_t bytes) {
  const std::lock_guard lock(kept().mutex);
  std::vector<Range>& spare = kept().spare;
  const auto holds = [&](const Range& r) {
    return at_large_page(r.begin) <= r.end && std::size_t(r.end - at_large_page(r.begin)) >= bytes;
  };
  const auto best =
      std::min_element(spare.begin(), spare.end(), [&](const Range& r, const Range& q) {
        if (holds(r) && holds(q)) return r.bytes() < q.bytes();
        return holds(r) == holds(q) ? r.bytes() > q.bytes() : holds(r);
      });
  if (best == spare.end()) return std::nullopt;
  if (!holds(*best)) {
    unmap(*best);
    spare.erase(best);
    return std::nullopt;
  }
  const Range taken = {best->begin,
                       std::min(best->end, at_large_page(at_large_page(best->begin) + bytes))};
  if (taken.end < best->end)
    best->begin = taken.end;
  else
    spare.erase(best);
  return taken;
}

void give_back(Range range) {
  const std::lock_guard lock(kept().mutex);
  if (kept().keepers == 0) {
    unmap(range);
    return;
  }
  std::vector<Range>& spare = kept().spare;
  auto next = std::find_if(spare.begin(), spare.end(),
                           [&](const Range& r) { return r.begin >= range.end; });
  if (next != spare.end() && next->begin == range.end) {
    range.end = next->end;
    next = spare.erase(next);
  }
  if (next != spare.begin() && std::prev(next)->end == range.begin)
    std::prev(next)->end = range.end;
  else
    spare.insert(next, range);
}

bool keeping() {
  const std::lock_guard lock(kept().mutex);
  return kept().keepers > 0;
}

}  // namespace

KeepLargePages::KeepLargePages() {
  const std::lock_guard lock(kept().mutex);
  ++kept().keepers;
}

KeepLargePages::~KeepLargePages() {
  const std::lock_guard lock(kept().mutex);
  if (--kept().keepers > 0) return;
  for (const Range& range : std::exchange(kept().spare, {})) unmap(range);
}

std::shared_ptr<void> large_pages(std::size_t bytes) {
  if (bytes < 2 * large_page) return nullptr;
  std::optional<Range> range = take_spare(bytes);
  const bool again = range.has_value();
  if (!again) {
    // So that it can begin where a large page does; what is kept has room for a little more.
    const std::size_t whole = bytes + large_page + (keeping() ? bytes / 8 : 0);
    void* const at =
        mmap(nullptr, whole, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (at == MAP_FAILED) return nullptr;
    range = {static_cast<char*>(at), static_cast<char*>(at) + whole};
  }
  char* const begin = at_large_page(range->begin);
  if (!again) prefer_large_pages(begin, std::size_t(range->end - begin));
  return {std::shared_ptr<void>(begin, [mine = *range](void*) { give_back(mine); }), begin};
}

#else
std::shared_ptr<void> large_pages(std::size_t) { return nullptr; }
KeepLargePages::KeepLargePages() = default;
KeepLargePages::~KeepLargePages() = default;
#endif

}  // namespace littoral
