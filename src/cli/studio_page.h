#pragma once
// The studio that computes in the program which serves it, put in by cmake/viewer.cmake.

#include <string_view>

namespace littoral::cli {

/// The page; empty in builds without it.
std::string_view studio_page();

}  // namespace littoral::cli
