#pragma once
// One descriptor table per options struct: it feeds flags, keywords, the viewer and the docs.

#include <functional>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "littoral/methods.h"

namespace littoral {

/// Parses a finite number in [low, high]; throws InputError naming the option and its range.
double parse_option_number(const OptionInfo& info, const std::string& text);
/// The same for a whole number.
int parse_option_integer(const OptionInfo& info, const std::string& text);
/// Position of a word among the choices; throws InputError listing them.
int parse_option_choice(const OptionInfo& info, const std::string& text);
bool parse_option_switch(const OptionInfo& info, const std::string& text);
std::string number_text(double value);
/// A measured value in a sentence, with a point in every locale.
std::string rounded_text(double value, int digits = 4);
/// "2.5 %" of .025, two digits below a tenth.
std::string percent_text(double share);
/// Throws InputError unless the number is in [low, high].
void check_option_range(const OptionInfo& info, double value);
/// "; did you mean 'time-scale'?" where a known name is but a few letters away, otherwise nothing.
std::string meant(const std::string& name, const std::vector<std::string>& known);
/// "a, b, c": of words, or of what else `text` makes words.
template <class Range, class Text = std::identity>
std::string listed(const Range& all, Text text = {}) {
  std::string out;
  for (const auto& each : all) {
    if (!out.empty()) out += ", ";
    out += std::invoke(text, each);
  }
  return out;
}
/// The same of the names in a map.
template <class Map>
std::string listed_names(const Map& map) {
  return listed(map, &Map::value_type::first);
}
/// What was meant, then all known names behind `heading`.
std::string instead_of(const std::string& name, const std::vector<std::string>& known,
                       const std::string& heading);
/// The same of what has a name: options, methods.
template <class Named>
std::string instead_of(const std::string& name, const std::vector<Named>& known,
                       const std::string& heading = "known") {
  std::vector<std::string> names;
  for (const Named& each : known) names.push_back(each.name);
  return instead_of(name, names, heading);
}
[[noreturn]] void throw_unknown_option(const std::string& name,
                                       const std::vector<OptionInfo>& known);

/// Binds option names to the members of a plain struct S.
template <class S>
class OptionTable {
 public:
  OptionTable& number(double S::*m, std::string name, std::string unit, double low, double high,
                      std::string help) {
    return numeric(m, described(OptionInfo::Kind::number, std::move(name), std::move(help)),
                   std::move(unit), low, high, parse_option_number, number_text);
  }
  OptionTable& integer(int S::*m, std::string name, std::string unit, int low, int high,
                       std::string help) {
    return numeric(m, described(OptionInfo::Kind::integer, std::move(name), std::move(help)),
                   std::move(unit), low, high, parse_option_integer,
                   [](int value) { return std::to_string(value); });
  }
  OptionTable& toggle(bool S::*m, std::string name, std::string help) {
    return add(
        described(OptionInfo::Kind::toggle, std::move(name), std::move(help)),
        [m](S& s, const OptionInfo& i, const std::string& text) {
          s.*m = parse_option_switch(i, text);
        },
        [m](const S& s, const OptionInfo&) { return std::string(s.*m ? "on" : "off"); }, nullptr);
  }
  /// E: an enum class whose values count from 0 in the order of `choices`.
  template <class E>
  OptionTable& choice(E S::*m, std::string name, std::vector<std::string> choices,
                      std::string help) {
    static_assert(std::is_enum_v<E>);
    OptionInfo info = described(OptionInfo::Kind::choice, std::move(name), std::move(help));
    info.choices = std::move(choices);
    return add(
        std::move(info),
        [m](S& s, const OptionInfo& i, const std::string& text) {
          s.*m = static_cast<E>(parse_option_choice(i, text));
        },
        [m](const S& s, const OptionInfo& i) { return i.choices.at(std::size_t(s.*m)); }, nullptr);
  }
  OptionTable& text(std::string S::*m, std::string name, std::string unit, std::string help) {
    OptionInfo info = described(OptionInfo::Kind::text, std::move(name), std::move(help));
    info.unit = std::move(unit);
    return add(
        std::move(info), [m](S& s, const OptionInfo&, const std::string& text) { s.*m = text; },
        [m](const S& s, const OptionInfo&) { return (s.*m).empty() ? "none" : s.*m; }, nullptr);
  }

  const std::vector<OptionInfo>& infos() const { return infos_; }

  /// Sets one option from text; throws InputError for an unknown name or a value out of range.
  void set(S& options, const std::string& name, const std::string& text) const {
    for (std::size_t i = 0; i < infos_.size(); ++i)
      if (infos_[i].name == name) return access_[i].set(options, infos_[i], text);
    throw_unknown_option(name, infos_);
  }
  std::string get(const S& options, std::size_t i) const {
    return access_[i].get(options, infos_[i]);
  }
  /// Throws InputError naming the first option whose value is out of range.
  void check(const S& options) const {
    for (std::size_t i = 0; i < infos_.size(); ++i)
      if (access_[i].check) access_[i].check(options, infos_[i]);
  }

 private:
  struct Access {
    std::function<void(S&, const OptionInfo&, const std::string&)> set;
    std::function<std::string(const S&, const OptionInfo&)> get;
    std::function<void(const S&, const OptionInfo&)> check;  // none: every value will do
  };
  static OptionInfo described(OptionInfo::Kind kind, std::string name, std::string help) {
    OptionInfo info;
    info.kind = kind;
    info.name = std::move(name);
    info.help = std::move(help);
    return info;
  }
  template <class N, class Parse, class Text>
  OptionTable& numeric(N S::*m, OptionInfo info, std::string unit, double low, double high,
                       Parse parse, Text words) {
    info.unit = std::move(unit);
    info.low = low;
    info.high = high;
    return add(
        std::move(info),
        [m, parse](S& s, const OptionInfo& i, const std::string& given) { s.*m = parse(i, given); },
        [m, words](const S& s, const OptionInfo&) { return words(s.*m); },
        [m](const S& s, const OptionInfo& i) { check_option_range(i, s.*m); });
  }
  template <class Set, class Get, class Check>
  OptionTable& add(OptionInfo info, Set set, Get get, Check check) {
    info.fallback = get(S{}, info);
    infos_.push_back(std::move(info));
    Access access{std::move(set), std::move(get), {}};
    if constexpr (std::is_invocable_v<Check, const S&, const OptionInfo&>)
      access.check = std::move(check);
    access_.push_back(std::move(access));
    return *this;
  }
  std::vector<OptionInfo> infos_;
  std::vector<Access> access_;
};

}  // namespace littoral
