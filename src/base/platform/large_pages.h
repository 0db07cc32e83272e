#pragma once
// Memory in pages so large that going through it seldom waits for the address of the next.

#include <cstddef>
#include <memory>

namespace littoral {

constexpr std::size_t large_page = std::size_t(1) << 21;  // bytes

/// Memory shall come in large pages as it is touched, where it holds whole ones.
void prefer_large_pages(void* begin, std::size_t bytes);

/// Memory that the system hands out as it is touched, in large pages where it has them; null where
/// it is too little for that to pay, or the system has no such memory. What is in it is left from
/// before where memory is kept, or zero.
std::shared_ptr<void> large_pages(std::size_t bytes);

/// While any lives, what is given back is handed out again: pages of the system take longer to come
/// than to be zeroed.
class KeepLargePages {
 public:
  KeepLargePages();
  ~KeepLargePages();
  KeepLargePages(const KeepLargePages&) = delete;
  KeepLargePages& operator=(const KeepLargePages&) = delete;
};

}  // namespace littoral
