#pragma once
// Sphere tracing: where rays meet a level set of a field that can be asked anywhere (thesis,
// section 5.2, figure 5.3; Hart 1996).

#include "methods/implicit/pointwise.h"

namespace littoral {

struct TraceOptions {
  double level = 0;      // [length] of the surface: an offset of the zero set
  double steepness = 1;  // of the field at most: steps are |phi - level| / steepness
  double tolerance = 0;  // [length] hits are this near to the level set; > 0
  int max_steps = 1000;  // then the ray is taken to miss
};

/// Where a ray meets the surface.
struct TraceHit {
  bool found = false;
  double t = 0;                // along the ray [length]
  Vec3 normal = Vec3::Zero();  // the gradient there, unit; towards larger values
};

/// The first place in [from, to] along origin + t direction (unit) where the field takes the level,
/// from either side. Steps are as long as nothing can be nearer; where a step is too long all the
/// same, because the field is steeper than it should be, the sign has changed and the place is
/// bracketed. Where the field jumps across the level, as it may far from the surface of an open
/// cloud, there is no surface.
TraceHit sphere_trace(const PointwiseDistance& field, const Vec3& origin, const Vec3& direction,
                      double from, double to, const TraceOptions& options);

/// A steepness for sphere tracing within a box, 1 to 2: blended fields are a little steeper than
/// distances. That which all but one in a hundred of 1024 places in the box and 1024 beside the
/// level set do not exceed, and a twentieth more. The same on every call.
double trace_steepness(const PointwiseDistance& field, const Vec3& low, const Vec3& high,
                       double level);

}  // namespace littoral
