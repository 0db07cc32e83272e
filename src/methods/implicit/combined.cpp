#include "methods/implicit/combined.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "littoral/error.h"

namespace littoral {

namespace {

DistanceSample opposite(const DistanceSample& a) { return {-a.value, -a.gradient}; }

/// Smallest first, so that the result does not depend on the order in which fields were named.
DistanceSample smooth_min_of(std::vector<DistanceSample>& fields, double blend) {
  std::stable_sort(
      fields.begin(), fields.end(),
      [](const DistanceSample& a, const DistanceSample& b) { return a.value < b.value; });
  DistanceSample least = fields.front();
  for (std::size_t i = 1; i < fields.size(); ++i) least = smooth_min(least, fields[i], blend);
  return least;
}

template <class Ask>
DistanceSample combine_asked(const Csg& csg, std::size_t n, const Ask& ask) {
  std::vector<DistanceSample> united{ask(std::size_t{0})}, parts(1);
  for (std::size_t i = 1; i < n; ++i) {
    const DistanceSample field = ask(i);
    switch (csg.operations[i - 1]) {
      case Boolean::unite:
        united.push_back(field);
        break;
      case Boolean::intersect:
        parts.push_back(opposite(field));
        break;
      case Boolean::subtract:
        parts.push_back(field);
        break;
    }
  }
  // max(u, a, -b) = -min(-u, -a, b)
  parts.front() = opposite(smooth_min_of(united, csg.blend));
  DistanceSample result = opposite(smooth_min_of(parts, csg.blend));
  result.value -= csg.offset;
  return result;
}

}  // namespace

DistanceSample smooth_min(const DistanceSample& a, const DistanceSample& b, double blend) {
  const bool first = a.value <= b.value;
  const DistanceSample &less = first ? a : b, &more = first ? b : a;
  const double difference = more.value - less.value;
  if (!(difference < blend)) return less;  // also where both are infinite
  const double h = 1 - difference / blend;
  return {less.value - blend * h * h / 4, (1 - h / 2) * less.gradient + h / 2 * more.gradient};
}

void check_combination(const Csg& csg, std::size_t fields) {
  if (fields == 0 || fields != csg.operations.size() + 1)
    throw InputError("a combination of " + std::to_string(csg.operations.size() + 1) +
                     " shapes got " + std::to_string(fields));
  if (!(csg.blend >= 0 && std::isfinite(csg.blend)))
    throw InputError("option blend must be finite and not negative", "option-value");
  if (!std::isfinite(csg.offset))
    throw InputError("the offset must be a finite number", "option-value");
}

DistanceSample combine(const Csg& csg, std::span<const DistanceSample> fields) {
  return combine_asked(csg, fields.size(), [&](std::size_t i) { return fields[i]; });
}

Combined::Combined(std::vector<std::shared_ptr<const PointwiseDistance>> fields, Csg csg)
    : fields_(std::move(fields)), csg_(std::move(csg)) {
  check_combination(csg_, fields_.size());
}

DistanceSample Combined::at(const Vec3& x) const {
  return combine_asked(csg_, fields_.size(), [&](std::size_t i) { return fields_[i]->at(x); });
}

double Combined::value(const Vec3& x) const {
  return combine_asked(csg_, fields_.size(),
                       [&](std::size_t i) {
                         return DistanceSample{fields_[i]->value(x), Vec3::Zero()};
                       })
      .value;
}

}  // namespace littoral
