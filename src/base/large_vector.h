#pragma once
// Vectors that are not cleared before they are filled, and such that lie in large pages of memory
// where the system has them.

#include <algorithm>
#include <cstddef>
#include <memory>
#include <new>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "base/platform/large_pages.h"

namespace littoral {

/// Without a value, what is plain stays as it comes: the threads that fill it are to touch it.
struct ConstructedAsItComes {
  template <class U>
  void construct(U* at) {
    ::new (static_cast<void*>(at)) U;
  }
  template <class U, class... Args>
  void construct(U* at, Args&&... args) {
    std::construct_at(at, std::forward<Args>(args)...);
  }
};

template <class T>
struct UnclearedAllocator : ConstructedAsItComes {
  using value_type = T;
  UnclearedAllocator() = default;
  template <class U>
  UnclearedAllocator(const UnclearedAllocator<U>&) {}  // NOLINT(google-explicit-constructor)

  T* allocate(std::size_t n) { return std::allocator<T>().allocate(n); }
  void deallocate(T* begin, std::size_t n) { std::allocator<T>().deallocate(begin, n); }
  bool operator==(const UnclearedAllocator&) const { return true; }
};

template <class T>
using UnclearedVector = std::vector<T, UnclearedAllocator<T>>;

/// What is large begins where a large page does.
template <class T>
struct LargePageAllocator : ConstructedAsItComes {
  using value_type = T;
  LargePageAllocator() = default;
  template <class U>
  LargePageAllocator(const LargePageAllocator<U>&) {}  // NOLINT(google-explicit-constructor)

  T* allocate(std::size_t n) {
    void* const begin = ::operator new(n * sizeof(T), alignment(n));
    if (is_large(n)) prefer_large_pages(begin, n * sizeof(T));
    return static_cast<T*>(begin);
  }
  void deallocate(T* begin, std::size_t n) { ::operator delete(begin, alignment(n)); }
  bool operator==(const LargePageAllocator&) const { return true; }

 private:
  static bool is_large(std::size_t n) { return n >= 2 * large_page / sizeof(T); }
  static std::align_val_t alignment(std::size_t n) {
    return std::align_val_t(is_large(n) ? large_page : std::max<std::size_t>(alignof(T), 16));
  }
};

/// For what is read here and there.
template <class T>
using LargeVector = std::vector<T, LargePageAllocator<T>>;

/// Makes room for n, which all threads touch: pages take long to come where one alone asks for
/// them.
template <class T>
void reserve_together(LargeVector<T>& vector, std::size_t n) {
  constexpr std::size_t page = 4096, grain = large_page / page;
  vector.reserve(n);
  auto* const begin = reinterpret_cast<volatile char*>(vector.data());
  parallel_for(n * sizeof(T) / page, grain, [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i) begin[i * page] = 0;
  });
}

}  // namespace littoral
