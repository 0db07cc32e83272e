#pragma once
// Windows that differ by less than matters become one.

#include "methods/geodesic/window_block.h"

namespace littoral {

/// Replaces neighbours on an edge of the given length, from one source through one triangle, by one
/// window where that changes no distance on the edge by more than its share `tolerance`, less the
/// `error` that distances here have already. Returns the most by which one changed. Windows that
/// have gone on and those of parallel rays are left alone. See docs/theory/derivations.md.
double merge_windows(WindowBlock& all, double length, double tolerance, double error);

}  // namespace littoral
