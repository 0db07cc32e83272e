#pragma once
// Texts of batches.

#include <string>

namespace littoral {

/// The text with `what`, where that is not empty, replaced everywhere.
std::string replaced(std::string text, const std::string& what, const std::string& by);

/// "12 s", "4 min 40 s", "3 h 5 min".
std::string duration_text(double seconds);

}  // namespace littoral
