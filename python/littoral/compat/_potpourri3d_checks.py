"""The checks of arguments that potpourri3d exports."""

from __future__ import annotations

from typing import Any

import numpy as np

from .._arrays import as_array, check_range, floats, unwrapped
from .._errors import InputError


def validate_points(V: Any) -> None:
    """Raises InputError (a ValueError) unless V is points x 3, TypeError for what is no numbers.

    >>> validate_points([[0, 0, 0], [1, 0, 0]])
    """
    floats(V, "V", 3, finite=False)


def validate_mesh(
    V: Any, F: Any, force_triangular: bool = False, test_indices: bool = False
) -> None:
    """Raises InputError (a ValueError) unless V is vertices x 3 and F faces x 3 or more.

    F may be a list of faces with different numbers of corners. force_triangular: three corners
    alone will do. test_indices: raises IndexOutOfRange (an IndexError) for the first corner that is
    no vertex; potpourri3d 1.4 has this argument, but raises for no index.

    >>> validate_mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], test_indices=True)
    """
    validate_points(V)
    given = unwrapped(F, "F")
    whole = isinstance(given, np.ndarray)
    for i, face in enumerate([given] if whole else given):
        name = "F" if whole else f"F[{i}]"
        array = as_array(face, name)
        if array.ndim != (2 if whole else 1) or array.shape[-1] < 3:
            shape = "faces x corners" if whole else "corners"
            raise InputError(f"{name}: expected {shape}, at least 3, got shape {array.shape}")
        if force_triangular and array.shape[-1] != 3:
            raise InputError(f"{name}: expected triangles, got {array.shape[-1]} corners")
        if test_indices:
            check_range(array, len(as_array(V, "V")), name, "vertices")
