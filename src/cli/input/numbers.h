#pragma once
// Numbers as given: lists between commas, decimals behind a point.

#include <array>
#include <string>
#include <vector>

#include "littoral/types.h"

namespace littoral::cli {

/// Reads "0,0.5,-1"; throws InputError naming the option.
std::vector<double> parse_numbers(const std::string& option, const std::string& text);
double parse_number(const std::string& option, const std::string& text);
/// Reads "0,1,2".
Vec3 parse_position(const std::string& option, const std::string& text);
/// Reads "0,1", ascending.
std::array<double, 2> parse_range(const std::string& option, const std::string& text);

}  // namespace littoral::cli
