"""An input and a call for each code of an error."""

import math
from pathlib import Path

import numpy as np
from provoking import GRID, Words, cube, mask, obj, provokes, simple, sphere_cloud

simple("usage", "sdf", "square.obj")
simple("unknown-name", "quary")
simple("option-value", "sdf", "square.obj", "--resolution=1", "-o", "a.vti")
simple("options-conflict", "sdf", "square.obj", "--resolution=9", "--spacing=1", "-o", "a.vti")
simple("nothing-given", "distance", "square.obj", "-o", "a.txt")
simple("cannot-read", "info", "no.obj")
simple("cannot-write", "convert", "square.obj", "-o", "no/a.ply")
simple("unknown-format", "convert", "square.obj", "-o", "a.dwg")
simple("no-such-element", "distance", "square.obj", "--vertex=999", "-o", "a.txt")
simple("no-field", "contour", "square.obj", "--level=0", "-o", "b.obj")
simple("too-large", "sdf", "square.obj", "--resolution=100000", "-o", "a.vti")
simple("time-limit", "sdf", "square.obj", "--resolution=400", "--time-limit=1e-3", "-o", "a.vti")


@provokes("unsupported")
def _(folder: Path) -> Words:
    points, _ = cube()
    obj(folder, points, [(0, 2, 3, 1), (4, 5, 7, 6)])
    return ["distance", "a.obj", "--vertex=0", "--method=exact", "-o", "a.txt"]


@provokes("bad-input")
def _(folder: Path) -> Words:
    rows = [f"{x} 0 0 0 0 {z}\n" for x in (0, 1, 2) for z in (1, -1)]
    (folder / "c.xyz").write_text("".join(rows))
    return ["sdf", "c.xyz", *GRID]


@provokes("unsupported-file")
def _(folder: Path) -> Words:
    np.save(folder / "p.npy", np.zeros(3, complex))
    return ["info", "p.npy"]


@provokes("bad-file")
def _(folder: Path) -> Words:
    (folder / "a.obj").write_text("v 0 0\n")
    return ["info", "a.obj"]


@provokes("not-finite")
def _(folder: Path) -> Words:
    points, faces = cube()
    points = points.astype(float)
    points[3, 1] = math.nan
    return ["sdf", obj(folder, points, faces), *GRID]


@provokes("empty-input")
def _(folder: Path) -> Words:
    return ["sdf", obj(folder, [(0, 0, 0)] * 3, [(0, 1, 2)]), *GRID]


@provokes("no-normals")
def _(folder: Path) -> Words:
    np.savetxt(folder / "c.xyz", sphere_cloud()[:, :3])
    return ["sdf", "c.xyz", *GRID]


@provokes("volume-meaning")
def _(folder: Path) -> Words:
    np.savez(folder / "d.npz", values=np.arange(27.0).reshape(3, 3, 3), origin=[0] * 3, spacing=1)
    return ["offset", "d.npz", "--distance=0", "-o", "b.obj"]


@provokes("no-inside")
def _(folder: Path) -> Words:
    np.save(folder / "m.npy", np.zeros((4, 4, 4)))
    return ["offset", "m.npy", "--as=mask", "--distance=0", "-o", "b.obj"]


@provokes("nothing-there")
def _(folder: Path) -> Words:
    mask(folder)
    return ["contour", "d.npz", "--level=9", "-o", "b.obj"]


@provokes("no-path")
def _(folder: Path) -> Words:
    (p, f), (q, g) = cube(), cube(1, 3)
    obj(folder, np.vstack([p, q]), f + [tuple(v + 8 for v in face) for face in g])
    return ["distance", "a.obj", "--curve-vertices=0,9", "-o", "a.txt"]


@provokes("tetgen-failed")
def _(folder: Path) -> Words:
    obj(folder, *cube())
    return ["sdf", "a.obj", "--domain=tets", "--tets=tetgen", *GRID]
