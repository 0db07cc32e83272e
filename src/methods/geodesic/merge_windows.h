#pragma once
// Windows that differ by less than matters become one.

#include <cstddef>
#include <optional>

#include "methods/geodesic/window_block.h"
#include "methods/geodesic/window_kernels.h"

namespace littoral {

/// One window in place of windows begin, ..., end - 1, if they are of one source through one
/// triangle and it is as near as `how` asks; `changed` grows to the most by which a distance does.
std::optional<Window> one_of(const WindowBlock& windows, std::size_t begin, std::size_t end,
                             const Joining& how, double& changed);

/// Replaces neighbours on an edge of the given length, from one source through one triangle, by one
/// window where that changes no distance on the edge by more than its share `tolerance`, less the
/// `error` that distances here have already. Returns the most by which one changed. Windows that
/// have gone on and those of parallel rays are left alone. See docs/theory/derivations.md.
double merge_windows(WindowBlock& all, double length, double tolerance, double error);

}  // namespace littoral
