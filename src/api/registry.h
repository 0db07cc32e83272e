#pragma once
// Which methods there are, on which domains they run, and which options they have.

#include <algorithm>
#include <initializer_list>
#include <iterator>
#include <string>
#include <vector>

#include "base/option_table.h"

namespace littoral {

/// What the world may know about one method.
struct MethodInfo {
  std::string name;                  // as typed: "signed-heat"
  std::string summary;               // one sentence
  std::vector<std::string> domains;  // that it runs on: "triangle mesh"
  std::vector<OptionInfo> options;
  std::string reference;  // the paper
};

/// The entries of families of methods, one after the other.
template <class Method>
std::vector<Method> all_of(std::initializer_list<std::vector<Method> (*)()> families) {
  std::vector<Method> out;
  for (const auto family : families) {
    std::vector<Method> entries = family();
    std::move(entries.begin(), entries.end(), std::back_inserter(out));
  }
  return out;
}

/// All methods of distance on surfaces, the default first.
const std::vector<MethodInfo>& methods();

/// Those, and the methods of other verbs.
const std::vector<MethodInfo>& all_methods();

/// The method of that name; throws InputError listing the known ones.
const MethodInfo& find_method(const std::string& name);

/// Throws InputError naming the option and the method, and what the method has, unless it has the
/// option.
void check_has_option(const MethodInfo& method, const std::string& option);

}  // namespace littoral
