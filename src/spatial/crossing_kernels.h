#pragma once
// What crossing_number.h does to eight boxes, triangles or edges at once, by the widest
// instructions the processor has. Which ones changes nothing in the results.
//
// All looks along the x-axis, from the query at q towards larger x. A query on the seam of two
// triangles counts as moved by an amount too small to write down, up along z and by far less along
// y, so that every crossing is counted once (Edelsbrunner and Muecke, "Simulation of simplicity",
// 1990).

#include <array>
#include <cmath>

#include "spatial/winding_kernels.h"

namespace littoral {

/// Boxes of eight children across x, and where they end along it. Single precision: rounding is
/// monotone, so a number between two others stays there.
struct ShadowNode {
  using Lanes = std::array<float, winding_lanes>;
  alignas(32) Lanes low_y, high_y, low_z, high_z, high_x;
  std::array<int, winding_lanes> child;
};

/// Corners along a closed walk.
struct WalkView {
  const double *x, *y, *z;
  int n_edges;   // a multiple of `walk_lanes`; as many corners and eight more are readable
  double reach;  // no corner is farther from the query
};
constexpr int walk_lanes = 4 * winding_lanes;

/// Sum of the angles of the walk's edges as 2 pi turns + arg(re + i im).
struct WalkAngle {
  double re = 1, im = 0, turns = 0;
  /// One more factor of the product, and the turn it may complete.
  void turn_by(double more_re, double more_im) {
    const double r = re * more_re - im * more_im, i = re * more_im + im * more_re;
    const bool a = std::signbit(im), b = std::signbit(more_im), c = std::signbit(i);
    if (!a && !b && c) turns += 1;
    if (a && b && !c) turns -= 1;
    re = r;
    im = i;
  }
};

struct CrossingKernels {
  /// A bit for each child that the ray may meet.
  unsigned (*pierced)(const ShadowNode&, const float* q);
  /// Triangles that the ray leaves through their backs, less those it meets from the front.
  int (*crossings)(const TriangleLanes&, const double* q);
  /// False where an edge or a corner is too near the ray for it: see careful_angle.
  bool (*walk_angle)(const WalkView&, const double* q, WalkAngle&);
};

/// The fastest ones for the processor that runs the program.
const CrossingKernels& crossing_kernels();

/// The crossing of one triangle with corners (x, y, z) relative to the query: 1, -1 or 0.
int crossing(const double* a, const double* b, const double* c);

/// The angle under which an edge with ends relative to the query is seen from the ray's far end:
/// that of the triangle of both and of the direction opposite to the ray on the sphere.
double careful_angle(const double* a, const double* b);

}  // namespace littoral
