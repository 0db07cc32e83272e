"""The matrices of a surface as scipy.sparse, and their factorizations."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from . import _core
from ._arguments import truth
from ._arrays import Array, Floats, Ints, as_array
from ._errors import InputError
from ._foreign import as_surface
from ._settings import settings


@dataclass(frozen=True)
class Operators:
    """Operators of a surface; matrices are `scipy.sparse.csc_matrix`.

    L: vertices x vertices, weak -Laplacian: symmetric, positive semidefinite, rows sum to 0.
    M: vertices, lumped mass [length^2]. On triangle meshes, G: 3 faces x vertices, gradients in
    space, three rows a face [1 / length]; A: faces, areas [length^2]; D: vertices x 3 faces, weak
    -divergence G^T A; no rows elsewhere. connection: the Hermitian connection Laplacian of vectors
    as complex numbers, on the edges of triangle meshes (real axis along the edge, imaginary axis to
    its left) and at the vertices of other surfaces; 0 x 0 on triangle meshes without sides.
    connection_mass: its lumped mass [length^2]. vector_at: edges x 2, where vectors live, or empty.
    Source: Feng, Crane, A Heat Method for Generalized Signed Distance (2024), sections 5 and 8.

    >>> import littoral
    >>> square = littoral.examples.square(2)
    >>> ops = littoral.operators(square)
    >>> (ops.G @ square.points[:, 0])[::3].round(6).tolist()
    [1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0]
    """

    L: Any
    M: Floats
    G: Any
    A: Floats
    D: Any
    connection: Any
    connection_mass: Floats
    vector_at: Ints


def operators(mesh: Any, *, threads: int | None = None) -> Operators:
    """The operators of a surface (see `Operators`); needs scipy. ArgumentError for no surface.

    >>> import littoral
    >>> ops = littoral.operators(littoral.examples.square(2))
    >>> ops.L.shape, round(float(ops.M.sum()), 12)
    ((9, 9), 1.0)
    """
    core = _core.surface_operators(as_surface(mesh)._handle, settings(threads))
    return Operators(
        core.L, core.M, core.G, core.A, core.D, core.connection, core.connection_mass,
        core.vector_at,
    )  # fmt: skip


class Factorization:
    """A symmetric or Hermitian positive definite matrix, factored once; may be shared by threads.

    A: n x n, scipy.sparse, of which the lower triangle is read. laplacian: A is positive
    semidefinite and its null space is the constants on each connected part. Raises InputError for a
    matrix that is not square or not finite, SolveError if it is not what it is said to be.

    >>> import numpy as np, littoral
    >>> ops = littoral.operators(littoral.examples.square(4))
    >>> poisson = Factorization(ops.L, laplacian=True)
    >>> x = ops.M - ops.M.mean()
    >>> bool(np.allclose(ops.L @ poisson.solve(x), x))
    True
    """

    def __init__(self, A: Any, *, laplacian: bool = False, threads: int | None = None) -> None:
        import scipy.sparse

        if not scipy.sparse.issparse(A):
            A = as_array(A, "A")
            if A.ndim != 2 or A.dtype.kind not in "biufc":
                raise InputError(f"A: expected n x n numbers, got {A.dtype} {A.shape}")
        matrix = scipy.sparse.csc_matrix(A)
        matrix.sort_indices()
        self._complex = np.iscomplexobj(matrix)
        self._laplacian = truth(laplacian, "laplacian")
        if self._complex and laplacian:
            raise InputError("laplacian: a complex matrix has no constants as null space")
        # A copy, for copies and pickles of this, which factor it again.
        self._matrix = matrix.astype(np.complex128 if self._complex else np.float64)
        if self._complex:
            self._handle = _core.Factorization.complex(self._matrix, settings(threads))
        else:
            self._handle = _core.Factorization.real(
                self._matrix, self._laplacian, settings(threads)
            )

    def solve(self, b: Any, *, threads: int | None = None) -> Array:
        """A^-1 b for b of length n, or for each column of n x k.

        Of a Laplacian: for b without its mean over each connected part, the solution that has none.
        Raises InputError for b of another kind.
        """
        given = as_array(b, "b")
        if given.ndim not in (1, 2) or given.dtype.kind not in "biufc":
            raise InputError(f"b: expected n or n x k numbers, got {given.dtype} {given.shape}")
        columns = given[:, None] if given.ndim == 1 else given
        if self._complex:
            out: Array = self._handle.solve_complex(
                columns.astype(np.complex128), settings(threads)
            )
        elif np.iscomplexobj(columns):
            real, imaginary = (
                self.solve(part, threads=threads) for part in (given.real, given.imag)
            )
            return real + 1j * imaginary
        else:
            out = self._handle.solve(columns.astype(np.float64), settings(threads))
        return np.asarray(out).reshape(given.shape)

    @property
    def nonzeros(self) -> float:
        """How many numbers other than 0 the factor holds."""
        return self._handle.nonzeros

    def __reduce__(self) -> tuple[Any, ...]:
        return _factorization_from, (self._matrix, self._laplacian)

    def __repr__(self) -> str:
        return (
            f"<littoral.Factorization: {self._handle.size} unknowns, {self.nonzeros:.0f} nonzeros>"
        )


def _factorization_from(A: Any, laplacian: bool) -> Factorization:
    return Factorization(A, laplacian=laplacian)
