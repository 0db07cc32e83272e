#pragma once
// Flags for the options of methods, from their tables.

#include <CLI/CLI.hpp>
#include <map>
#include <string>
#include <vector>

#include "littoral/api/registry.h"

namespace littoral::cli {

/// One flag for each option that any of the methods has; its help says what it is to each. Values
/// given are kept as text, by name.
void add_method_options(CLI::App& verb, const std::vector<MethodInfo>& methods,
                        std::map<std::string, std::string>& given);

}  // namespace littoral::cli
