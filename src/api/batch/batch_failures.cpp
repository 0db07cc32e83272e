#include "api/batch/batch_failures.h"

#include <algorithm>
#include <cctype>

#include "api/batch/batch_text.h"

namespace littoral {

namespace {

constexpr std::size_t most_kinds = 1000;  // messages beyond these are counted together

}  // namespace

void FailureCount::add(const BatchJob& job, const BatchOutcome& outcome) {
  std::string text = replaced(outcome.message, job.input, "*");
  text = replaced(text, std::filesystem::path(job.input).filename().string(), "*");
  std::string key = outcome.status + " ";
  bool quoted = false;
  for (const char c : text) {
    if (c == '\'') quoted = !quoted;
    if (quoted && c != '\'') continue;
    const bool digit = std::isdigit(static_cast<unsigned char>(c)) != 0;
    if (!digit || key.back() != '#') key += digit ? '#' : c;
  }
  if (by_text_.size() >= most_kinds && by_text_.count(key) == 0) key = "other";
  BatchFailures& failures = by_text_[key];
  if (failures.count++ == 0)
    failures = {outcome.status, key == "other" ? "other messages" : outcome.message, job.input, 1};
}

std::vector<BatchFailures> FailureCount::sorted() const {
  std::vector<BatchFailures> out;
  for (const auto& [text, failures] : by_text_) out.push_back(failures);
  std::stable_sort(out.begin(), out.end(),
                   [](const auto& a, const auto& b) { return a.count > b.count; });
  return out;
}

}  // namespace littoral
