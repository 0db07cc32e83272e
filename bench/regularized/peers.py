"""Exact polyhedral distance and fast marching beside pygeodesic and potpourri3d.

usage: peers.py MESH... [--rounds N]

Prints a Markdown table. One vertex source, the same mesh, one round of all four programs after the
other, medians of processor seconds. littoral's are those of the whole process, with starting,
reading the OBJ and writing; what a run with `littoral info` takes, which reads and connects the
same mesh, is stated beside them. The others' are of the construction and the call alone, on arrays
in memory. Answers are compared first: largest difference over the largest distance. Needs what
bench/peers/requirements.txt lists.
"""

import argparse
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import potpourri3d
from pygeodesic import geodesic

sys.path.append(str(Path(__file__).parent.parent / "quadratic"))
from surface import PROGRAM, Floats, Ints, load, write_obj


def ours(mesh: Path, method: str, out: Path) -> tuple[Floats, float]:
    """Distance from vertex 0, processor seconds of the process."""
    command = [PROGRAM, "distance", str(mesh), "--vertex", "0", "--method", method]
    seconds = of_children([*command, "-o", str(out), "--quiet", "--threads", "1"])
    return np.load(out).ravel(), seconds


def of_children(command: list[str]) -> float:
    """Processor seconds of a program."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, check=True, capture_output=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def timed(call: Callable[[], Floats]) -> tuple[Floats, float]:
    """Answer and processor seconds."""
    start = time.process_time()
    values = call()
    return values, time.process_time() - start


def kirsanov(points: Floats, faces: Ints) -> Floats:
    """Mitchell, Mount and Papadimitriou as Kirsanov wrote it, which geometry-central has too."""
    solver = geodesic.PyGeodesicAlgorithmExact(points, faces.astype(np.int32))
    return np.asarray(solver.geodesicDistances(np.array([0]))[0])


def marching(points: Floats, faces: Ints) -> Floats:
    """geometry-central's fast marching."""
    solver = potpourri3d.MeshFastMarchingDistanceSolver(points, faces)
    return np.asarray(solver.compute_distance([[(0, [])]]))


def compare(path: Path, rounds: int) -> None:
    """One row."""
    points, faces = load(path)
    rows: dict[str, list[float]] = {}
    with tempfile.TemporaryDirectory() as folder:
        mesh, out = Path(folder) / "mesh.obj", Path(folder) / "d.npy"
        write_obj(mesh, points, faces)
        worst = {}
        for _ in range(rounds):
            rows.setdefault("info", []).append(of_children([PROGRAM, "info", str(mesh)]))
            answers = {}
            for name, call in (
                ("exact", lambda: ours(mesh, "exact", out)),
                ("pygeodesic", lambda: timed(lambda: kirsanov(points, faces))),
                ("fast-marching", lambda: ours(mesh, "fast-marching", out)),
                ("potpourri3d", lambda: timed(lambda: marching(points, faces))),
            ):
                answers[name], seconds = call()
                rows.setdefault(name, []).append(seconds)
            exact = answers["pygeodesic"]
            worst = {n: np.abs(a - exact).max() / exact.max() for n, a in answers.items()}
    s = {name: statistics.median(times) for name, times in rows.items()}
    print(
        f"| {path.stem} | {len(faces)} | {s['info']:.2f} "
        f"| {s['exact']:.2f} | {s['pygeodesic']:.2f} | {s['exact'] / s['pygeodesic']:.2f} "
        f"| {(s['exact'] - s['info']) / s['pygeodesic']:.2f} "
        f"| {worst['exact']:.1e} | {s['fast-marching']:.2f} | {s['potpourri3d']:.2f} "
        f"| {worst['fast-marching']:.1e}, {worst['potpourri3d']:.1e} |",
        flush=True,
    )


def main() -> None:
    """Reads the arguments."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("meshes", nargs="+", type=Path)
    parser.add_argument("--rounds", type=int, default=3)
    arguments = parser.parse_args()
    print(
        "| mesh | faces | reading, s | exact, s | pygeodesic, s | ratio | ratio less reading "
        "| they differ by "
        "| fast marching, s | potpourri3d, s | errors of the two |"
    )
    print("|---" * 11 + "|")
    for path in arguments.meshes:
        compare(path, arguments.rounds)


if __name__ == "__main__":
    main()
