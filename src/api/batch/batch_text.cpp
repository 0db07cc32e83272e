#include "api/batch/batch_text.h"

#include <cmath>

namespace littoral {

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  if (what.empty()) return text;
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size())
    text.replace(at, what.size(), by);
  return text;
}

std::string duration_text(double seconds) {
  const auto whole = static_cast<long long>(std::llround(std::fmin(seconds, 1e12)));
  if (whole < 60) return std::to_string(whole) + " s";
  const bool hours = whole >= 3600;
  const long long large = whole / (hours ? 3600 : 60), small = whole / (hours ? 60 : 1) % 60;
  return std::to_string(large) + (hours ? " h " : " min ") + std::to_string(small) +
         (hours ? " min" : " s");
}

}  // namespace littoral
