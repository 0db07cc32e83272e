"""Progress rises to 1, also of calls that are several."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

import littoral

CUBE = littoral.examples.cube()
TETS = littoral.TetMesh.around(CUBE, resolution=5)

CALLS: dict[str, Callable[[Any], object]] = {
    "tets": lambda told: littoral.distance(TETS, CUBE, progress=told),
    "tets, heat": lambda told: littoral.tet_distance(
        TETS, CUBE, method="signed-heat", progress=told
    ),
    "rows of tets": lambda told: littoral.distance_matrix(TETS, [0, 5, 9], progress=told),
    "offset": lambda told: littoral.offset(CUBE, [0.1, 0.2], resolution=24, progress=told),
    "repair": lambda told: littoral.repair(CUBE, resolution=24, remesh=True, progress=told),
    "signed heat": lambda told: littoral.signed_heat_grid(CUBE, resolution=9, progress=told),
    "surface": lambda told: littoral.distance(CUBE, points=0, progress=told),
}


def check(shares: list[float]) -> None:
    assert shares == sorted(shares)
    assert shares[0] >= 0 and shares[-1] == pytest.approx(1)


@pytest.mark.parametrize("name", CALLS)
def test_shares_rise_to_one(name: str) -> None:
    shares: list[float] = []
    CALLS[name](lambda share, stage: shares.append(share))
    check(shares)
    within: list[float] = []
    with littoral.progress(lambda share, stage: within.append(share)):
        CALLS[name](None)
    check(within)
