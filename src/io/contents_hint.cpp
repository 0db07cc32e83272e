#include "io/contents_hint.h"

#include <algorithm>

#include "io/formats.h"
#include "io/text_scan.h"

namespace littoral::io {

namespace {

/// The first bytes in lower case, from the first that is no blank, with blanks for line ends.
std::string beginning_of(std::string_view bytes) {
  constexpr std::size_t looked_at = 1024;
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

}  // namespace

std::string contents_hint(std::string_view bytes, const std::string& extension) {
  const std::string text = beginning_of(bytes);
  if (text.empty()) return "the file is empty";
  if (text.starts_with("<!doctype html") || text.starts_with("<html"))
    return "it is a web page, perhaps in place of a download that failed";
  if (text.starts_with("version https://git-lfs"))
    return "it is a pointer of Git LFS: 'git lfs pull' fetches the file";
  if (text.starts_with("\x1f\x8b")) return "it is packed by gzip: name it " + extension + ".gz";
  std::string alike;
  for (const Format& format : formats()) {
    if (!begins_as(text, format)) continue;
    if (format.extension == lower_case(extension)) return "";
    alike.append(alike.empty() ? "" : " or ").append(format.extension);
  }
  return alike.empty() ? "" : "its contents look like " + alike + ": name it so";
}

}  // namespace littoral::io
