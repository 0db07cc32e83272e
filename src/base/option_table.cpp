#include "base/option_table.h"

#include <charconv>
#include <cmath>

namespace littoral {

std::string number_text(double value) {
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
  return {buffer, end};
}

std::string option_range_text(const OptionInfo& info) {
  if (info.is_switch) return "on or off";
  if (info.is_text) return "any text";
  if (info.choices.empty()) return number_text(info.low) + " to " + number_text(info.high);
  std::string text;
  for (const auto& choice : info.choices) text += (text.empty() ? "" : ", ") + choice;
  return text;
}

namespace {
[[noreturn]] void throw_bad_value(const OptionInfo& info, const std::string& text) {
  throw InputError("option " + info.name + ": '" + text +
                   "' is not one of: " + option_range_text(info));
}
}  // namespace

double parse_option_number(const OptionInfo& info, const std::string& text) {
  double value = 0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || end != text.data() + text.size())
    throw InputError("option " + info.name + ": '" + text + "' is not a number");
  if (!(value >= info.low && value <= info.high))
    throw InputError("option " + info.name + ": " + text + " is outside " +
                     option_range_text(info));
  return value;
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

void throw_unknown_option(const std::string& name, const std::vector<OptionInfo>& known) {
  std::string names;
  for (const auto& info : known) names += (names.empty() ? "" : ", ") + info.name;
  throw InputError("unknown option '" + name + "'; known: " + names);
}

}  // namespace littoral
