#pragma once
// What is done to each window of an edge on its way through a triangle, for several at once.

#include <cstddef>
#include <cstdint>

#include "methods/geodesic/window_block.h"

namespace littoral {

/// Column by column; every column is so long that reading or writing a few numbers before the first
/// and beyond the last window is harmless.
struct RayColumns {
  static constexpr int spare = 8;

  // As windows come, in the coordinates of the edge below (`Window`, `WindowTag`).
  const double *b0, *b1, *d0, *d1, *x, *y, *behind;
  const std::int64_t* tag;
  // > 0: the far corner lies left of the ray at the window's start, end.
  double *apex0, *apex1;
  // As they leave, in the coordinates of the edge they leave through.
  double *to0, *to1, *to_d0, *to_d1, *to_x, *to_y, *to_behind;
  // Where window i and window i + 1 are equally far there, and how far by the two: of the one
  // nearer to the tail, and of the other.
  double *cut, *cut_first, *cut_second;
  std::int64_t* covers;  // all bits if rays of the window reach the far corner
  std::int64_t* goes;    // sides of the far corner: 1 left, 2 right
  std::int64_t* ends;    // 1, 2: an end of the edge reaches the window's start, end sooner; 4:
                         // narrow; 8: does not go there
  std::int64_t* meets;   // window i + 1: `apart`, ...
  /// Not 0: windows i and i + 1 go there as they are but for the cut between them, if the one
  /// nearer to the tail starts where it left or is cut from the one before it.
  std::int64_t* follows;
};

/// What becomes of two neighbours on an edge: do they overlap, is it clear where to cut them?
inline constexpr std::int64_t apart = 0, cut_once = 1, unclear = 2;

/// What tells to which sides of the far corner a window goes on.
struct CornerNumbers {
  double apex_x, apex_y;
  /// Of the ray that reaches the corner soonest: it crosses between these, and has this distance
  /// there.
  double from, to, nearest;
  double far, slack;  // distance of the corner; nearer by less is a tie
  std::int64_t most_straight;
};

/// The side that windows leave through, as `RayExit` has it, and its ends.
struct ExitNumbers {
  double triangle_length, apex_x, apex_y;  // of the triangle, above the edge
  bool right, from_apex;
  double length, tail_x, tail_y, along_x, along_y, up_x, up_y;
  double tail, head, tail_slack, head_slack;  // distance at the ends, and what counts as a tie
  double edge_length;                         // triangles may differ from it in the eleventh digit
  double narrow, slack_share;

  bool turned() const { return right != from_apex; }
};

struct RayKernels {
  /// No window but covering[0], ..., covering[1] - 1 has rays that reach the far corner.
  void (*look_at_apex)(const RayColumns& c, int n, double apex_x, double apex_y, double tolerance,
                       int covering[2]);
  /// Rays beyond those that reach the far corner soonest do not cross them: one angle, one split.
  /// Beyond the line from an end of a window to the far corner, that corner may be nearer.
  void (*see_where_to)(const RayColumns& c, int n, const CornerNumbers& corner);
  /// Windows first, ..., last - 1, and a few beside them.
  void (*leave_through)(const RayColumns& c, int first, int last, const ExitNumbers& exit);
  /// Writes windows first, ..., last - 1 of those that have left, each cut from the ones before and
  /// after it, to `to` from window `at` on; in the opposite order if `turned`.
  void (*put)(const RayColumns& c, int first, int last, bool turned, std::uint16_t page,
              WindowBlock& to, std::size_t at);
};

/// For any processor.
extern const RayKernels plain_ray_kernels;
/// The fastest ones for the processor that runs the program: the same bits.
const RayKernels& ray_kernels();

}  // namespace littoral
