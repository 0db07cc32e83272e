#pragma once
// What is done to each window of an edge on its way through a triangle, for several at once.

#include <cstdint>

namespace littoral {

/// Column by column; every column is long enough that reading or writing three numbers beyond the
/// last window is harmless.
struct RayColumns {
  static constexpr int spare = 8;

  // As windows come, in the coordinates of the edge below (`Window`).
  double *b0, *b1, *d0, *d1, *x, *y, *behind;
  double* parallel;  // 1 or 0
  // > 0: the far corner lies left of the ray at the window's start, end.
  double *apex0, *apex1;
  // As they leave, in the coordinates of the edge they leave through.
  double *to0, *to1, *to_d0, *to_d1, *to_x, *to_y, *to_behind;
  // Where window i and window i + 1 are equally far there, and how far by the two: of the one
  // nearer to the tail, and of the other.
  double *cut, *cut_first, *cut_second;
  std::int64_t* covers;  // all bits if rays of the window reach the far corner
  std::int64_t* goes;    // sides of the far corner: 1 left, 2 right; 4 perhaps not
  std::int64_t* ends;  // 1, 2: an end of the edge reaches the window's start, end sooner; 4: narrow
  std::int64_t* meets;  // window i + 1: `apart`, ...
};

/// What becomes of two neighbours on an edge: do they overlap, is it clear where to cut them?
inline constexpr std::int64_t apart = 0, cut_once = 1, unclear = 2;

/// The side that windows leave through, as `RayExit` has it, and its ends.
struct ExitNumbers {
  double triangle_length, apex_x, apex_y;  // of the triangle, above the edge
  bool right, from_apex;
  double length, tail_x, tail_y, along_x, along_y, up_x, up_y;
  double tail, head, tail_slack, head_slack;  // distance at the ends, and what counts as a tie
  double edge_length;                         // triangles may differ from it in the eleventh digit
  double narrow, slack_share;
};

struct RayKernels {
  void (*look_at_apex)(const RayColumns& c, int n, double apex_x, double apex_y, double tolerance);
  /// `crossing`: where the ray that is nearest to the far corner comes through. Windows whose
  /// starts (ends) lie beyond it, or are farther than `reach`, may not go left (right).
  void (*see_where_to)(const RayColumns& c, int n, double crossing, double reach);
  /// Windows first, ..., last - 1, and a few beside them.
  void (*leave_through)(const RayColumns& c, int first, int last, const ExitNumbers& exit);
};

/// For any processor.
extern const RayKernels plain_ray_kernels;
/// The fastest ones for the processor that runs the program: the same bits.
const RayKernels& ray_kernels();

}  // namespace littoral
