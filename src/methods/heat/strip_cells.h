#pragma once
// Gradients in cells and what flows out of nodes, for strips of functions: one pass over the cells
// from diffused heat to the right-hand sides of Poisson problems.

#include <vector>

#include "operators/calculus.h"
#include "solve/direct/strip.h"

namespace littoral {

/// G of a calculus, cell by cell: what the rows of a strip add to a cell's gradient. Cells lie in
/// the order of their first rows.
struct StripCells {
  std::vector<int> begin;     // cells + 1
  std::vector<int> row;       // of a strip
  std::vector<double> slope;  // 2 for each of them
  std::vector<double> area;   // cells
  std::vector<int> place;     // cells of the calculus: where they are here

  /// row_of: where the strips have each node.
  StripCells(const Calculus& C, const std::vector<int>& row_of);

  int size() const { return static_cast<int>(area.size()); }
};

/// Gradients no longer than this are none, as in cell_field.
inline constexpr double no_gradient = 1e-290;

/// Of cells first to end: b := b + G^T A Y with Y = -grad u / |grad u|; cells that are `apart` are
/// left out. longest (strip_width): the largest component of any gradient, column by column, or
/// what was there.
using StripDivergence = void(const StripCells& cells, int first, int end, const char* apart,
                             const double* u, double* b, double* longest);
/// sums (3 x strip_width) grows by the areas of all cells with directions Y, of those where phi
/// does not rise along them, and of those whose gradient of phi is off unit length.
using StripShares = void(const StripCells& cells, int first, int end, const char* apart,
                         const double* u, const double* phi, double* sums);

struct StripCellKernels {
  StripDivergence* divergence;
  StripShares* shares;
};
/// The fastest that run here; all give the same bits.
const StripCellKernels& strip_cell_kernels();
extern const StripCellKernels plain_strip_cell_kernels;

}  // namespace littoral
