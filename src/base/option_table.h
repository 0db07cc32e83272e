#pragma once
// One descriptor table per options struct: it feeds flags, keywords, the viewer and the docs.

#include <string>
#include <variant>
#include <vector>

#include "base/error.h"

namespace littoral {

/// What the world may know about one option.
struct OptionInfo {
  std::string name;                  // as typed: "time-scale"
  std::string unit;                  // "", "[length]", "multiple of h^2"
  double low = 0, high = 0;          // numbers: allowed range, inclusive
  std::vector<std::string> choices;  // words: allowed values
  std::string fallback;              // default, as text
  std::string help;                  // one sentence
  bool is_switch = false;
  bool is_text = false;  // any text, e.g. the name of a file
};

/// Parses a finite number in [low, high]; throws InputError naming the option and its range.
double parse_option_number(const OptionInfo& info, const std::string& text);
/// Position of a word among the choices; throws InputError listing them.
int parse_option_choice(const OptionInfo& info, const std::string& text);
bool parse_option_switch(const OptionInfo& info, const std::string& text);
std::string option_range_text(const OptionInfo& info);
std::string number_text(double value);
[[noreturn]] void throw_unknown_option(const std::string& name,
                                       const std::vector<OptionInfo>& known);

/// Binds option names to the members of a plain struct S (numbers, switches, enumerations as int,
/// texts).
template <class S>
class OptionTable {
 public:
  using Member = std::variant<double S::*, bool S::*, int S::*, std::string S::*>;

  OptionTable& number(double S::*m, std::string name, std::string unit, double low, double high,
                      std::string help) {
    OptionInfo info{std::move(name), std::move(unit), low, high, {}, {}, std::move(help), false};
    info.fallback = number_text(S{}.*m);
    return add(std::move(info), m);
  }
  OptionTable& toggle(bool S::*m, std::string name, std::string help) {
    OptionInfo info{std::move(name), "", 0, 1, {}, S{}.*m ? "on" : "off", std::move(help), true};
    return add(std::move(info), m);
  }
  OptionTable& choice(int S::*m, std::string name, std::vector<std::string> choices,
                      std::string help) {
    OptionInfo info{std::move(name), "", 0, 0, std::move(choices), "", std::move(help), false};
    info.fallback = info.choices.at(static_cast<std::size_t>(S{}.*m));
    return add(std::move(info), m);
  }

  OptionTable& text(std::string S::*m, std::string name, std::string unit, std::string help) {
    OptionInfo info{std::move(name), std::move(unit), 0, 0, {}, "none", std::move(help), false};
    info.is_text = true;
    return add(std::move(info), m);
  }

  const std::vector<OptionInfo>& infos() const { return infos_; }

  /// Sets one option from text; throws InputError for an unknown name or a value out of range.
  void set(S& options, const std::string& name, const std::string& text) const {
    for (std::size_t i = 0; i < infos_.size(); ++i) {
      if (infos_[i].name != name) continue;
      if (auto m = std::get_if<double S::*>(&members_[i])) {
        options.** m = parse_option_number(infos_[i], text);
      } else if (auto b = std::get_if<bool S::*>(&members_[i])) {
        options.** b = parse_option_switch(infos_[i], text);
      } else if (auto t = std::get_if<std::string S::*>(&members_[i])) {
        options.** t = text;
      } else {
        options.*std::get<int S::*>(members_[i]) = parse_option_choice(infos_[i], text);
      }
      return;
    }
    throw_unknown_option(name, infos_);
  }

  std::string get(const S& options, std::size_t i) const {
    if (auto m = std::get_if<double S::*>(&members_[i])) return number_text(options.**m);
    if (auto b = std::get_if<bool S::*>(&members_[i])) return options.**b ? "on" : "off";
    if (auto t = std::get_if<std::string S::*>(&members_[i])) {
      const std::string& text = options.**t;
      return text.empty() ? infos_[i].fallback : text;
    }
    const int at = options.*std::get<int S::*>(members_[i]);
    return infos_[i].choices.at(static_cast<std::size_t>(at));
  }

 private:
  OptionTable& add(OptionInfo info, Member member) {
    infos_.push_back(std::move(info));
    members_.push_back(member);
    return *this;
  }
  std::vector<OptionInfo> infos_;
  std::vector<Member> members_;
};

}  // namespace littoral
