#include "cli/input/lengths.h"

#include "base/option_table.h"
#include "cli/input/numbers.h"
#include "cli/session.h"
#include "littoral/error.h"

namespace littoral::cli {

std::vector<double> parse_lengths(const std::string& option, const std::string& text,
                                  const InputSize& size) {
  std::vector<double> lengths;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const bool per_cent = end > begin && text[end - 1] == '%';
    lengths.push_back(
        parse_number(option, text.substr(begin, end - begin - std::size_t(per_cent))));
    if (per_cent) lengths.back() *= size() / 100;
    begin = end + 1;
  }
  return lengths;
}

double parse_length(const std::string& option, const std::string& text, const InputSize& size) {
  const std::vector<double> lengths = parse_lengths(option, text, size);
  if (lengths.size() != 1)
    throw InputError("option " + option + " takes one length, found " +
                         std::to_string(lengths.size()) + "; decimals stand behind a point",
                     "option-value");
  return lengths.front();
}

double parse_radius(const std::string& option, const std::string& text, const InputSize& size) {
  const double radius = text.empty() ? 0 : parse_length(option, text, size);
  if (radius < 0)
    throw InputError("option " + option + " takes no negative number", "option-value");
  return radius;
}

double parse_place(const std::string& option, const std::string& text, double low, double high) {
  if (!text.ends_with('%')) return parse_number(option, text);
  const double share = parse_number(option, text.substr(0, text.size() - 1)) / 100;
  if (!(share >= 0 && share <= 1))
    throw InputError("option " + option + ": " + text + " is not on the way from 0% to 100%",
                     "option-value");
  return low + share * (high - low);
}

CLI::Option* add_share_option(CLI::App& verb, const std::string& name, double& share, double most,
                              const std::string& help) {
  return verb
      .add_option_function<std::string>(
          "--" + name,
          [name, &share](const std::string& text) {
            share = parse_length(name, text, [] { return 1.0; });
          },
          help)
      ->check(CLI::Validator(
          [most](const std::string& text) -> std::string {
            try {
              const double value = parse_length("", text, [] { return 1.0; });
              if (0 <= value && value <= most) return "";
            } catch (const InputError&) {
            }
            return "'" + text + "' is no number from 0 to " + number_text(most) + ", as 0.1 or 10%";
          },
          ""))
      ->type_name("F");
}

void check_lengths(const std::string& option, const std::string& text) {
  if (!text.empty()) parse_lengths(option, text, [] { return 1.0; });
}

}  // namespace littoral::cli
