#pragma once
// Patterns for names of files, as shells have them.

#include <string>
#include <vector>

namespace littoral {

/// Does the text hold any of * ? [ ?
bool is_pattern(const std::string& text);

/// The files and folders that match, sorted; * and ? do not match "/".
std::vector<std::string> matching_paths(const std::string& pattern);

}  // namespace littoral
