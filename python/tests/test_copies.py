"""Results and what is prepared can be copied and pickled, and say the same then."""

from __future__ import annotations

import copy
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import littoral

COPIES: list[Callable[[Any], Any]] = [
    copy.copy,
    copy.deepcopy,
    lambda value: pickle.loads(pickle.dumps(value)),
]


def made() -> dict[str, Any]:
    pytest.importorskip("scipy")
    square, cube = littoral.examples.square(4), littoral.examples.cube()
    tets = littoral.TetMesh(np.eye(4, 3), [[0, 1, 2, 3]])
    sdf = littoral.SDF(cube)
    volume = sdf.sample(6)
    field = littoral.distance(square, points=0)
    return {
        "mesh": square, "tets": tets, "field": field, "report": field.report,
        "regions": littoral.winding(square, [6, 8, 18, 16, 6]), "volume": volume, "sdf": sdf,
        "union": sdf | littoral.sdf_of_volume(volume), "closest": sdf.closest([0, 0, 0]),
        "tet field": littoral.tet_distance(tets, vertices=0),
        "solver": littoral.DistanceSolver(square, method="signed-heat"),
        "tet solver": littoral.TetDistanceSolver(tets, "quadratic"),
        "repaired": littoral.repair(cube), "methods": littoral.methods(),
        "samples": littoral.samples(cube, surface=9, space=9, resolution=12),
        "factorization": littoral.Factorization(np.eye(3)),
        "operators": littoral.operators(square), "curve": littoral.Curve([1, 2]),
    }  # fmt: skip


@pytest.mark.parametrize("how", range(len(COPIES)))
def test_copies_say_the_same(how: int) -> None:
    for name, value in made().items():
        assert repr(COPIES[how](value)) == repr(value), name


@pytest.mark.parametrize("how", range(len(COPIES)))
def test_copies_of_samples_are_whole(how: int, tmp_path: Path) -> None:
    samples = littoral.samples(
        littoral.examples.cube(), surface=20, space=30, resolution=12, seed=5
    )
    again = COPIES[how](samples)
    for name, value in vars(samples).items():
        if isinstance(value, np.ndarray):
            assert (getattr(again, name) == value).all(), name
    assert (again.surface.points == samples.surface.points).all()
    assert again.card("cube") == samples.card("cube")
    assert again.report == samples.report and again.warnings == samples.warnings
    for each, name in ((samples, "a"), (again, "b")):
        each.save(tmp_path / f"{name}.npz", "cube")
    assert (tmp_path / "a.npz").read_bytes() == (tmp_path / "b.npz").read_bytes()
    assert (tmp_path / "a.json").read_text() == (tmp_path / "b.json").read_text()


def test_deep_copies_of_samples_have_arrays_of_their_own() -> None:
    samples = littoral.samples(littoral.examples.cube(), surface=9, space=9, resolution=12)
    again = copy.deepcopy(samples)
    again.points[:] = 0
    assert samples.points.any()


@pytest.mark.parametrize("how", range(len(COPIES)))
def test_copies_of_sources_and_factorizations_give_the_same(how: int, tmp_path: Path) -> None:
    pytest.importorskip("scipy")
    square = littoral.examples.square(4)
    (tmp_path / "curve.txt").write_text("signed_curve\nv 2\nv 7\nv 12\nunsigned_point\nv 20\n")
    curves = littoral.read_sources(tmp_path / "curve.txt", square)
    same = littoral.distance(square, COPIES[how](curves)).values
    assert (same == littoral.distance(square, curves).values).all()
    poisson = littoral.Factorization(littoral.operators(square).L, laplacian=True)
    b = np.linspace(-1, 1, 25)
    assert (COPIES[how](poisson).solve(b) == poisson.solve(b)).all()
    turned = littoral.Factorization([[2, 1j], [-1j, 2]])
    assert (COPIES[how](turned).solve([1, 2]) == turned.solve([1, 2])).all()


def test_errors_keep_their_codes() -> None:
    with pytest.raises(littoral.IoError) as raised:
        littoral.examples.cube().save("nowhere/cube.ply")
    again = pickle.loads(pickle.dumps(raised.value))
    assert (type(again), str(again), again.code) == (
        littoral.IoError, str(raised.value), "cannot-write",
    )  # fmt: skip
