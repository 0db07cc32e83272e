"""littoral's Python package beside those people use: first and repeated calls, on one mesh.

usage: python_calls.py MESH [ROUNDS] [THREADS]

Needs littoral, potpourri3d, pygeodesic, libigl, trimesh, rtree; what is missing is left out. Each
round runs all programs one after the other; medians of the rounds, wall clock. Answers are compared
before times: the last column is the mean difference from the reference named there, in % of the
largest distance.
"""

from __future__ import annotations

import importlib
import statistics
import sys
import time
from collections.abc import Callable
from typing import Any

import numpy as np

import littoral

Answer = Callable[[], Any]
Prepared = Callable[[], Answer]


def loop(mesh: littoral.Surface) -> list[int]:
    """Vertices along a closed curve: a boundary of the vertices below the median height."""
    height = mesh.points[:, 1]
    below = height < np.median(height)
    a, b = mesh.edges.T
    inner = np.unique(np.concatenate([a[below[a] & ~below[b]], b[below[b] & ~below[a]]]))
    allowed = set(inner.tolist())
    near: dict[int, list[int]] = {v: [] for v in allowed}
    for s, t in zip(a.tolist(), b.tolist(), strict=True):
        if s in allowed and t in allowed:
            near[s].append(t)
            near[t].append(s)
    path, seen = [inner[0].item()], {inner[0].item()}
    while step := [v for v in near[path[-1]] if v not in seen]:
        path.append(step[0])
        seen.add(step[0])
    return path


def tasks(V: Any, F: Any, rng: Any, threads: int) -> dict[str, dict[str, Prepared]]:
    """By task and program: what prepares, and returns what answers."""
    mesh = littoral.Mesh(V, F)
    curve = loop(mesh)
    low, high = V.min(axis=0), V.max(axis=0)
    margin = 0.1 * (high - low).max()
    X = rng.uniform(low - margin, high + margin, (100_000, 3))
    few = X[:1000]

    def solver(sources: dict[str, Any], method: str, **options: Any) -> Prepared:
        def prepare() -> Answer:
            made = littoral.DistanceSolver((V, F), method=method, threads=threads, **options)
            return lambda: made.solve(**sources, threads=threads).values

        return prepare

    def sdf(points: Any, call: str = "__call__", method: str | None = None) -> Prepared:
        def prepare() -> Answer:
            made = littoral.SDF(V, F, method=method, threads=threads)
            return lambda: getattr(made, call)(points, threads=threads)

        return prepare

    out: dict[str, dict[str, Prepared]] = {
        "heat, one vertex": {
            "littoral": solver({"points": 0}, "unsigned-heat", intrinsic_delaunay=True)
        },
        "exact, one vertex": {"littoral": solver({"points": 0}, "exact")},
        "signed, a curve": {"littoral": solver({"curves": curve}, "signed-heat")},
        "signed, 100k points": {"littoral": sdf(X)},
        "signed, 1000 points": {"littoral": sdf(few)},
        "winding, 100k points": {"littoral": sdf(X, "winding_number", "winding")},
    }

    def add(task: str, name: str, module: str, make: Callable[[Any], Prepared]) -> None:
        try:
            out[task][name] = make(importlib.import_module(module))
        except ImportError:
            print(f"{name} is not installed: left out of '{task}'", file=sys.stderr)

    def heat(pp3d: Any) -> Prepared:
        def prepare() -> Answer:
            made = pp3d.MeshHeatMethodDistanceSolver(V, F)
            return lambda: made.compute_distance(0)

        return prepare

    def signed_heat(pp3d: Any) -> Prepared:
        def prepare() -> Answer:
            made = pp3d.MeshSignedHeatSolver(V, F)
            nodes = [(v, []) for v in curve]
            return lambda: np.asarray(made.compute_distance([nodes], [True]))

        return prepare

    def exact(geodesic: Any) -> Prepared:
        def prepare() -> Answer:
            made = geodesic.PyGeodesicAlgorithmExact(V, F)
            return lambda: made.geodesicDistances(np.array([0]), None)[0]

        return prepare

    def igl_signed(points: Any) -> Callable[[Any], Prepared]:
        def make(igl: Any) -> Prepared:
            kind = igl.SIGNED_DISTANCE_TYPE_FAST_WINDING_NUMBER
            return lambda: lambda: igl.signed_distance(points, V, F, sign_type=kind)[0]

        return make

    def trimesh_signed(trimesh: Any) -> Prepared:
        importlib.import_module("rtree")

        def prepare() -> Answer:
            made = trimesh.proximity.ProximityQuery(trimesh.Trimesh(V, F, process=False))
            return lambda: -made.signed_distance(few)

        return prepare

    def igl_winding(igl: Any) -> Prepared:
        return lambda: lambda: igl.fast_winding_number(V, F, X)

    add("heat, one vertex", "potpourri3d", "potpourri3d", heat)
    add("exact, one vertex", "pygeodesic", "pygeodesic.geodesic", exact)
    add("signed, a curve", "potpourri3d", "potpourri3d", signed_heat)
    add("signed, 100k points", "libigl", "igl", igl_signed(X))
    add("signed, 1000 points", "libigl", "igl", igl_signed(few))
    add("signed, 1000 points", "trimesh", "trimesh", trimesh_signed)
    add("winding, 100k points", "libigl", "igl", igl_winding)
    return out


def timed(call: Callable[[], Any]) -> tuple[float, Any]:
    begin = time.perf_counter()
    value = call()
    return time.perf_counter() - begin, value


def main() -> None:
    mesh = littoral.read(sys.argv[1])
    rounds = int(sys.argv[2]) if len(sys.argv) > 2 else 5
    threads = int(sys.argv[3]) if len(sys.argv) > 3 else 2
    V, F = np.array(mesh.points), np.array(mesh.faces, np.int64)
    print(f"{len(F)} faces, {threads} threads for littoral, medians of {rounds}\n")
    print("| task | program | first call [s] | repeated [s] | difference |")
    print("|---|---|---|---|---|")
    for task, programs in tasks(V, F, np.random.default_rng(1), threads).items():
        first: dict[str, list[float]] = {name: [] for name in programs}
        again: dict[str, list[float]] = {name: [] for name in programs}
        values: dict[str, Any] = {}
        for _ in range(rounds):
            for name, prepare in programs.items():
                preparing, answer = timed(prepare)
                solving, values[name] = timed(answer)
                first[name].append(preparing + solving)
                again[name].append(timed(answer)[0])
        reference = next(reversed(values))
        for name in programs:
            a, b = np.asarray(values[name]), np.asarray(values[reference])
            difference = 100 * np.abs(a - b).mean() / np.abs(b).max()
            print(
                f"| {task} | {name} | {statistics.median(first[name]):.4g} "
                f"| {statistics.median(again[name]):.4g} | {difference:.3g} (to {reference}) |"
            )


if __name__ == "__main__":
    main()
