#include "littoral/report.h"

namespace littoral {

void Report::merge(const Report& other) {
  auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  append(options, other.options);
  append(sizes, other.sizes);
  append(timings, other.timings);
  append(iterations, other.iterations);
  append(residuals, other.residuals);
  append(warnings, other.warnings);
  append(unreachable_components, other.unreachable_components);
  if (other.status != "converged") status = other.status;
}

}  // namespace littoral
