#pragma once
// Lengths of vectors in space that may be tiny or huge.

#include <cmath>

#include "littoral/types.h"

namespace littoral {

/// |v| without overflow or underflow of squares. Not Eigen's stableNorm(), whose order of summing,
/// and so the last bit, goes by where in memory the vector lies.
inline double stable_length(const Vec3& v) {
  const double squared = v.squaredNorm();
  if (squared > 1e-280 && squared < 1e300) return std::sqrt(squared);
  const double largest = v.cwiseAbs().maxCoeff();
  if (!(largest > 0) || !std::isfinite(largest)) return largest;
  return largest * (v / largest).norm();
}

}  // namespace littoral
