"""Draws the broken curve of the example: a jersey on Spot, sketched with gaps and a shaky hand.

Each loop is where a wavy plane cuts the mesh: one node on every edge it crosses, moved along the
edge at random, and pieces left out. Travelling along a loop, the jersey lies to the left.

usage: make_example_curve.py MESH.obj OUT.txt
"""

import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]
Faces = NDArray[np.int64]
Node = tuple[int, int, float]  # (1 - t) i + t j, with i < j

GAP_SHARE = 0.3  # of each loop is left out
SHAKE = 0.12  # standard deviation of the node along its edge, in edge lengths
PIECES = {"neck": 4, "belly": 6}


def read_obj(path: Path) -> tuple[Points, Faces]:
    """Vertices (n x 3) and triangles (n x 3)."""
    rows = [line.split() for line in path.read_text().splitlines()]
    points = [[float(x) for x in row[1:4]] for row in rows if row[:1] == ["v"]]
    faces = [[int(x.split("/")[0]) - 1 for x in row[1:4]] for row in rows if row[:1] == ["f"]]
    return np.array(points), np.array(faces)


def neck(points: Points) -> Points:
    """Positive behind a slanted plane between head and shoulders."""
    x, y, z = points.T
    values: Points = 0.61 * (z + 0.04) - 0.79 * (y - 0.19) + 0.02 * np.sin(14 * x + 1)
    return values


def belly(points: Points) -> Points:
    """Positive in front of a plane across the belly, between the legs."""
    x, y, z = points.T
    values: Points = 0.43 - z + 0.035 * np.sin(11 * y + 4 * x)
    return values


def cut(faces: Faces, values: Points) -> list[list[Node]]:
    """The closed loops on which `values` vanishes, positive values to their left."""
    follows: dict[tuple[int, int], tuple[int, int]] = {}
    for face in faces:
        start = end = None
        for a, b in zip(face, np.roll(face, -1), strict=True):
            edge = (int(min(a, b)), int(max(a, b)))
            if values[a] > 0 >= values[b]:
                start = edge
            elif values[a] <= 0 < values[b]:
                end = edge
        if start and end:
            follows[start] = end
    loops = []
    while follows:
        edge = next(iter(follows))
        loop = []
        while edge in follows:
            i, j = edge
            loop.append((i, j, float(values[i] / (values[i] - values[j]))))
            edge = follows.pop(edge)
        loops.append(loop)
    return loops


def break_up(loop: list[Node], pieces: int, random: np.random.Generator) -> list[list[Node]]:
    """Arcs of the loop with gaps between them, their nodes shaken along the edges."""
    shaken = [
        (i, j, float(np.clip(t + SHAKE * random.standard_normal(), 0.05, 0.95))) for i, j, t in loop
    ]
    cuts = (np.arange(pieces) + random.uniform(-0.2, 0.2, pieces)) / pieces * len(loop)
    lengths = np.diff(np.append(cuts, cuts[0] + len(loop)))
    kept = lengths * (1 - GAP_SHARE * random.uniform(0.5, 1.5, pieces))
    return [
        [shaken[k % len(loop)] for k in range(round(start), round(start + length))]
        for start, length in zip(cuts, kept, strict=True)
    ]


def draw(points: Points, faces: Faces) -> list[str]:
    """The lines of the curve file."""
    random = np.random.default_rng(7)
    text = ["# A jersey on Spot; nodes are `e i j t`: the point (1 - t) i + t j of edge ij."]
    planes: dict[str, Callable[[Points], Points]] = {"neck": neck, "belly": belly}
    for name, plane in planes.items():
        loop = max(cut(faces, plane(points)), key=len)
        for arc in break_up(loop, PIECES[name], random):
            text.append("signed_curve")
            text += [f"e {i} {j} {t:.4f}" for i, j, t in arc]
    return text


if __name__ == "__main__":
    mesh, out = (Path(name) for name in sys.argv[1:3])
    out.write_text("\n".join(draw(*read_obj(mesh))) + "\n")
