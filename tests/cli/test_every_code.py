"""Every code of docs/guides/messages.md, provoked by the program, or the reason why not."""

import math
import os
import re
import subprocess
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from conftest import PROGRAM, square
from test_messages import PAGE, codes

Words = list[object]
MADE: dict[str, Callable[[Path], Words]] = {}
# What only happens inside other programs, on other machines, or never.
NOT_BY_THE_PROGRAM = {
    "internal": "no input is known that gives it",
    "cancelled": "Ctrl-C ends the program with status 130; Python and JavaScript raise it",
    "io-error": "OpenVDB's own errors, in a module that not every build has",
    "system": "the system has to run out of processes or ports",
    "solve-failed": "no input is known that gives it",
    "diverged": "no input is known that gives it",
    "pieces-lost": "no curve is known that loses pieces",
    "curve-crosses-itself": "no curve is known that gives it",
    "constraints-unmet": "no small input is known",
    "directions-misaligned": "no small input is known",
    "free-edges": "no small input is known",
    "result-unsound": "no small input is known",
    "time-scale-raised": "meshes are large on which heat is lost in round-off",
    "sizes-differ": "arrays are given by Python and JavaScript",
}


def provokes(code: str) -> Callable[[Callable[[Path], Words]], Callable[[Path], Words]]:
    def keep(make: Callable[[Path], Words]) -> Callable[[Path], Words]:
        MADE[code] = make
        return make

    return keep


def simple(code: str, *words: object) -> None:
    MADE[code] = lambda folder: list(words)


def obj(folder: Path, points: object, faces: list[tuple[int, ...]], more: str = "") -> str:
    """a.obj; faces count from 0."""
    lines = [f"v {x} {y} {z}\n" for x, y, z in np.asarray(points)]
    lines += ["f " + " ".join(str(v + 1) for v in face) + "\n" for face in faces]
    (folder / "a.obj").write_text("".join(lines) + more)
    return "a.obj"


def cube(side: float = 1, at: float = 0) -> tuple[np.ndarray, list[tuple[int, ...]]]:
    points = np.array([(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]) * side + at
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    return points, [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]


def strip(n: int, turns: int) -> tuple[np.ndarray, list[tuple[int, ...]]]:
    """A band of n quads in a ring, turned over so many times: once is one-sided."""
    points = []
    for i in range(n):
        a = 2 * math.pi * i / n
        for side in (-0.3, 0.3):
            r = 1 + side * math.cos(turns * a / 2)
            points.append((r * math.cos(a), r * math.sin(a), side * math.sin(turns * a / 2)))
    faces: list[tuple[int, ...]] = []
    for i in range(n):
        k, m = 2 * i, 2 * ((i + 1) % n)
        p, q = (m + 1, m) if i + 1 == n and turns % 2 else (m, m + 1)
        faces += [(k, p, k + 1), (k + 1, p, q)]
    return np.array(points), faces


def sphere_cloud(n: int = 400, inward: float = 1) -> np.ndarray:
    i = np.arange(n)
    z = 1 - 2 * (i + 0.5) / n
    a, r = i * 2.399963, np.sqrt(1 - z * z)
    x = np.stack([r * np.cos(a), r * np.sin(a), z], 1)
    return np.hstack([x, inward * x])


def mask(folder: Path) -> None:
    ball = np.linalg.norm(np.indices((9, 9, 9)) - 4, axis=0) < 3
    np.save(folder / "m.npy", ball.astype(np.uint8))
    np.savez(folder / "d.npz", values=0.1 - ball, origin=np.zeros(3), spacing=1)


GRID = ("--resolution=12", "-o", "a.npz")

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
simple("sheets-thickened", "repair", "square.obj", *GRID[:1], "-o", "b.obj")
simple("curve-leaps", "distance", "square.obj", "--curve-vertices=0,1,2,3,4,120", "-o", "a.txt")
simple("source-moved", "distance", "square.obj", "--at=0,0,9", "-o", "a.txt")
simple(
    "sign-ignored", "distance", "square.obj", "--curve-vertices=5,16", "--method=exact", "-o=a.txt"
)
simple("nothing-enclosed", "sdf", "square.obj", *GRID)


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


@provokes("level-missed")
def _(folder: Path) -> Words:
    mask(folder)
    return ["contour", "d.npz", "--level=0,9.5", "-o", "b.obj"]


@provokes("decimal-comma")
def _(folder: Path) -> Words:
    mask(folder)
    return ["contour", "d.npz", "--level=0,5", "-o", "b.obj"]


@provokes("grid-unplaced")
def _(folder: Path) -> Words:
    mask(folder)
    return ["sdf", "m.npy", *GRID]


@provokes("open-surface")
def _(folder: Path) -> Words:
    values = np.indices((5, 5, 5))[0] - 2.5
    np.savez(folder / "d.npz", values=values, origin=[0] * 3, spacing=1)
    return ["contour", "d.npz", "--level=0", "-o", "b.obj"]


@provokes("wall-thin")
def _(folder: Path) -> Words:
    mask(folder)
    return ["offset", "d.npz", "--as=distance", "--shell=0.01", "-o", "b.obj"]


@provokes("no-path")
def _(folder: Path) -> Words:
    (p, f), (q, g) = cube(), cube(1, 3)
    obj(folder, np.vstack([p, q]), f + [tuple(v + 8 for v in face) for face in g])
    return ["distance", "a.obj", "--curve-vertices=0,9", "-o", "a.txt"]


@provokes("component-unreached")
def _(folder: Path) -> Words:
    return ["distance", MADE["no-path"](folder)[1], "--vertex=0", "-o", "a.txt"]


@provokes("curve-split")
def _(folder: Path) -> Words:
    MADE["no-path"](folder)
    ends = ((0.2, 0.2, 1), (0.8, 0.8, 1), (3.2, 3.2, 3), (3.8, 3.8, 3))
    points = ", ".join(f"[{x}, {y}, {z}]" for x, y, z in ends)
    (folder / "s.json").write_text(f'{{"curves": [{{"points": [{points}]}}]}}')
    return ["distance", "a.obj", "-s", "s.json", "-o", "a.txt"]


@provokes("isolated-vertices")
def _(folder: Path) -> Words:
    points, faces = cube()
    obj(folder, np.vstack([points, [(5, 5, 5)]]), faces)
    return ["distance", "a.obj", "--vertex=0", "-o", "a.txt"]


@provokes("degenerate-faces")
def _(folder: Path) -> Words:
    points, faces = cube()
    obj(folder, points, [*faces, (0, 1, 1)])
    return ["distance", "a.obj", "--vertex=0", "-o", "a.txt"]


@provokes("nonmanifold-edges")
def _(folder: Path) -> Words:
    points, faces = cube()
    obj(folder, np.vstack([points, [(0.5, -1, 0)]]), [*faces, (0, 1, 8)])
    return ["winding", "a.obj", "--curve-vertices=2,3,7,6,2", "-o", "a.csv"]


@provokes("flipped-faces")
def _(folder: Path) -> Words:
    points, faces = cube()
    obj(folder, points, [faces[0][::-1], *faces[1:]])
    return ["distance", "a.obj", "--curve-vertices=0,1", "-o", "a.txt"]


@provokes("not-orientable")
def _(folder: Path) -> Words:
    obj(folder, *strip(24, 1))
    return ["distance", "a.obj", "--curve-vertices=0,2,4,6", "-o", "a.txt"]


@provokes("polygons-cut")
def _(folder: Path) -> Words:
    points, _ = cube()
    obj(folder, points, [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3)])
    words = ("--curve-vertices=0,1", "--method=signed-heat", "--intrinsic-delaunay")
    return ["distance", "a.obj", *words, "-o", "a.txt"]


@provokes("normals-cancel")
def _(folder: Path) -> Words:
    curves = ("--curve-vertices=5,16,27", "--curve-vertices=27,16,5")
    return ["distance", "square.obj", *curves, "--method=signed-heat", "-o", "a.txt"]


@provokes("source-shadowed")
def _(folder: Path) -> Words:
    (folder / "s.json").write_text('{"points": [{"v": 0, "value": 0}, {"v": 1, "value": 9}]}')
    return ["distance", "square.obj", "-s", "s.json", "-o", "a.txt"]


@provokes("completion-guessed")
def _(folder: Path) -> Words:
    return ["distance", "square.obj", "--curve-vertices=60,61", "-o", "a.txt"]


@provokes("pieces-left-out")
def _(folder: Path) -> Words:
    words = (
        "--curve-vertices=5,16,27",
        "--vertex=0",
        "--method=signed-heat",
        "--constraint=zero-set",
    )
    (folder / "s.txt").write_text("signed_curve\nv 5\nv 5\nv 16\n")
    return ["distance", "square.obj", "-s", "s.txt", *words[:1], "-o", "a.txt"]


@provokes("orientation-reversed")
def _(folder: Path) -> Words:
    points, faces = cube()
    obj(folder, points, [face[::-1] for face in faces])
    return ["sdf", "a.obj", *GRID]


@provokes("orientation-mixed")
def _(folder: Path) -> Words:
    points, faces = cube()
    obj(folder, points, [f[::-1] if i % 3 == 0 else f for i, f in enumerate(faces)])
    return ["sdf", "a.obj", *GRID]


@provokes("sheets")
def _(folder: Path) -> Words:
    (p, f), extra = cube(), np.array([(2, 0, 0), (3, 0, 0), (3, 1, 0), (2, 1, 0)])
    obj(folder, np.vstack([p, extra]), [*f, (8, 9, 10), (8, 10, 11)])
    return ["sdf", "a.obj", *GRID]


@provokes("walls-inside")
def _(folder: Path) -> Words:
    (p, f), (q, g) = cube(), cube(0.5, 0.25)
    obj(folder, np.vstack([p, q]), f + [tuple(v + 8 for v in face) for face in g])
    return ["sdf", "a.obj", *GRID]


@provokes("thin-parts")
def _(folder: Path) -> Words:
    points, faces = cube()
    obj(folder, points * np.array([1, 1, 0.02]), faces)
    return ["sdf", "a.obj", "--bounds=-.1,-.1,-.13,1.1,1.1,1.07", *GRID]


@provokes("accuracy-missed")
def _(folder: Path) -> Words:
    obj(folder, *cube())
    return [
        "offset",
        "a.obj",
        "--distance=0.2",
        "--method=signed-heat",
        "--resolution=8",
        "-o=b.obj",
    ]


@provokes("parts-lost")
def _(folder: Path) -> Words:
    MADE["sheets"](folder)
    return ["repair", "a.obj", *GRID[:1], "-o", "b.obj"]


@provokes("points-coincide")
def _(folder: Path) -> Words:
    np.savetxt(folder / "c.xyz", np.vstack([sphere_cloud(), sphere_cloud()[:9]]))
    return ["sdf", "c.xyz", *GRID]


@provokes("normals-unusable")
def _(folder: Path) -> Words:
    cloud = sphere_cloud()
    cloud[7, 3:] = 0
    np.savetxt(folder / "c.xyz", cloud)
    return ["sdf", "c.xyz", *GRID]


@provokes("normals-estimated")
def _(folder: Path) -> Words:
    np.savetxt(folder / "c.xyz", sphere_cloud()[:, :3])
    return ["distance", "c.xyz", "--vertex=0", "-o", "a.txt"]


@provokes("points-not-enclosing")
def _(folder: Path) -> Words:
    cloud = sphere_cloud(1000)
    np.savetxt(folder / "c.xyz", cloud[cloud[:, 2] > 0.2])
    return ["sdf", "c.xyz", *GRID]


@provokes("outliers")
def _(folder: Path) -> Words:
    rng = np.random.default_rng(1)
    far = np.hstack([rng.uniform(-3, 3, (40, 3)), np.tile([0, 0, 1.0], (40, 1))])
    np.savetxt(folder / "c.xyz", np.vstack([sphere_cloud(1000), far]))
    return ["sdf", "c.xyz", "--method=tori", "--drop-outliers", *GRID]


@provokes("box-misses-input")
def _(folder: Path) -> Words:
    obj(folder, *cube())
    return ["sdf", "a.obj", "--method=signed-heat", "--bounds=.4,.4,.4,.6,.6,.6", *GRID]


@provokes("samples-outside")
def _(folder: Path) -> Words:
    obj(folder, *cube())
    words = ("--domain=tets", "--method=signed-heat", "--bounds=.5,.5,.5,2,2,2")
    return ["sdf", "a.obj", *words, *GRID]


@provokes("tetgen-failed")
def _(folder: Path) -> Words:
    obj(folder, *cube())
    return ["sdf", "a.obj", "--domain=tets", "--tets=tetgen", *GRID]


@provokes("nonbounding-kept")
def _(folder: Path) -> Words:
    obj(folder, *strip(24, 0))
    ring = ",".join(str(2 * i % 48) for i in range(25))
    words = ("--formulation=nonconforming", "--curve-vertices", ring)
    return ["winding", "a.obj", *words, "-o", "a.csv"]


@provokes("gradient-off-unit")
def _(folder: Path) -> Words:
    return [
        "distance",
        "square.obj",
        "--vertex=0",
        "--method=unsigned-heat",
        "--time-scale=1e-4",
        "-o=a.txt",
    ]


@provokes("far-from-marching")
def _(folder: Path) -> Words:
    n = 30
    x = [(i, 0.01 * i * i * (k - 0.5), 0) for i in range(n) for k in (0, 1)]
    faces = [
        f
        for i in range(n - 1)
        for f in ((2 * i, 2 * i + 2, 2 * i + 1), (2 * i + 1, 2 * i + 2, 2 * i + 3))
    ]
    obj(folder, np.array(x) * (1, 20, 1), faces)
    return ["distance", "a.obj", "--vertex=2", "--method=unsigned-heat", "-o", "a.txt"]


@provokes("not-converged")
def _(folder: Path) -> Words:
    words = ("--method=regularized", "--max-iterations=1")
    return ["distance", "square.obj", "--vertex=0", *words, "-o", "a.txt"]


@provokes("option-without-effect")
def _(folder: Path) -> Words:
    (folder / "s.obj").write_text(square(10) + "l 1 2 3\n")
    return ["distance", "square.obj", "-s", "s.obj", "--index-base=1", "-o", "a.txt"]


@provokes("direction-missing")
def _(folder: Path) -> Words:
    rows = ["1 0 0\n"] * 200
    rows[7] = "0 0 0\n"
    (folder / "f.txt").write_text("".join(rows))
    words = ("--method=regularized", "--regularizer=align", "--field=f.txt")
    return ["distance", "square.obj", "--vertex=0", *words, "-o", "a.txt"]


@provokes("sources-outside")
def _(folder: Path) -> Words:
    head = "MeshVersionFormatted 1\nDimension 3\nVertices\n5\n"
    points = "0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n5 5 5 0\n"
    (folder / "t.mesh").write_text(head + points + "Tetrahedra\n1\n1 2 3 4 0\nEnd\n")
    return ["distance", "t.mesh", "--vertex=0,4", "-o", "a.txt"]


@provokes("sign-uncertain")
def _(folder: Path) -> Words:
    rng = np.random.default_rng(1)
    corners = rng.uniform(-1, 1, (300, 1, 3))
    corners = corners / np.linalg.norm(corners, axis=2, keepdims=True)
    points = (corners + rng.uniform(-0.04, 0.04, (300, 3, 3))).reshape(-1, 3)
    obj(folder, points, [(3 * i, 3 * i + 1, 3 * i + 2) for i in range(300)])
    return ["sdf", "a.obj", *GRID]


def run_in(folder: Path, words: Words) -> subprocess.CompletedProcess[str]:
    (folder / "square.obj").write_text(square(10))
    environment = os.environ | {"PATH": ""}  # no tetgen
    call = [PROGRAM, *map(str, words)]
    return subprocess.run(
        call, cwd=folder, capture_output=True, text=True, env=environment, timeout=60
    )


@pytest.mark.parametrize("code", sorted(MADE))
def test_a_code_is_provoked(tmp_path: Path, code: str) -> None:
    done = run_in(tmp_path, MADE[code](tmp_path))
    assert f"[{code}]" in done.stderr, done.stderr
    is_error = code in codes("Errors")
    assert (done.returncode in (1, 2)) == is_error
    assert is_error == any(
        line.endswith(f" [{code}]") for line in done.stderr.splitlines() if " error: " in line
    )


def test_options_of_the_page_exist() -> None:
    verbs = (PAGE.parents[1] / "reference/verbs.md").read_text()
    known = set(re.findall(r"--[a-z][a-z-]*", verbs))
    assert set(re.findall(r"`(--[a-z-]+)", PAGE.read_text())) <= known


def test_every_code_has_its_place() -> None:
    known = set(codes("Errors") + codes("Warnings"))
    assert set(MADE) | set(NOT_BY_THE_PROGRAM) == known
    assert not set(MADE) & set(NOT_BY_THE_PROGRAM)
