#pragma once
// Functions that jump by given amounts across a curve and are harmonic elsewhere (eq. 6.2).

#include <vector>

#include "base/task.h"
#include "littoral/report.h"
#include "operators/jump_calculus.h"
#include "operators/jump_delaunay.h"

namespace littoral {

/// Values at corners. `open` marks nodes where no value makes all jumps right, the ends of curves:
/// there a function takes every value between those at the opposite side, and `u` is their mean.
struct CornerFunction {
  MatX3 u{0, 3};           // faces x 3
  std::vector<char> open;  // nodes
};

/// Corner offsets that realise jumps round every node: offset + one value per node jumps by
/// `jump` (edges; left minus right). Nodes where the jumps met on the way round do not cancel, to
/// 1e-6, are open; offsets there are 0.
CornerFunction jump_offsets(const JumpCalculus& J, const VecX& jump);

/// What a jump harmonic function does at the boundary of the surface.
enum class Boundary {
  natural,  // no flow across it
  level,    // one constant along each stretch of it that the curve does not touch; no flow in all
};

/// Step 1: the solution of the jump Laplace equation, open nodes left out. Mean 0 over each
/// component. Where there is a `field` (faces, in their frames; or empty) it solves
/// Delta u = div field instead.
CornerFunction solve_jump_laplace(const JumpCalculus& J, const VecX& jump, const VecXc& field,
                                  Boundary boundary, const Task& task, Report& report);

/// The same, solved on Delaunay triangles that keep the edges across which it jumps.
CornerFunction solve_jump_laplace(const JumpCalculus& J, const DelaunayJumps& on, const VecX& jump,
                                  Boundary boundary, const Task& task, Report& report);

/// Step 2: the Darboux derivative, df without the jumps; 0 on edges at open nodes. A 1-form.
VecX darboux_derivative(const JumpCalculus& J, const CornerFunction& f);

/// Jumps across edges, left minus right, the mean over both ends. edges.
VecX jump_derivative(const JumpCalculus& J, const MatX3& u);

}  // namespace littoral
