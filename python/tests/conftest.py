"""Shapes for the tests of the Python package."""

from __future__ import annotations

import os
import signal
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

import littoral

# A shell may start the tests in the background, where Ctrl-C is ignored, also by what they start.
signal.signal(signal.SIGINT, signal.default_int_handler)


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--but-passed-in", help="JUnit XML: leave out what has passed there")


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    path = config.getoption("--but-passed-in")
    if not path:
        return
    passed = {
        (case.get("classname", "").split(".")[-1], case.get("name"))
        for case in ElementTree.parse(path).iter("testcase")
        if len(case) == 0
    }
    there = [item for item in items if (item.path.stem, item.name) in passed]
    config.hook.pytest_deselected(items=there)
    items[:] = [item for item in items if item not in there]


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
