"""What runs cost: the constants of src/cli/plan/run_costs.cpp, from which --dry-run estimates.

usage: run_costs.py PROGRAM [VERB...]

Runs each method of `distance`, `pairs`, `winding`, `sdf`, `query` and `repair` on bumpy spheres of
two sizes, on one thread, and prints rows for the table: seconds of the processor as
`seconds * (n / unit)^power`, and bytes for each element, of pairs for each pair. Times of the
processor hardly depend on what else runs.
"""

import json
import math
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

SURFACE = ["auto", "signed-heat", "unsigned-heat", "exact", "fast-marching", "quadratic"]
SURFACE += ["regularized", "belyaev-fayolle"]
SPACE = ["auto", "winding", "closest-point", "tori", "signed-heat", "regularized"]
SPACE += ["belyaev-fayolle", "hopf-cole", "planar", "log-sum-exp"]
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


def fitted(sizes: list[float], runs: list[tuple[float, float]], order: int = 1) -> str:
    """Power law through two runs, and bytes for each element to this power."""
    (t0, _), (t1, memory) = runs
    if not math.isfinite(t0 + t1):
        return "not measured: it fails or takes too long"
    t0, t1 = max(t0 - START, 1e-4), max(t1 - START, 2e-4)
    power = min(max(math.log(t1 / t0) / math.log(sizes[1] / sizes[0]), 1.0), 2.5)
    seconds = t1 * (1e4 / sizes[1]) ** power
    return f"{seconds:.3g}, {power:.2f}, {max(memory - PROGRAM, 0) / sizes[1] ** order:.3g}"


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
    chosen = sys.argv[2:] or ["distance", "winding", "pairs", "sdf", "query", "repair"]
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
        for method in SPACE:
            words = ("--method", method, "-o", "a.npy")
            runs = [run("sdf", small, "--resolution", r, *words) for r in (32, 96)]
            print(f'{{"sdf", "{method}", {fitted(cubes, runs)}}},', flush=True)
    if "query" in chosen:
        for method in SPACE[:4] + SPACE[7:]:
            words = ("--method", method, "-o", "a.npy")
            runs = [run("query", small, "--points", f, *words) for f in files]
            print(f'{{"query", "{method}", {fitted([float(i) for i in n], runs)}}},', flush=True)
    if "repair" in chosen:
        words = ("--remesh", "-o", "a.ply")
        runs = [run("repair", small, "--resolution", r, *words) for r in (32, 96)]
        print(f'{{"repair", "", {fitted(cubes, runs)}}},', flush=True)


if __name__ == "__main__":
    main()
