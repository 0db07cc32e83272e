#pragma once
// Lengths as given: in the unit of the input, or in per cent of its longest side.

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

namespace littoral::cli {

/// What --help says after the unit of such an option.
inline constexpr const char* length_unit_text = "length, or with % of the longest side";

/// The longest side of the input's box; asked for where a length is in per cent.
using InputSize = std::function<double()>;

/// Reads "0.1,-2%"; throws InputError naming the option.
std::vector<double> parse_lengths(const std::string& option, const std::string& text,
                                  const InputSize& size);
/// One length.
double parse_length(const std::string& option, const std::string& text, const InputSize& size);
/// One length that is not negative, 0 for no text.
double parse_radius(const std::string& option, const std::string& text, const InputSize& size);
/// One place from `low` to `high`, or "25%" of the way between them.
double parse_place(const std::string& option, const std::string& text, double low, double high);
/// Adds an option for a part of a whole, 0 to `most`: 0.1 or 10%.
CLI::Option* add_share_option(CLI::App& verb, const std::string& name, double& share, double most,
                              const std::string& help);
/// Throws what reading would throw whatever the size is.
void check_lengths(const std::string& option, const std::string& text);

}  // namespace littoral::cli
