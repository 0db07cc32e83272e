#pragma once
// Flags for the options of methods, for the verbs that run one.

#include <map>
#include <string>
#include <vector>

#include "api/surface/distance.h"
#include "cli/session.h"

namespace littoral::cli {

using GivenOptions = std::map<std::string, std::string>;  // name, value as typed

/// One flag for each option that any of the methods has; its help says what it is to each.
void add_method_options(CLI::App& verb, GivenOptions& given,
                        const std::vector<MethodInfo>& methods);
/// The same for the methods on surfaces.
void add_method_options(CLI::App& verb, GivenOptions& given);

/// The arguments after the program's name; options of which "on" is one of several words may stand
/// without a word, and are joined to the one that follows or to "on" by "=".
std::vector<std::string> with_words(int argc, char** argv);

/// Adds --method, whose help lists them and says that the first is the default.
void add_method_option(CLI::App& verb, std::string& name, const std::vector<MethodInfo>& methods);

/// Puts the options that were given into the request and checks it.
void use_method_options(const GivenOptions& given, DistanceRequest& request);

}  // namespace littoral::cli
