#include "cli/input/lengths.h"

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
        parse_number(option, text.substr(begin, end - begin - static_cast<std::size_t>(per_cent))));
    if (per_cent) lengths.back() *= size() / 100;
    begin = end + 1;
  }
  return lengths;
}

double parse_length(const std::string& option, const std::string& text, const InputSize& size) {
  const std::vector<double> lengths = parse_lengths(option, text, size);
  if (lengths.size() != 1)
    throw InputError("option " + option + " takes one length", "option-value");
  return lengths.front();
}

double parse_radius(const std::string& option, const std::string& text, const InputSize& size) {
  const double radius = text.empty() ? 0 : parse_length(option, text, size);
  if (radius < 0)
    throw InputError("option " + option + " takes no negative number", "option-value");
  return radius;
}

void check_lengths(const std::string& option, const std::string& text) {
  if (!text.empty()) parse_lengths(option, text, [] { return 1.0; });
}

}  // namespace littoral::cli
