#pragma once
// Vectors at cells whose lengths span more than the range of a double.

#include <vector>

#include "operators/linear_map.h"
#include "solve/heat/heat_system.h"

namespace littoral {

/// Unit vectors and the logarithms of the lengths they had. Cells without a vector hold 0 and
/// -infinity.
struct CellField {
  VecX Y;           // 2 cells
  VecX log_length;  // cells
};

/// No vector anywhere.
CellField no_field(Eigen::Index cells);

/// A linear map of a decaying solution to vectors at cells, each cell evaluated in the units of its
/// own layer.
CellField cell_field(const LinearMap& map, const ScaledField<double>& field);

/// HeatSystem::solve scales every piece of its right-hand side b to largest entry 1; this undoes
/// it. `piece` as given to solve, for blocks of b.
void restore_units(ScaledField<double>& field, const HeatSource<double>& b,
                   const std::vector<int>& piece);

/// Replaces the vectors of `field` wherever those of `other`, times exp(log_factor), are longer.
void take_longer(CellField& field, const CellField& other, double log_factor = 0);

/// Unit vectors; zero stays zero. The largest component is divided out first: a squared norm
/// underflows at 1e-154.
VecX normalize(VecX Y);

}  // namespace littoral
