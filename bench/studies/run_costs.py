"""What runs cost: the constants of src/cli/plan/run_costs.cpp, from which --dry-run estimates.

usage: run_costs.py PROGRAM [VERB...]

Runs each method of `distance`, `pairs`, `winding`, `sdf`, `query` and `repair` on bumpy spheres of
two sizes, on one thread, and prints rows for the table: seconds of the processor as
`seconds * (n / unit)^power`, and bytes for each element, of pairs for each pair. Where nodes near
the surface cost more (`NEAR`), two grids tell seconds for each node and for each cell that holds a
part of the surface. `patches` prints what free edges add, of soups of triangles that cross: seconds
for each side of a cell along them. Times of the processor hardly depend on what else runs.
"""

import json
import math
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np

SURFACE = ["auto", "signed-heat", "unsigned-heat", "exact", "fast-marching", "quadratic"]
SURFACE += ["regularized", "belyaev-fayolle"]
SPACE = ["auto", "winding", "closest-point", "tori", "signed-heat", "regularized"]
SPACE += ["belyaev-fayolle", "hopf-cole", "planar", "log-sum-exp"]
FACE = 2.3e-6, 900.0  # seconds and bytes for each face of what distance in space is from
NEAR = ["auto", "winding", "closest-point"]
LIMIT = 480.0  # seconds of one run
START, PROGRAM = 0.007, 13 << 20  # seconds and bytes of a run without work


def sphere(n: int, path: Path) -> int:
    """A bumpy sphere of n rings as an OBJ; its number of vertices."""
    around = 2 * n
    theta = np.linspace(0, math.pi, n + 1)[1:-1]
    phi = np.arange(around) * 2 * math.pi / around
    t, p = np.meshgrid(theta, phi, indexing="ij")
    r = 1 + 0.1 * np.sin(5 * t) * np.cos(4 * p)
    points = np.stack([r * np.sin(t) * np.cos(p), r * np.sin(t) * np.sin(p), r * np.cos(t)], -1)
    rows = [f"v {x} {y} {z}" for x, y, z in points.reshape(-1, 3)] + ["v 0 0 1", "v 0 0 -1"]
    last = (n - 1) * around
    for i in range(n - 2):
        for j in range(around):
            a, b = i * around + j + 1, i * around + (j + 1) % around + 1
            rows += [f"f {a} {a + around} {b + around}", f"f {a} {b + around} {b}"]
    for j in range(around):
        rows.append(f"f {last + 1} {j + 1} {(j + 1) % around + 1}")
        low = (n - 2) * around
        rows.append(f"f {last + 2} {low + (j + 1) % around + 1} {low + j + 1}")
    path.write_text("\n".join(rows) + "\n")
    return last + 2


def run(*arguments: object) -> tuple[float, float]:
    """Seconds of the processor and bytes of memory; infinite where the run takes too long."""
    words = [sys.argv[1], *map(str, arguments), "--threads", "1", "--quiet", "--json"]
    with tempfile.TemporaryFile() as out:
        child = subprocess.Popen(words, stdout=out, stderr=subprocess.DEVNULL)
        end = time.monotonic() + LIMIT
        while True:
            pid, status, used = os.wait4(child.pid, os.WNOHANG)
            if pid:
                break
            if time.monotonic() > end:
                child.kill()
                child.wait()
                return math.inf, math.inf
            time.sleep(0.02)
        child.returncode = os.waitstatus_to_exitcode(status)
        out.seek(0)
        if child.returncode:
            return math.nan, math.nan
        memory = json.load(out).get("peak_memory_mb", 0)
    return used.ru_utime + used.ru_stime, memory * 2**20


def asked(*arguments: object) -> dict[str, Any]:
    """What --dry-run reports."""
    words = [sys.argv[1], *map(str, arguments), "--threads", "1", "--dry-run", "--quiet", "--json"]
    out: dict[str, Any] = json.loads(subprocess.check_output(words))
    return out


def fitted(sizes: list[float], runs: list[tuple[float, float]], order: int = 1) -> str:
    """Power law through two runs, and bytes for each element to this power."""
    (t0, _), (t1, memory) = runs
    if not math.isfinite(t0 + t1):
        return "not measured: it fails or takes too long"
    t0, t1 = max(t0 - START, 1e-4), max(t1 - START, 2e-4)
    power = min(max(math.log(t1 / t0) / math.log(sizes[1] / sizes[0]), 1.0), 2.5)
    seconds = t1 * (1e4 / sizes[1]) ** power
    return f"{seconds:.3g}, {power:.2f}, {max(memory - PROGRAM, 0) / sizes[1] ** order:.3g}"


def area_of(path: Path) -> tuple[float, int]:
    """Area and faces of an OBJ of triangles."""
    rows = [line.split() for line in path.read_text().splitlines()]
    V = np.array([row[1:] for row in rows if row[0] == "v"], float)
    F = np.array([row[1:] for row in rows if row[0] == "f"], int) - 1
    a, b, c = (V[F[:, k]] for k in range(3))
    return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2), len(F)


def soup(n: int, size: float, path: Path) -> float:
    """Triangles anyhow in a cube of side 1; the length of their sides."""
    random = np.random.default_rng(0)
    ways = random.normal(size=(n, 3, 3))
    ways /= np.linalg.norm(ways, axis=2, keepdims=True)
    corners = random.random((n, 1, 3)) + size * ways
    rows = [f"v {x} {y} {z}" for x, y, z in corners.reshape(-1, 3)]
    rows += [f"f {3 * f + 1} {3 * f + 2} {3 * f + 3}" for f in range(n)]
    path.write_text("\n".join(rows) + "\n")
    return float(np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).sum())


def near_surface(method: str, file: Path) -> str:
    """Seconds for 1e4 nodes and for a cell, bytes for each, of grids of 96 and 384 nodes."""
    area, faces = area_of(file)
    work, seconds, memory = [], [], []
    for resolution in (96, 384):
        words = ("sdf", file, "--method", method, "--resolution", resolution, "-o", "a.npy")
        sizes = asked(*words)["sizes"]
        work.append([sizes["nodes"], area / sizes["spacing"] ** 2])
        t, held = run(*words)
        seconds.append(t - START - FACE[0] * faces)
        memory.append(held - PROGRAM - FACE[1] * faces)
    node, cell = np.linalg.solve(np.array(work), np.array(seconds))
    of_node, of_cell = np.linalg.solve(np.array(work), np.array(memory))
    return f"{1e4 * node:.3g}, 1.00, {of_node:.3g}, {cell:.2g}, {of_cell:.2g}"


def print_patches() -> None:
    """A query of one point; the cells are those that points are asked on, 128 along the box."""
    Path("point.csv").write_text("x,y,z\n0,0,0\n")
    for n, size in ((100, 0.5), (1000, 0.2)):
        file = Path("soup.obj")
        length = soup(n, size, file) * 128 / (1 + 2 * size)
        t, _ = run("query", file, "--points", "point.csv", "-o", "a.npy")
        print(f"// {n} triangles: {(t - START) / length:.2g} s for each side of a cell", flush=True)


def main() -> None:
    os.chdir(tempfile.mkdtemp())
    small, large = Path("small.obj"), Path("large.obj")
    n = [sphere(36, small), sphere(100, large)]
    files = [small, large]
    loop = [36 // 2 * 72, 100 // 2 * 200]
    for k, file in enumerate(("small.txt", "large.txt")):
        around = [72, 200][k]
        ring = [loop[k] + j for j in range(around)] + [loop[k]]
        Path(file).write_text("signed_curve\n" + "".join(f"v {v}\n" for v in ring))
    chosen = sys.argv[2:] or [
        "distance",
        "winding",
        "pairs",
        "sdf",
        "query",
        "patches",
        "repair",
    ]
    if "distance" in chosen:
        for method in SURFACE:
            source = ["-s", "{}.txt"] if method not in ("exact", "quadratic") else ["--vertex", "7"]
            words = ("--method", method, "-o", "a.npy")
            runs = [run("distance", f, *(w.format(f.stem) for w in source), *words) for f in files]
            print(f'{{"distance", "{method}", {fitted(n, runs)}}},', flush=True)
    if "winding" in chosen:
        runs = [run("winding", f, "-s", f.stem + ".txt", "-o", "a.txt") for f in files]
        print(f'{{"winding", "", {fitted(n, runs)}}},', flush=True)
    tiny = [Path("tiny0.obj"), Path("tiny1.obj")]
    m = [sphere(12, tiny[0]), sphere(24, tiny[1])]
    if "pairs" in chosen:
        for method in ("exact", "signed-heat", "unsigned-heat", "regularized", "fast-marching"):
            runs = [run("pairs", f, "--method", method, "-o", "a.npy") for f in tiny]
            print(f'{{"pairs", "{method}", {fitted([float(i) for i in m], runs, 2)}}},', flush=True)
    cubes = [32.0**3, 96.0**3]
    if "sdf" in chosen:
        for method in NEAR:
            print(f'{{"sdf", "{method}", {near_surface(method, small)}}},', flush=True)
        for method in SPACE[len(NEAR) :]:
            words = ("--method", method, "-o", "a.npy")
            runs = [run("sdf", small, "--resolution", r, *words) for r in (32, 96)]
            print(f'{{"sdf", "{method}", {fitted(cubes, runs)}}},', flush=True)
    if "query" in chosen:
        for method in SPACE[:4] + SPACE[7:]:
            words = ("--method", method, "-o", "a.npy")
            runs = [run("query", small, "--points", f, *words) for f in files]
            print(f'{{"query", "{method}", {fitted([float(i) for i in n], runs)}}},', flush=True)
    if "patches" in chosen:
        print_patches()
    if "repair" in chosen:
        words = ("--remesh", "-o", "a.ply")
        runs = [run("repair", small, "--resolution", r, *words) for r in (32, 96)]
        print(f'{{"repair", "", {fitted(cubes, runs)}}},', flush=True)


if __name__ == "__main__":
    main()
