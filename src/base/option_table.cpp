#include "base/option_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>
#include <utility>

#include "littoral/error.h"

namespace littoral {

std::string number_text(double value) {
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
  return {buffer, end};
}

std::string rounded_text(double value, int digits) {
  if (!std::isfinite(value) || std::abs(value) < 1e-290) return number_text(value);
  const double unit = std::pow(10, std::floor(std::log10(std::abs(value))) - (digits - 1));
  return number_text(unit >= 1 ? std::round(value / unit) * unit
                               : std::round(value / unit) / std::round(1 / unit));
}

std::string percent_text(double share) {
  return (share < 0.0995 ? rounded_text(100 * share, 2) : number_text(std::round(100 * share))) +
         " %";
}

std::string OptionInfo::kind_name() const {
  static constexpr const char* names[] = {"number", "integer", "toggle", "choice", "text"};
  return names[static_cast<int>(kind)];
}

std::string OptionInfo::range() const {
  switch (kind) {
    case Kind::toggle:
      return "on or off";
    case Kind::text:
      return "any text";
    case Kind::number:
    case Kind::integer:
      return number_text(low) + " to " + number_text(high);
    case Kind::choice:
      break;
  }
  return listed(choices);
}

namespace {
[[noreturn]] void throw_bad_value(const OptionInfo& info, const std::string& text) {
  throw InputError("option " + info.name + ": '" + text + "' is not one of: " + info.range() +
                       meant(text, info.choices),
                   "unknown-name");
}
[[noreturn]] void throw_out_of_range(const OptionInfo& info, const std::string& value) {
  throw InputError("option " + info.name + ": " + value + " is outside " + info.range(),
                   "option-value");
}
}  // namespace

double parse_option_number(const OptionInfo& info, const std::string& text) {
  double value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || end != text.data() + text.size())
    throw InputError("option " + info.name + ": '" + text + "' is not a number", "option-value");
  if (!(value >= info.low && value <= info.high)) throw_out_of_range(info, text);
  return value;
}

int parse_option_integer(const OptionInfo& info, const std::string& text) {
  const double value = parse_option_number(info, text);
  if (value != std::floor(value))
    throw InputError("option " + info.name + ": " + text + " is not a whole number",
                     "option-value");
  return static_cast<int>(value);
}

void check_option_range(const OptionInfo& info, double value) {
  if (!(value >= info.low && value <= info.high)) throw_out_of_range(info, number_text(value));
}

int parse_option_choice(const OptionInfo& info, const std::string& text) {
  for (std::size_t i = 0; i < info.choices.size(); ++i)
    if (info.choices[i] == text) return static_cast<int>(i);
  throw_bad_value(info, text);
}

bool parse_option_switch(const OptionInfo& info, const std::string& text) {
  if (text == "on" || text == "true" || text == "1") return true;
  if (text == "off" || text == "false" || text == "0") return false;
  throw_bad_value(info, text);
}

std::string meant(const std::string& name, const std::vector<std::string>& known) {
  // Levenshtein's distance, row by row.
  const auto edits = [&](const std::string& other) {
    std::vector<std::size_t> row(other.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 1; i <= name.size(); ++i) {
      std::size_t diagonal = std::exchange(row[0], i);
      for (std::size_t j = 1; j <= other.size(); ++j) {
        const std::size_t changed = diagonal + (name[i - 1] == other[j - 1] ? 0 : 1);
        diagonal = row[j];
        row[j] = std::min({changed, row[j - 1] + 1, row[j] + 1});
      }
    }
    return row.back();
  };
  std::string nearest;
  for (const std::string& other : known)  // a beginning says more than letters in common
    if (name.size() > 2 && other.starts_with(name) &&
        (nearest.empty() || other.size() < nearest.size()))
      nearest = other;
  if (!nearest.empty()) return "; did you mean '" + nearest + "'?";
  std::size_t fewest = std::max<std::size_t>(2, name.size() / 3) + 1;
  for (const std::string& other : known)
    if (const std::size_t n = edits(other); n < fewest) {
      fewest = n;
      nearest = other;
    }
  return nearest.empty() ? "" : "; did you mean '" + nearest + "'?";
}

std::string instead_of(const std::string& name, const std::vector<std::string>& known,
                       const std::string& heading) {
  return meant(name, known) + "; " + heading + ": " + (known.empty() ? "none" : listed(known));
}

void throw_unknown_option(const std::string& name, const std::vector<OptionInfo>& known) {
  throw InputError("unknown option '" + name + "'" + instead_of(name, known), "unknown-name");
}

}  // namespace littoral
