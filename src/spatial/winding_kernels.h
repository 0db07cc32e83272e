#pragma once
// The sums of winding_number.h over eight clusters, triangles or points at once, by the widest
// instructions the processor has. Which ones changes nothing in the results.

#include <array>

#include "spatial/dipole_moments.h"

namespace littoral {

constexpr int winding_lanes = 8;

/// Expansions of the fields of eight clusters, each about its own centre. Single precision: they
/// are far away.
struct ClusterLanes {
  using Lanes = std::array<float, winding_lanes>;
  alignas(32) Lanes x, y, z, radius;               // centre, and how far from it the items reach
  std::array<Lanes, dipole_coefficients> moments;  // DipoleMoments::coefficients(radius) / radius
};

/// Corners a, b, c of eight triangles; unused lanes hold one point three times.
struct TriangleLanes {
  alignas(64) std::array<std::array<double, winding_lanes>, 9> corner;  // ax ay az bx ...
};

/// The same triangles for queries that are not too near, as corners from a centre.
struct NarrowTriangleLanes {
  using Lanes = std::array<float, winding_lanes>;
  alignas(32) std::array<Lanes, 9> corner;
  std::array<double, 3> centre;
  float radius;  // how far from the centre the corners reach
};

/// Eight points with vector areas; unused lanes have area zero.
struct DipoleLanes {
  alignas(64) std::array<std::array<double, winding_lanes>, 3> at, area;
};

/// 2 arg(den + i num) is the solid angle of a triangle; |num| + |den| is 1, or both are 0.
struct AngleLanes {
  alignas(64) std::array<double, winding_lanes> num, den;
};

struct WindingKernels {
  /// Sum of the fields of the clusters whose squared radii are below `share` of their squared
  /// distances from q; `near` gets a bit for each of the others.
  float (*far)(const ClusterLanes&, const float* q, float share, unsigned& near);
  /// Sum of the angles arg(den + i num). False where rounding may matter: an angle may be off by
  /// more than 1e-4, or have the wrong sign.
  bool (*narrow_angles)(const NarrowTriangleLanes&, const double* q, float& sum);
  void (*angles)(const TriangleLanes&, const double* q, AngleLanes&);
  double (*dipoles)(const DipoleLanes&, const double* q);
};

/// The fastest ones for the processor that runs the program.
const WindingKernels& winding_kernels();

}  // namespace littoral
