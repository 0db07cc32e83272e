#pragma once
// The viewer as one HTML file, put into the library by cmake/viewer.cmake.

#include <string_view>

namespace littoral::io {

/// The page with the marks LITTORAL_TITLE and "LITTORAL_DATA" in place of what varies; empty in
/// builds without the viewer.
std::string_view page_template();

}  // namespace littoral::io
