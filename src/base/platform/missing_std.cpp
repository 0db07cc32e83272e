#if defined(__EMSCRIPTEN__)

#include "base/platform/missing_std.h"

#include <fast_float/fast_float.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#if _LIBCPP_VERSION < 14000

namespace std {

namespace {

/// Has a number that was read a digit other than 0 in front of its exponent?
bool has_digit(const char* first, const char* last) {
  for (; first != last && *first != 'e' && *first != 'E'; ++first)
    if (*first >= '1' && *first <= '9') return true;
  return false;
}

/// Is it digits, or the word for what is not finite?
bool is_word(const char* first, const char* last) {
  if (first != last && *first == '-') ++first;
  return first != last && ((*first | 0x20) == 'i' || (*first | 0x20) == 'n');
}

to_chars_result copied(char* first, char* last, const string& text) {
  if (last - first < static_cast<ptrdiff_t>(text.size())) return {last, errc::value_too_large};
  memcpy(first, text.data(), text.size());
  return {first + text.size(), errc{}};
}

template <class T>
from_chars_result number_from_chars(const char* first, const char* last, T& value) {
  T read = 0;
  const auto [end, code] = fast_float::from_chars(first, last, read);
  if (code != errc{}) return {end, code};
  const bool too_large = isinf(read) && !is_word(first, end);
  const bool too_small = read == 0 && has_digit(first, end);
  if (too_large || too_small) return {end, errc::result_out_of_range};
  value = read;
  return {end, errc{}};
}

}  // namespace

from_chars_result from_chars(const char* first, const char* last, double& value) {
  return number_from_chars(first, last, value);
}
from_chars_result from_chars(const char* first, const char* last, float& value) {
  return number_from_chars(first, last, value);
}

to_chars_result to_chars(char* first, char* last, double value) {
  if (isnan(value)) return copied(first, last, signbit(value) ? "-nan" : "nan");
  if (isinf(value)) return copied(first, last, value < 0 ? "-inf" : "inf");
  const string sign = signbit(value) ? "-" : "";
  if (value == 0) return copied(first, last, sign + "0");
  // Fifteen digits always come back from a double, so fewer are these without zeros at their end.
  char text[40];
  for (int length = 15; length <= 17; ++length) {
    snprintf(text, sizeof text, "%.*e", length - 1, abs(value));
    if (strtod(text, nullptr) == abs(value)) break;
  }
  const char* const e = strchr(text, 'e');
  const int exponent = atoi(e + 1);
  string digits(1, text[0]);
  digits.append(text + 2, static_cast<size_t>(e - text) - 2);
  digits.erase(digits.find_last_not_of('0') + 1);
  const int n = static_cast<int>(digits.size());
  string power = to_string(abs(exponent));
  if (power.size() < 2) power.insert(0, "0");
  const string scientific = digits.substr(0, 1) + (n > 1 ? "." + digits.substr(1) : "") +
                            (exponent < 0 ? "e-" : "e+") + power;
  string fixed;
  if (exponent < 0) {
    fixed = "0." + string(static_cast<size_t>(-exponent - 1), '0') + digits;
  } else if (n > exponent + 1) {
    fixed = digits.substr(0, static_cast<size_t>(exponent) + 1) + "." +
            digits.substr(static_cast<size_t>(exponent) + 1);
  } else {
    // A whole number, all of whose digits are written; large ones are shorter with an exponent.
    if (exponent > 30) return copied(first, last, sign + scientific);
    snprintf(text, sizeof text, "%.0f", abs(value));
    fixed = text;
  }
  return copied(first, last, sign + (fixed.size() <= scientific.size() ? fixed : scientific));
}

}  // namespace std

#endif
#endif
