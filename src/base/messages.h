#pragma once
// The codes of errors and warnings, and what they mean. The page of messages is printed from this.

#include <span>
#include <string>

namespace littoral {

struct Message {
  enum class Kind { error, warning };
  Kind kind;
  const char* code;
  const char* about;    // what it says, shortened
  const char* meaning;  // why
  const char* remedy;   // what to do next
};

/// All of them: errors first, each kind in the order of the page.
std::span<const Message> messages();
/// The page docs/guides/messages.md.
std::string messages_markdown();

}  // namespace littoral
