#pragma once
// Pages of the manual in roff, made from the verbs and their options.

#include <CLI/CLI.hpp>
#include <string>

namespace littoral::cli {

/// littoral(1): the verbs, exit statuses and what all verbs share.
std::string manual_page(const CLI::App& program);
/// littoral-VERB(1).
std::string manual_page(const CLI::App& program, const CLI::App& verb);

}  // namespace littoral::cli
