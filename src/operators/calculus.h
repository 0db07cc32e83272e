#pragma once
// The operators a method may use: all it ever sees of a domain. Each discretization is translated
// into this once (operators/triangles.cpp, ...); each method is written against it once.
//
// Vector fields are given by vectors at edges or nodes, whichever the discretization puts them at:
// its vector degrees of freedom, `dofs` for short. Vectors are complex numbers in the frame of
// their dof or cell, stored as interleaved pairs of reals: entry 2 i is the real, 2 i + 1 the
// imaginary part. Symmetric matrices store their lower triangle only. All lengths are in `unit`s of
// the domain.

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/movable.h"
#include "base/shared_rows.h"
#include "base/task.h"
#include "littoral/types.h"
#include "operators/linear_map.h"
#include "solve/direct/hermitian_rows.h"

namespace littoral {

/// Scalar functions: values at nodes, gradients at cells.
struct Calculus {
  Movable<SpMat> L;            // nodes x nodes, lower triangle; positive semidefinite, L = -Delta
  VecX M;                      // nodes; lumped mass [length^2]
  LinearMap G;                 // 2 cells x nodes; gradient in each cell's frame
  VecX A;                      // cells; measure [length^2]
  double h = 0;                // mean distance between neighbouring nodes [length]
  std::vector<int> component;  // nodes; -1 for nodes that belong to no cell
  int n_components = 0;
  std::vector<char> boundary;  // nodes; 1 on the boundary

  /// G^T A Y: the weak form of -div Y with natural boundary conditions (eq. 3, 13), 2 cells ->
  /// nodes.
  VecX divergence(const VecX& Y) const;
};

/// A node where pieces touch that no dof connects (two cubes sharing a vertex): what flows out of
/// the node into one of the pieces.
struct Pinch {
  int node;                                     // of the scalar calculus
  int piece;                                    // of the dofs
  std::vector<std::pair<int, Complex>> radial;  // dof, unit-mass radial measure (eq. 19)
};

/// Vector fields that can be diffused: the connection Laplacian on the dofs.
struct VectorDiffusion {
  int n = 0;  // dofs
  VecX M;     // dofs; lumped mass [length^2]
  // The largest matrices there are, made when they are asked for:
  std::function<SpMatC(const Task&)> L;      // dofs x dofs, lower triangle, Hermitian positive
                                             //   semidefinite; none if frames cannot be chosen so
                                             //   that it is complex-linear
  std::function<SpMat(const Task&)> L_real;  // then: 2 dofs x 2 dofs, lower triangle, symmetric
  // The rows of L where they need not be kept, else empty:
  std::function<std::shared_ptr<const HermitianRows<Complex>>()> L_rows;
  SharedRows<int, 2> ends;  // dofs x 2: the nodes a dof lies between; none where dofs are not edges
  bool at_nodes = false;    // dofs are the nodes of the scalar calculus, coupled as in its L
  LinearMap to_cells;       // 2 cells x 2 dofs; mean of a cell's dofs, in the cell's frame; `apply`
                            //   alone
  double h = 0;             // mean distance between neighbouring dofs [length]
  std::vector<int> piece;   // dofs; connected pieces of the diffusion, -1 for unused dofs
  int n_pieces = 0;
  std::vector<Pinch> pinches;

  bool complex_linear() const { return static_cast<bool>(L); }
};

/// One domain's operators.
struct Operators {
  std::string domain;  // "triangle mesh"
  double unit = 1;     // [length] of one unit in the input's coordinates
  Calculus scalar;
  VectorDiffusion vector;
};

}  // namespace littoral
