#pragma once
// Sharpening of a signed distance (Feng & Crane 2024, section 7.3): gradient at most 1, as far from
// zero as that allows, and everywhere the sign that it had.

#include "base/task.h"
#include "littoral/options.h"
#include "littoral/report.h"
#include "operators/calculus.h"
#include "sources/systems/source_system.h"

namespace littoral {

struct SharpenOptions {
  SharpenSolver solver = SharpenSolver::admm;
  double tolerance = 2e-3;  // of both residuals, relative
  int max_iterations = 10000;
};

/// Maximises the integral of sign(phi0) phi subject to |grad phi| <= 1 and phi = 0 at the sources
/// (eq. 18). Where phi0 changes sign within a cell its own zero set is kept, also in gaps of the
/// source: at the nodes of such cells 0 <= sign(phi0) phi <= the distance from that zero set. phi0:
/// nodes [length of the input], where the iteration starts; +inf where no source reaches, which
/// stays. Operators of surfaces, tets and grids alike; in space, many nodes are solved for by
/// multigrid, a few steps in each iteration, instead of a factor. Every component is a
/// problem of its own: norms, tolerances and iterations.
VecX sharpen(const Operators& ops, const SourceSystem& system, const VecX& phi0,
             const SharpenOptions& options, const Task& task, Report& report);

/// The same in space, where the source is rows (rows x nodes) at which phi vanishes and a component
/// without a row has no source.
VecX sharpen_in_space(const Operators& ops, const SpMat& rows, const VecX& phi0,
                      SharpenSolver solver, const Task& task, Report& report);

}  // namespace littoral
