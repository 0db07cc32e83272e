"""Courses for knitting: lines at equal distance from a start that follow given directions.

usage: knitting.py MESH START_VERTEX COURSES

Directions here go round the vertical axis wherever the surface is upright; draw your own instead.
"""

import sys
import tempfile
from pathlib import Path

import numpy as np

import littoral


def directions(mesh: littoral.Surface) -> str:
    """Lines `f FACE x y z`: horizontal, on faces whose normals are nearly horizontal."""
    a, b, c = np.moveaxis(mesh.points[mesh.faces], 1, 0)
    normal = np.cross(b - a, c - a)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    upright = np.flatnonzero(np.hypot(normal[:, 0], normal[:, 2]) > 0.9)
    return "".join(f"f {f} {-normal[f, 2]:.9g} 0 {normal[f, 0]:.9g}\n" for f in upright)


def main() -> None:
    mesh = littoral.read(sys.argv[1])
    start, courses = int(sys.argv[2]), int(sys.argv[3])
    with tempfile.TemporaryDirectory() as folder:
        rows = Path(folder) / "rows.txt"
        rows.write_text(directions(mesh))
        field = littoral.distance(
            mesh, points=start, method="regularized", regularizer="align", field=str(rows)
        )
    height = field.values.max() / (courses + 1)
    for k in range(1, courses + 1):
        lines = field.isolines(k * height)
        length = sum(np.linalg.norm(np.diff(line, axis=0), axis=1).sum() for line in lines)
        print(f"course {k}: {len(lines)} loops, {length:.3f} long")


if __name__ == "__main__":
    main()
