#pragma once
// What every heat method does last: exact directions next to points, free constants, and what no
// source reaches.

#include "littoral/report.h"
#include "operators/calculus.h"
#include "sources/systems/source_system.h"

namespace littoral {

/// Replaces the vectors Y (2 cells) of cells that touch isolated points by grad d0, the gradient of
/// the exact distance there.
void set_near(const Calculus& C, const SourceSystem& system, VecX& Y);

/// Shifts phi (nodes) on each component so that it deviates from the values of the component's
/// sources by zero in the mean (Alg. 13).
void shift_to_mean_zero(const Calculus& C, const SourceSystem& system, VecX& phi);

/// phi is +inf where no source reaches: on components that `reached` is 0 for, which are listed,
/// and at nodes of none (component -1).
void set_unreached(VecX& phi, const std::vector<int>& component, const std::vector<char>& reached,
                   Report& report);

/// Lists and warns of components that `reached` is 0 for, and of nodes among the first `nodes` that
/// are in none (component -1).
void report_unreached(const std::vector<int>& component, int n_components,
                      const std::vector<char>& reached, Eigen::Index nodes, Report& report);

/// phi in units of the input, +inf on components and nodes that no source reaches; lists them
/// and warns of them.
VecX finalize_field(const Operators& ops, const SourceSystem& system, const VecX& phi,
                    Report& report);

/// The same for methods that have no operators: the component of each node (-1: in no cell), the
/// length of one unit, and which components hold a source.
VecX finalize_field(const std::vector<int>& component, int n_components, double unit,
                    const std::vector<char>& reached, const VecX& phi, Report& report);

}  // namespace littoral
