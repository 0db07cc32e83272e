#include "methods/regularized/pace.h"

#include <algorithm>
#include <cmath>

namespace littoral {

bool Pace::hopeful(int iterations, double residual) {
  least_ = std::min(least_, residual);
  if (iterations < mark_) return true;
  const double fallen = std::log(least_at_mark_ / least_);  // in the last third of all iterations
  least_at_mark_ = least_;
  mark_ *= further_;
  return 10 / (1 - 1 / further_) * fallen >= std::log(least_);
}

}  // namespace littoral
