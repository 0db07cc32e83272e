#pragma once
// What the bytes of a file look like, for files that are not what their names say.

#include <cstdint>
#include <string>
#include <string_view>

#include "littoral/error.h"

namespace littoral::io {

/// "its contents look like .ply: name it so", or nothing where they look like the extension or like
/// no format.
std::string contents_hint(std::string_view bytes, const std::string& extension);

/// The extension of the only format whose files begin so and may have this size [bytes]; empty
/// where there is none or several.
std::string extension_told(std::string_view bytes, std::uint64_t size);

/// What `read` returns; its InputErrors of bad files end in the hint, unless they say the same.
template <class Read>
auto read_with_hint(std::string_view bytes, const std::string& extension, Read read) {
  try {
    return read();
  } catch (const InputError& e) {
    if (e.code() != "bad-file") throw;
    const std::string said = e.what(), hint = contents_hint(bytes, extension);
    if (hint.empty() || said.ends_with(hint)) throw;
    throw InputError(said + "; " + hint, e.code());
  }
}

}  // namespace littoral::io
