"""Calls of other packages give what the table of docs/guides/coming_from.md says."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

import littoral

ROOT = Path(__file__).parents[2]


def rows(section):
    """The code of the two columns of a table; none where a cell holds words."""
    cells = re.findall(r"^\| `([^|]+)` \| ([^|]+) \|$", section, re.M)
    return [(theirs, ours[1:-1] if ours.startswith("`") else "") for theirs, ours in cells]


def run(code, names):
    """The value of an expression; None for statements and for nothing."""
    if " = " in code or not code:
        return exec(code, names)
    return eval(code, names)


def is_numbers(value):
    return isinstance(value, (float, np.ndarray))


@pytest.mark.parametrize(
    "name",
    [
        "potpourri3d",
        "libigl",
        "pygeodesic",
        "trimesh",
        "mesh_to_sdf",
        pytest.param("signedheat3d", marks=pytest.mark.slow),
        "Open3D",
    ],
)
def test_calls_of_other_packages_give_what_the_table_says(name):
    pytest.importorskip("scipy")
    page = (ROOT / "docs/guides/coming_from.md").read_text()
    section = page.split(f"\n## {name}\n")[1].split("\n## ")[0]
    flat = name == "potpourri3d"
    mesh = littoral.examples.square(8) if flat else littoral.examples.sphere(2)
    V, F = np.array(mesh.points), np.array(mesh.faces)
    names = {
        "littoral": littoral,
        "mesh": mesh,
        "V": V,
        "F": F,
        "W": V,  # both are in the cube already
        "P": V if flat or name == "signedheat3d" else 1.3 * V[::5],
        "N": V,
        "Q": (1.3 * V[::5]).astype(np.float32),
        "line": [9 * j + 4 for j in range(9)],
        "seven": np.array([7]),
        "none": np.array([], int),
        "every": np.arange(len(V)),
        "box": {"bbox_min": [-2] * 3, "bbox_max": [2] * 3, "resolution": [16] * 3},
        "tets": littoral.TetMesh(2 * np.eye(4, 3) - 0.5, [[0, 1, 2, 3]]),
    }
    for block in re.findall(r"^```python\n(.*?)^```", section, re.M | re.S):
        exec(block, names)
    if name == "Open3D":
        names["scene"] = names["RaycastingScene"]()
        names["scene"].add_triangles(V.astype(np.float32), F.astype(np.uint32))
    compared = 0
    for theirs, ours in rows(section):
        a, b = run(theirs, names), run(ours, names)
        if is_numbers(a) and is_numbers(b) and np.shape(a) == np.shape(b):
            np.testing.assert_allclose(a, b, atol=0.02, err_msg=theirs)
            compared += 1
    assert compared >= 2
