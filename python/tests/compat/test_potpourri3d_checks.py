"""potpourri3d's checks of arguments: what they refuse, alone and side by side."""

from __future__ import annotations

import inspect

import numpy as np
import pytest

import littoral.compat.potpourri3d as pp3d

CORNERS = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
TWO_FACES = np.array([[0, 1, 2], [1, 2, 3]])


def test_arguments_are_checked():
    assert pp3d.validate_points(CORNERS.tolist()) is None
    assert pp3d.validate_mesh(CORNERS, [[0, 1, 2], [0, 1, 2, 3]], test_indices=True) is None
    with pytest.raises(IndexError, match=r"F\[1, 2\] is 4: there are 4 vertices"):
        pp3d.validate_mesh(CORNERS, TWO_FACES + np.array([[0], [1]]), test_indices=True)
    with pytest.raises(IndexError, match=r"F\[1\]\[3\] is -1"):
        pp3d.validate_mesh(CORNERS, [[0, 1, 2], [0, 1, 2, -1]], test_indices=True)
    with pytest.raises(ValueError, match=r"F\[1\]: expected triangles, got 4 corners"):
        pp3d.validate_mesh(CORNERS, [[0, 1, 2], [0, 1, 2, 3]], force_triangular=True)
    with pytest.raises(TypeError, match="V: expected real numbers"):
        pp3d.validate_points(CORNERS.astype(complex))


@pytest.mark.parametrize(
    ("V", "F", "options"),
    [
        (CORNERS, TWO_FACES, {}),
        (CORNERS.astype(np.float32), TWO_FACES.astype(np.uint8), {"force_triangular": True}),
        (CORNERS.astype(int), TWO_FACES, {"test_indices": True}),
        (CORNERS, [[0, 1, 2], [0, 1, 2, 3]], {}),
        (CORNERS, np.array([[0, 1, 2, 3]]), {}),
        (CORNERS, np.array([[0, 1, 2, 3]]), {"force_triangular": True}),
        (CORNERS, TWO_FACES[:, :2], {}),
        (CORNERS, TWO_FACES.ravel(), {}),
        (CORNERS[:, :2], TWO_FACES, {}),
        (CORNERS.ravel(), TWO_FACES, {}),
        (CORNERS[None], TWO_FACES, {}),
        (CORNERS * np.nan, TWO_FACES, {}),
        (CORNERS[:0], TWO_FACES[:0], {}),
    ],
)
def test_the_real_one_refuses_the_same_arguments(V, F, options):
    real = pytest.importorskip("potpourri3d")

    def refuses(call, *arguments):
        try:
            assert call(*arguments) is None
        except ValueError:
            return True
        return False

    assert refuses(lambda: pp3d.validate_mesh(V, F, **options)) == refuses(
        lambda: real.validate_mesh(V, F, **options)
    )
    assert refuses(pp3d.validate_points, V) == refuses(real.validate_points, V)
    for name in ("validate_mesh", "validate_points"):
        theirs, ours = (inspect.signature(getattr(m, name)).parameters for m in (real, pp3d))
        assert [(p.name, p.default) for p in theirs.values()] == [
            (p.name, p.default) for p in ours.values()
        ]
