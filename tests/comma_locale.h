#pragma once
// Programs that use the library may write decimals with a comma.

#include <clocale>
#include <string>

namespace littoral::test {

/// As long as it lives, C's functions for numbers have a comma for the decimal point, where the
/// system has such a locale.
class CommaLocale {
 public:
  CommaLocale() {
    for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "de_DE", "fr_FR.UTF-8", "fr_FR.utf8"})
      if (std::setlocale(LC_NUMERIC, name) != nullptr) break;
  }
  ~CommaLocale() { std::setlocale(LC_NUMERIC, before_.c_str()); }
  CommaLocale(const CommaLocale&) = delete;
  CommaLocale& operator=(const CommaLocale&) = delete;

  static bool there() { return std::string(std::localeconv()->decimal_point) == ","; }

 private:
  std::string before_ = std::setlocale(LC_NUMERIC, nullptr);
};

constexpr const char* no_comma_locale = "the system has no locale with decimal commas";

}  // namespace littoral::test
