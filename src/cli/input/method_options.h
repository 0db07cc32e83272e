#pragma once
// Flags for the options of methods, for the verbs that run one.

#include <map>
#include <string>
#include <vector>

#include "cli/session.h"
#include "littoral/methods.h"

namespace littoral::cli {

/// What options of methods stand under in --help.
inline constexpr const char* method_options_group = "Options of methods";

using GivenOptions = std::map<std::string, std::string>;  // name, value as typed

/// --method and the options of methods, as typed.
struct MethodArguments {
  std::string name;  // empty: the library's choice
  GivenOptions options;

  AnyMethod method() const { return AnyMethod::named(name, {options.begin(), options.end()}); }
};

/// One flag for each option that any of the methods has; its help says what it is to each.
void add_method_options(CLI::App& verb, GivenOptions& given,
                        const std::vector<MethodInfo>& methods);
/// --method, whose help lists the methods and says that the first is the default unless `fallback`
/// says more, and one flag for each option that any of them has.
void add_methods(CLI::App& verb, MethodArguments& arguments, const std::vector<MethodInfo>& methods,
                 const std::string& fallback = "");

/// The methods of both families, each name once.
std::vector<MethodInfo> joined(std::vector<MethodInfo> methods,
                               const std::vector<MethodInfo>& more);

}  // namespace littoral::cli
