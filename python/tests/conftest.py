"""Shapes for the tests of the Python package."""

from __future__ import annotations

import os
import signal
from pathlib import Path

import numpy as np
import pytest

import littoral

# A shell may start the tests in the background, where Ctrl-C is ignored, also by what they start.
signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture(scope="session")
def square() -> littoral.Mesh:
    return littoral.examples.square(8)


@pytest.fixture(scope="session")
def sphere() -> littoral.Mesh:
    return littoral.examples.sphere(3)


@pytest.fixture(scope="session")
def line() -> list[int]:
    """Up the middle of the square: positive to the left."""
    return [9 * j + 4 for j in range(9)]


@pytest.fixture(scope="session")
def spot() -> tuple[np.ndarray, np.ndarray]:
    """The shipped cow as arrays."""
    mesh = littoral.read(Path(__file__).parents[2] / "examples/data/spot.obj")
    return np.array(mesh.points), np.array(mesh.faces)


@pytest.fixture(scope="session")
def shapes(spot, sphere, square) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """By name: the cow; the same without some faces that share no vertex, since other libraries do
    not pass vertices where holes meet; the unit sphere; the square."""
    V, F = spot
    touched: set[int] = set()
    dropped = []
    for f in range(0, len(F), 7):
        if touched.isdisjoint(F[f].tolist()):
            touched.update(F[f].tolist())
            dropped.append(f)
    made = {"spot": spot, "broken": (V, np.delete(F, dropped, axis=0))}
    for name, mesh in (("ball", sphere), ("square", square)):
        made[name] = np.array(mesh.points), np.array(mesh.faces)
    return made


@pytest.fixture(scope="session")
def shared() -> Path:
    """A larger collection of data, where there is one."""
    root = Path(__file__).parents[2]
    folder = Path(os.environ.get("LITTORAL_SHARED", root.parent / "shared"))
    if not (folder / "data").is_dir():
        pytest.skip(f"{folder} holds no data")
    return folder
