#pragma once
// Named numbers of several components, as a report shows them.

#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace littoral {

/// Gathers one number of each component that was solved by itself. A report gets the worst under
/// the plain name and, where there are several components, those of the first sixteen as "NAME,
/// component C".
class ComponentValues {
 public:
  explicit ComponentValues(std::string name) : name_(std::move(name)) {}

  void add(int component, double value) { values_.emplace_back(component, value); }

  /// The largest; one that is not a number counts as the largest. 0 of none.
  double worst() const {
    double out = 0;
    for (const auto& [c, value] : values_)
      if (std::isnan(value) || value > out) out = value;
    return out;
  }
  double sum() const {
    double out = 0;
    for (const auto& [c, value] : values_) out += value;
    return out;
  }

  using List = std::vector<std::pair<std::string, double>>;
  void report_worst(List& list) const { report(worst(), list); }
  void report_sum(List& list) const { report(sum(), list); }

 private:
  void report(double all, List& list) const {
    constexpr std::size_t most = 16;
    list.emplace_back(name_, all);
    for (std::size_t i = 0; values_.size() > 1 && i < values_.size() && i < most; ++i)
      list.emplace_back(name_ + ", component " + std::to_string(values_[i].first),
                        values_[i].second);
  }

  std::string name_;
  std::vector<std::pair<int, double>> values_;  // component, value
};

}  // namespace littoral
