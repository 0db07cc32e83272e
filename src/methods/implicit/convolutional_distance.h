#pragma once
// Distance as a sum of kernels over oriented samples (thesis chapter 3, eq. 5.8 and 5.9).

#include <memory>

#include "methods/implicit/pointwise.h"
#include "sources/space/oriented_points.h"

namespace littoral {

/// Signed Hopf-Cole distance, eq. 5.8: the logarithm of the screened winding number. Good far from
/// perfect geometry; near sampled geometry the kernel is singular at the samples.
/// lambda [1/length] > 0: how fast kernels decay.
std::unique_ptr<const PointwiseDistance> hopf_cole_distance(const OrientedPoints& samples,
                                                            double lambda);

/// Smoothed planar distance, eq. 5.9: the mean of the distances to the samples' tangent planes,
/// weighted by area and by exp(-lambda r).
std::unique_ptr<const PointwiseDistance> planar_distance(const OrientedPoints& samples,
                                                         double lambda);

/// LogSumExp distance (eq. 3.15 with h = 1, areas relative to their mean), with the sign of the
/// generalized winding number.
std::unique_ptr<const PointwiseDistance> log_sum_exp_distance(const OrientedPoints& samples,
                                                              double lambda);

}  // namespace littoral
