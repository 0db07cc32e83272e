#pragma once
// Which methods there are, on which domains they run, and which options they have.

#include <any>
#include <string>
#include <utility>
#include <vector>

namespace littoral {

/// Public metadata of one option.
struct OptionInfo {
  enum class Kind { number, integer, toggle, choice, text };
  Kind kind = Kind::text;
  std::string name;                  // "time-scale"
  std::string unit;                  // "", "[length]", "multiple of h^2"
  double low = 0, high = 0;          // numbers: allowed range, inclusive
  std::vector<std::string> choices;  // choices: allowed words
  std::string fallback;              // default, as text
  std::string help;                  // one sentence

  /// "number", "integer", "toggle", "choice" or "text".
  std::string kind_name() const;
  /// "0 to 10", "on or off", "admm, pdhg", "any text".
  std::string range() const;
};

/// Public metadata of one method.
struct MethodInfo {
  std::string name;                  // "signed-heat"
  std::string summary;               // one sentence
  std::vector<std::string> domains;  // that it runs on: "triangle mesh"
  std::vector<OptionInfo> options;
  std::string reference;          // the paper
  bool different_values = false;  // takes sources whose values differ
};

/// Options by name and text; those that are not named have their defaults.
using OptionValues = std::vector<std::pair<std::string, std::string>>;

/// A method with its options: any of the structs in options.h, a name with option values as text,
/// or, without either, the library's choice for the domain.
class AnyMethod {
 public:
  AnyMethod() = default;
  template <class Options>
  requires requires { Options::method; }
  AnyMethod(Options options)  // implicit: distance(mesh, sources, Exact{})
      : name_(Options::method), options_(std::move(options)) {}
  /// Checked where the method is prepared: an unknown name or option is an InputError listing the
  /// known ones.
  static AnyMethod named(std::string name, OptionValues values = {}) {
    AnyMethod out;
    out.name_ = std::move(name);
    out.values_ = std::move(values);
    return out;
  }

  const std::string& name() const { return name_; }  // empty: the library's choice
  const std::any& options() const { return options_; }
  const OptionValues& values() const { return values_; }

 private:
  std::string name_;
  std::any options_;
  OptionValues values_;
};

/// The methods for one purpose: distance on surfaces, through tets or in space, all pairs, regions.
struct MethodFamily {
  std::string title;  // "Distance on surfaces"
  std::vector<MethodInfo> methods;
};

/// All methods there are by purpose, the default of each first.
std::vector<MethodFamily> method_families();

}  // namespace littoral
