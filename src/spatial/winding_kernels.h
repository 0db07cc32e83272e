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

/// A cluster as in ClusterLanes, for eight points at once.
struct GroupCluster {
  float x, y, z, radius;
  int child;  // two at child and child + 1, or -1 - leaf
  std::array<float, dipole_coefficients> moments;
};

/// A field without sources about the centre of a cell: harmonic polynomials of the same degrees and
/// in the same order in places divided by the radius of the cell, and a constant.
struct LocalField {
  std::array<float, dipole_coefficients> moments{};
  float constant = 0;
};

/// Eight points and what is summed up at them.
struct PointLanes {
  alignas(32) std::array<float, winding_lanes> x, y, z, sum;
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
  /// Adds the field of a far cluster, at points; of a cell, at points relative to it.
  void (*add_field)(const GroupCluster&, PointLanes&);
  void (*add_local)(const LocalField&, PointLanes&);
  /// As add_field, but to those points only whose bits are in `of` and whose squared distances,
  /// times `share`, are above the squared radius; returns the others of them.
  unsigned (*add_where_far)(const GroupCluster&, float share, unsigned of, PointLanes&);
  /// Sum of the angles arg(den + i num). False where rounding may matter: an angle may be off by
  /// more than 1e-4, or have the wrong sign.
  bool (*narrow_angles)(const NarrowTriangleLanes&, const double* q, float& sum);
  void (*angles)(const TriangleLanes&, const double* q, AngleLanes&);
  double (*dipoles)(const DipoleLanes&, const double* q);
};

/// The fastest ones for the processor that runs the program.
const WindingKernels& winding_kernels();

}  // namespace littoral
