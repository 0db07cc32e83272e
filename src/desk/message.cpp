#include "desk/message.h"

#include <array>
#include <cstdint>
#include <cstring>

#include "littoral/error.h"

namespace littoral::desk {

namespace {

constexpr std::uint32_t mark = 0x314c544c;  // "LTL1"
constexpr std::size_t first = 8, most_depth = 16;

using nlohmann::json;

}  // namespace

std::string packed(const Message& message) {
  std::string text = message.head.dump(-1, ' ', false, json::error_handler_t::replace);
  text.append((8 - text.size() % 8) % 8, ' ');
  const std::array<std::uint32_t, 2> start = {static_cast<std::uint32_t>(text.size()), mark};
  std::string out(first, '\0');
  std::memcpy(out.data(), start.data(), first);
  out.reserve(first + text.size() + message.arrays.size());
  return out.append(text).append(message.arrays);
}

Message unpacked(std::string_view bytes) {
  std::array<std::uint32_t, 2> start{};
  if (bytes.size() < first) throw InputError("a message has at least 8 bytes");
  std::memcpy(start.data(), bytes.data(), first);
  if (start[1] != mark) throw InputError("this is no message to littoral");
  if (start[0] % 8 != 0 || start[0] > bytes.size() - first)
    throw InputError("the message is cut off");
  // Arguments are flat: what is deeper is not from the page, and would take the stack along.
  const auto shallow = [](int depth, json::parse_event_t, json&) {
    if (depth > static_cast<int>(most_depth)) throw InputError("the message is nested too deeply");
    return true;
  };
  Message out;
  try {
    out.head = json::parse(bytes.substr(first, start[0]), shallow);
  } catch (const json::exception& e) {
    throw InputError(std::string("the message cannot be read: ") + e.what());
  }
  out.arrays = bytes.substr(first + start[0]);
  return out;
}

}  // namespace littoral::desk
