#pragma once
// littoral view --edit: drawing in a browser on this machine, computed by this program.

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "cli/session.h"

namespace littoral::cli {

/// Serves the studio with a surface and sources on it until the session is cancelled. Throws
/// InputError for other options of the verb that were given, and what reading the files throws.
void serve_studio(const CLI::App& verb, const std::string& surface,
                  const std::vector<std::string>& sources, Session& session);

}  // namespace littoral::cli
