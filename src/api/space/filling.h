#pragma once
// Signed heat through tets that fill the box of a grid.

#include "api/space/space_domain.h"

namespace littoral {

/// The method for domains whose grid's box is filled with tets: by a lattice as small as the grid's
/// cells near the input and larger far from it (thesis 4.5), or by tetgen, whose tets have the
/// triangles of the input as faces and sides that grow from one grid spacing next to it to eight at
/// the box.
///
/// Through tetgen's: throws UnsupportedError for clouds and where the program is not installed;
/// InputError if the box does not hold the whole input; SolveError if the program fails, crashes,
/// hangs or answers nonsense, which it does for surfaces that cross themselves.
Method<SpaceDomain> heat_filling_method(MethodInfo info);

}  // namespace littoral
