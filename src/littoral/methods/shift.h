#pragma once
// What every heat method does last: fix the free constants and mark what no source reaches.

#include "littoral/base/report.h"
#include "littoral/operators/calculus.h"
#include "littoral/sources/source_terms.h"

namespace littoral {

/// Shifts phi (nodes) on each component to mean zero along the component's sources (Alg. 13).
void shift_to_mean_zero(const Calculus& C, const SourceTerms& terms, VecX& phi);

/// phi in units of the input, +inf on components and nodes that no source reaches; lists them.
VecX finish_field(const Operators& ops, const SourceTerms& terms, const VecX& phi, Report& report);

}  // namespace littoral
