#include "cli/input/numbers.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "base/option_table.h"
#include "littoral/error.h"

namespace littoral::cli {

namespace {

/// "05" of "0,05", which was meant as one number; nobody writes a number so.
bool begins_with_extra_zero(std::string_view number) {
  if (number.starts_with('-')) number.remove_prefix(1);
  return number.size() > 1 && number[0] == '0' && number[1] >= '0' && number[1] <= '9';
}

/// "5mm": a number and a unit.
bool has_unit(std::string_view text) {
  const std::size_t unit = text.find_first_not_of("+-.0123456789 ");
  constexpr std::array<std::string_view, 8> units = {"mm", "cm", "m", "km", "in", "ft", "um", "\""};
  return unit > 0 && unit != std::string_view::npos &&
         std::ranges::find(units, text.substr(unit)) != units.end();
}

/// What is said of a list that has twice as many numbers as it should.
std::string comma_hint(std::size_t found, std::size_t expected) {
  return ", found " + std::to_string(found) +
         (found == 2 * expected ? "; decimals stand behind a point" : "");
}

}  // namespace

std::vector<double> parse_numbers(const std::string& option, const std::string& text) {
  std::vector<double> out;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const char *first = text.data() + begin, *last = text.data() + end;
    double value = 0;
    const auto [stop, code] = std::from_chars(first, last, value);
    if (code != std::errc() || stop != last || !std::isfinite(value))
      throw InputError(
          "option " + option + ": '" + std::string(first, last) + "' is not a finite number" +
              (std::string_view(first, last).ends_with('%') ? ", and this one takes no per cent"
               : has_unit({first, last}) ? "; lengths have no unit but that of the input"
                                         : ""),
          "option-value");
    if (begins_with_extra_zero({first, last}))
      throw InputError("option " + option + ": '" + std::string(first, last) +
                           "' begins with 0; commas separate numbers, and decimals stand behind a "
                           "point, as in 0." +
                           std::string(first, last),
                       "option-value");
    out.push_back(value);
    begin = end + 1;
  }
  return out;
}

double parse_number(const std::string& option, const std::string& text) {
  const std::vector<double> numbers = parse_numbers(option, text);
  if (numbers.size() != 1)
    throw InputError("option " + option + " takes one number" + comma_hint(numbers.size(), 1),
                     "option-value");
  return numbers.front();
}

Vec3 parse_position(const std::string& option, const std::string& text) {
  const std::vector<double> numbers = parse_numbers(option, text);
  if (numbers.size() != 3)
    throw InputError(
        "option " + option + " takes three numbers, x,y,z" + comma_hint(numbers.size(), 3),
        "option-value");
  return {numbers[0], numbers[1], numbers[2]};
}

std::array<double, 2> parse_range(const std::string& option, const std::string& text) {
  const std::vector<double> numbers = parse_numbers(option, text);
  if (numbers.size() != 2)
    throw InputError("option " + option + " takes two numbers, a,b" + comma_hint(numbers.size(), 2),
                     "option-value");
  if (!(numbers[0] < numbers[1]))
    throw InputError("option " + option + " takes two ascending numbers, found " +
                         number_text(numbers[0]) + " and " + number_text(numbers[1]),
                     "option-value");
  return {numbers[0], numbers[1]};
}

}  // namespace littoral::cli
