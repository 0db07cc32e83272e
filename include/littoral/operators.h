#pragma once
// The matrices that the heat methods work with, and their factorizations, for methods of one's own.

#include <memory>

#include "littoral/context.h"
#include "littoral/mesh.h"
#include "littoral/types.h"

namespace littoral {

/// Operators of a surface in the units of the input. Functions have values at vertices; vectors,
/// as complex numbers, live on the edges of triangle meshes (real axis along the edge, imaginary
/// axis to its left as its first face sees it) and at the vertices of other surfaces.
/// Feng, Crane: A Heat Method for Generalized Signed Distance (2024), sections 5 and 8.
struct SurfaceOperators {
  SpMat L;  // vertices x vertices; weak -Laplacian: symmetric, positive semidefinite, rows sum to 0
  VecX M;   // vertices; lumped mass [length^2]
  SpMat G;  // 3 faces x vertices; gradients in space, three rows a face [1 / length]; of triangle
            // meshes, no rows elsewhere
  VecX A;   // faces; areas [length^2]; likewise
  SpMat D;  // vertices x 3 faces; weak -divergence G^T A of vectors in space [length]; likewise
  SpMatC connection;       // edges or vertices, squared; connection Laplacian, Hermitian, positive
                           // semidefinite; empty where the surface has no sides to tell left from
                           // right by
  VecX connection_mass;    // edges or vertices [length^2]
  Rows<int, 2> vector_at;  // edges x 2: the vertices that vectors live between; or no rows
};

/// Throws InputError and UnsupportedError as `distance`, Cancelled.
SurfaceOperators surface_operators(const Mesh& mesh, const Context& context = {});

/// What a symmetric (or Hermitian) matrix is known to be.
enum class Definite {
  yes,        // positive definite
  laplacian,  // positive semidefinite: its null space is the constants on each connected part
};

/// A matrix factored once, to solve with many right-hand sides. Copies share the factor; `solve`
/// may be called from several threads.
class Factorization {
 public:
  /// Of the lower triangle of A (n x n). Throws InputError for a matrix that is not square or holds
  /// numbers that are not finite, SolveError if it is not what it is said to be, Cancelled.
  explicit Factorization(const SpMat& A, Definite definite = Definite::yes,
                         const Context& context = {});
  explicit Factorization(const SpMatC& A, const Context& context = {});

  /// A^-1 B for each column of B (n x columns). Of a Laplacian: B without its mean over each
  /// connected part, and the solution that has none. Throws InputError for a wrong number of rows
  /// or numbers that are not finite, and where B and the matrix are not both real or both complex.
  MatX solve(const MatX& B, const Context& context = {}) const;
  Eigen::MatrixXcd solve(const Eigen::MatrixXcd& B, const Context& context = {}) const;

  int size() const;
  double nonzeros() const;  // of the factor

 private:
  struct Impl;
  std::shared_ptr<const Impl> impl_;
};

}  // namespace littoral
