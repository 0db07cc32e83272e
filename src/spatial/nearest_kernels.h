#pragma once
// What searches for the nearest triangle do to many triangles or nodes at once, by the widest
// instructions the processor has. Which ones changes nothing in the results.

#include <array>

namespace littoral {

constexpr int nearest_lanes = 8;

/// Corners a, b, c of eight triangles: ax ay az bx ...
struct CornerLanes {
  alignas(32) std::array<std::array<float, nearest_lanes>, 9> corner;
};

/// Balls about eight groups of triangles.
struct BallLanes {
  alignas(32) std::array<float, nearest_lanes> x, y, z, radius;
};

/// The way from a point to each of them, about, and its squared length.
struct WayLanes {
  alignas(32) std::array<std::array<float, nearest_lanes>, 3> way;
  alignas(32) std::array<float, nearest_lanes> squared;
};

/// A box about a point, and for each corner of it (bits of the number: x, y, z) a radius.
struct BoxWithBalls {
  std::array<float, 3> centre, half;
  std::array<float, 8> radius;
  float slack;  // for rounding
};

/// One triangle seen by many nodes.
template <class Real>
struct NearTriangle {
  std::array<std::array<Real, 3>, 3> corner;
  std::array<std::array<Real, 3>, 3> edge;    // from each corner to the next
  std::array<Real, 3> per_length;             // 1 / squared length, 0 without a length
  std::array<Real, 3> normal;                 // of any length
  std::array<std::array<Real, 3>, 3> inward;  // across edges, in the plane, of any length
  Real per_normal = 0;                        // 1 / squared length of the normal
};

/// Eight places.
struct PlaceLanes {
  alignas(32) std::array<float, nearest_lanes> x, y, z;
};

/// Places, a multiple of eight, with what is nearest to them so far.
struct NearNodes {
  const double *x, *y, *z;
  int n;
  double *squared, *nearest;
};

/// One of several, and where to say that it may be nearest.
struct RoughTriangle {
  const NearTriangle<float>* triangle;
  char* may_be;
};

struct NearestKernels {
  void (*put_ball)(const CornerLanes&, BallLanes&, int lane);
  /// A bit for each ball that meets the convex hull of those of the box, or may; `far` gets one for
  /// each that is small beside its distance from the box's centre.
  unsigned (*balls_within)(const BallLanes&, const BoxWithBalls&, unsigned& far);
  /// To the nearest points of the triangles. Returns the least of the squared lengths.
  float (*ways)(const CornerLanes&, const float* from, WayLanes&);
  /// To their middles, for triangles that are small beside their distance.
  float (*ways_to_middles)(const CornerLanes&, const float* from, WayLanes&);
  /// A bit for each triangle that meets the convex hull of the balls, or may.
  unsigned (*within)(const CornerLanes&, const WayLanes&, const BoxWithBalls&);
  /// Squared distances that no point of the triangles is nearer than, less by about 1e-6 of the
  /// distances and of the size of the coordinates; `most` becomes one that one of them does not
  /// exceed, if that is less. Returns a bit for each triangle within it.
  unsigned (*bounds)(const CornerLanes&, const float* from, float& most, float* squared);
  /// Which of n triangles may be nearest to one of the places: those not farther than the nearest
  /// by more than `slack` and 4e-6 of the distance. `room` is for eight numbers each.
  void (*candidates)(const RoughTriangle*, int n, const PlaceLanes&, float slack, float* room);
  /// Where the triangle is nearer than what was, `nearest` becomes `number`.
  void (*look)(const NearTriangle<double>&, double number, const NearNodes&);
};

/// The fastest ones for the processor that runs the program.
const NearestKernels& nearest_kernels();

}  // namespace littoral
