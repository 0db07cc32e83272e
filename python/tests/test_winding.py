"""Winding numbers on Delaunay triangles of the same surface."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

import littoral


def moebius_band(n: int = 16, m: int = 16) -> tuple[littoral.Mesh, Callable[[int, int], int]]:
    """n x m quads, joined turned over; the number of vertex j of column i, on beyond the join."""

    def at(i: int, j: int) -> int:
        return i % n * (m + 1) + (m - j if i >= n else j)

    points = np.empty((n * (m + 1), 3))
    for i in range(n):
        a = 2 * np.pi * i / n
        out = np.array([np.cos(a), np.sin(a), 0])
        across = np.cos(a / 2) * np.array([0, 0, 1]) + np.sin(a / 2) * out
        for j in range(m + 1):
            points[at(i, j)] = 3 * out + (2 * j / m - 1) * across
    faces = []
    for i in range(n):
        for j in range(m):
            faces.append((at(i, j), at(i + 1, j), at(i + 1, j + 1)))
            faces.append((at(i, j), at(i + 1, j + 1), at(i, j + 1)))
    return littoral.Mesh(points, faces), at


@pytest.mark.parametrize("delaunay", [False, True])
def test_winding_on_a_moebius_band(delaunay):
    mesh, at = moebius_band()
    loop = [at(i, 4) for i in range(13, 19)] + [at(19, j) for j in range(4, 9)]
    loop += [at(i, 9) for i in range(19, 13, -1)] + [at(13, j) for j in range(9, 3, -1)]
    regions = littoral.winding(mesh, loop, intrinsic_delaunay=delaunay)
    assert np.count_nonzero(regions.region) == regions.region.sum() == 2 * 6 * 5
    core = [at(i, 8) for i in range(17)]
    regions = littoral.winding(mesh, core, intrinsic_delaunay=delaunay)
    assert any("its sides exchanged" in str(w) for w in regions.report.warnings)


def test_winding_on_delaunay_triangles_through_faces_and_with_a_free_boundary():
    square = littoral.examples.square(24)
    points = np.array(square.points)
    points[:, 0] += 3 * points[:, 1]
    needles = littoral.Mesh(points, square.faces)
    a = np.linspace(0, 2 * np.pi, 61)
    a[-1] = 0
    ring = np.stack([2 + 0.3 * np.cos(a), 0.5 + 0.3 * np.sin(a), 0 * a], axis=1)
    for boundary in ("natural", "free"):
        plain = littoral.winding(needles, ring, boundary_condition=boundary)
        better = littoral.winding(
            needles, ring, boundary_condition=boundary, intrinsic_delaunay=True
        )
        np.testing.assert_array_equal(better.region, plain.region)
        middles = points[np.asarray(square.faces)].mean(axis=1)
        far = np.abs(np.linalg.norm(middles - [2, 0.5, 0], axis=1) - 0.3) > 0.1
        inside = np.linalg.norm(middles - [2, 0.5, 0], axis=1) < 0.3
        np.testing.assert_array_equal(better.region[far], inside[far])
    for formulation in ("dual", "nonconforming"):
        with pytest.raises(littoral.UnsupportedError, match="intrinsic-delaunay"):
            littoral.winding(needles, ring, formulation=formulation, intrinsic_delaunay=True)
