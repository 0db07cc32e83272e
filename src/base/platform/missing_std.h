#pragma once
// What the library uses of C++20's standard library and libc++ 13, which emscripten 3.1 has, lacks.
// Included ahead of every file by that build (cmake/web.cmake) and by no other.

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <compare>
#include <functional>
#include <iterator>
#include <type_traits>

#if _LIBCPP_VERSION < 14000

namespace std {

template <class To, class From>
constexpr To bit_cast(const From& from) noexcept {
  return __builtin_bit_cast(To, from);
}

from_chars_result from_chars(const char* first, const char* last, double& value);
from_chars_result from_chars(const char* first, const char* last, float& value);
/// The shortest text that reads as the same number.
to_chars_result to_chars(char* first, char* last, double value);

/// Lexicographic.
template <class T, size_t n>
constexpr auto operator<=>(const array<T, n>& a, const array<T, n>& b) {
  using Order = decltype(a[0] <=> b[0]);
  for (size_t k = 0; k < n; ++k)
    if (const Order order = a[k] <=> b[k]; order != 0) return order;
  return Order(strong_ordering::equal);
}

namespace ranges {

template <class R, class T, class P = identity>
constexpr auto find(R&& range, const T& value, P of = {}) {
  return std::find_if(std::begin(range), std::end(range),
                      [&](auto&& x) { return std::invoke(of, x) == value; });
}
template <class R, class Test>
constexpr auto find_if(R&& range, Test test) {
  return std::find_if(std::begin(range), std::end(range), test);
}
template <class R, class Test>
constexpr bool any_of(R&& range, Test test) {
  return std::any_of(std::begin(range), std::end(range), test);
}
template <class R, class Test>
constexpr bool all_of(R&& range, Test test) {
  return std::all_of(std::begin(range), std::end(range), test);
}
template <class R, class Test>
constexpr bool none_of(R&& range, Test test) {
  return std::none_of(std::begin(range), std::end(range), test);
}
template <class A, class B>
constexpr bool equal(A&& a, B&& b) {
  return std::equal(std::begin(a), std::end(a), std::begin(b), std::end(b));
}
template <class R>
constexpr auto max_element(R&& range) {
  return std::max_element(std::begin(range), std::end(range));
}
template <class R>
constexpr auto min_element(R&& range) {
  return std::min_element(std::begin(range), std::end(range));
}

}  // namespace ranges
}  // namespace std

#endif
