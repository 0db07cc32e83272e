#include "io/contents_hint.h"

#include <algorithm>
#include <filesystem>
#include <vector>

#include "io/formats.h"
#include "io/read.h"
#include "io/text_scan.h"

namespace littoral::io {

namespace {

constexpr std::size_t looked_at = 1024;

/// The first bytes in lower case, from the first that is no blank, with blanks for line ends.
std::string beginning_of(std::string_view bytes) {
  if (bytes.starts_with("\xef\xbb\xbf")) bytes.remove_prefix(3);
  const std::size_t first = bytes.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return "";
  std::string text = lower_case(std::string(bytes.substr(first, looked_at)));
  for (char& c : text)
    if (c == '\r' || c == '\n' || c == '\t') c = ' ';
  return text;
}

bool begins_as(const std::string& text, const Format& format) {
  return std::ranges::any_of(format.begins, [&](std::string_view begins) {
    return begins.starts_with('<') ? text.find(begins) != std::string::npos
                                   : text.starts_with(begins);
  });
}

/// The formats whose files are of this size and begin so: one of numbers alone whose size fits, or
/// else those that have these words there.
std::vector<const Format*> formats_beginning(std::string_view bytes, std::uint64_t size) {
  const std::string text = beginning_of(bytes);
  std::vector<const Format*> found;
  for (const Format& format : formats()) {
    if (format.fits && format.fits(bytes, size)) return {&format};
    if (begins_as(text, format)) found.push_back(&format);
  }
  return found;
}

}  // namespace

std::string extension_told(std::string_view bytes, std::uint64_t size) {
  const std::vector<const Format*> found = formats_beginning(bytes, size);
  return found.size() == 1 ? std::string(found.front()->extension) : "";
}

std::string extension_to_read(const std::filesystem::path& path) {
  const std::string named = extension_named(path);
  const Format* format = format_of(named);
  if (format && !format->exchanged) return named;
  const auto [bytes, size] = first_bytes(path, 2 * looked_at);
  const std::string told = extension_told(bytes, size);
  if (told.empty() || (format && !format_of(told)->exchanged)) return named;
  return told;
}

std::string contents_hint(std::string_view bytes, const std::string& extension) {
  const std::string text = beginning_of(bytes);
  if (text.empty()) return "the file is empty";
  if (text.starts_with("<!doctype html") || text.starts_with("<html"))
    return "it is a web page, perhaps in place of a download that failed";
  if (text.starts_with("version https://git-lfs"))
    return "it is a pointer of Git LFS: 'git lfs pull' fetches the file";
  if (text.starts_with("\x1f\x8b")) return "it is packed by gzip: name it " + extension + ".gz";
  std::string alike;
  for (const Format* format : formats_beginning(bytes, bytes.size())) {
    if (format->extension == lower_case(extension)) return "";
    alike.append(alike.empty() ? "" : " or ").append(format->extension);
  }
  return alike.empty() ? "" : "its contents look like " + alike + ": name it so";
}

}  // namespace littoral::io
