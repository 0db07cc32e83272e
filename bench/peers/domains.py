"""Polygon meshes and point clouds beside potpourri3d: same tori, same curves, exact answers known.

usage: domains.py TIMER OUTPUT.md [NODES_AROUND_TUBE]...

Each round starts a fresh process of both programs, one after the other; tables hold medians over
rounds. Distance is to two circles on a torus of radii 1 and 0.4; errors are against exact values.
"""

import json
import resource
import statistics
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np
from compare import Floats, Ints, error, machine, replace_section, run

ROUNDS, REPEATS = 3, 5
CASES = {"none": "None", "zero_set": "ZeroSet", "level_sets": "Multiple"}
COLUMNS = {
    "first": "first solve",
    "none": "repeated, none",
    "zero_set": "repeated, zero-set",
    "level_sets": "repeated, level-sets",
    "peak_mb": "peak MB",
}


def torus(n: int, cloud: bool) -> tuple[Floats, Floats, Ints, list[list[int]], Floats]:
    """Points, normals, quads, two loops of nodes, exact distance. Points of clouds are moved."""
    m = 5 * n // 2
    i, j = np.divmod(np.arange(n * m), m)
    noise = np.random.default_rng(1).uniform(-0.2, 0.2, (2, n * m)) * cloud
    noise[0][(i == n // 4) | (i == n - n // 4)] = 0
    v, u = 2 * np.pi * (i + noise[0]) / n, 2 * np.pi * (j + noise[1]) / m
    r = 1 + 0.4 * np.cos(v)
    points = np.stack([r * np.cos(u), r * np.sin(u), 0.4 * np.sin(v)], 1)
    normals = np.stack([np.cos(v) * np.cos(u), np.cos(v) * np.sin(u), np.sin(v)], 1)
    ii, jj = (i + 1) % n, (j + 1) % m
    quads = np.stack([i * m + j, i * m + jj, ii * m + jj, ii * m + j], 1)
    loops = [[k * m + j % m for j in range(m + 1)] for k in (n // 4, n - n // 4)]
    loops[1].reverse()
    angle = np.abs(np.arctan2(np.sin(v), np.cos(v)))
    return points, normals, quads, loops, 0.4 * (angle - np.pi / 2)


def write_ply(path: Path, points: Floats, normals: Floats, quads: Ints | None) -> None:
    names = ["x", "y", "z", "nx", "ny", "nz"]
    head = ["ply", "format ascii 1.0", f"element vertex {len(points)}"]
    head += [f"property double {name}" for name in names]
    if quads is not None:
        head += [f"element face {len(quads)}", "property list uchar int vertex_indices"]
    with path.open("w") as out:
        out.write("\n".join([*head, "end_header"]) + "\n")
        np.savetxt(out, np.hstack([points, normals]), fmt="%.17g")
        if quads is not None:
            np.savetxt(out, np.hstack([np.full((len(quads), 1), 4), quads]), fmt="%d")


def time_potpourri3d(file: str, repeats: int, values: str) -> None:
    """What littoral_domain_timer does, in a process of its own."""
    import potpourri3d as pp3d

    data = np.load(file)
    loops = [[int(v) for v in loop] for loop in data["loops"]]
    out: dict[str, float] = {}

    def make() -> Any:
        if not data["cloud"]:
            return pp3d.PolygonMeshHeatSolver(data["points"], data["quads"])
        return pp3d.PointCloudHeatSolver(data["points"])

    def solve(solver: Any, case: str) -> Floats:
        more = [data["normals"]] if data["cloud"] else []
        phi = solver.compute_signed_distance(loops, *more, level_set_constraint=CASES[case])
        return np.asarray(phi, dtype=np.float64)

    start = time.process_time()
    solver = make()
    phi = solve(solver, "zero_set")
    out["first"] = time.process_time() - start
    phi.tofile(values)
    times: dict[str, list[float]] = {}
    for round_ in range(repeats + 1 if repeats else 0):  # the first is not counted
        for case in CASES:
            begin = time.process_time()
            try:
                solve(solver, case)
            except (RuntimeError, ValueError):  # it gives up on some
                continue
            if round_:
                times.setdefault(case, []).append(time.process_time() - begin)
    out.update({case: statistics.median(t) for case, t in times.items()})
    out["peak_mb"] = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(json.dumps(out))


def measure(timer: str, n: int, cloud: bool) -> dict[str, Any]:
    points, normals, quads, loops, exact = torus(n, cloud)
    with tempfile.TemporaryDirectory() as folder:
        at = Path(folder)
        write_ply(at / "surface.ply", points, normals, None if cloud else quads)
        lines = ["signed_curve\n" + "".join(f"v {v}\n" for v in loop) for loop in loops]
        (at / "curves.txt").write_text("".join(lines))
        np.savez(
            at / "surface.npz",
            points=points,
            normals=normals,
            quads=quads,
            loops=loops,
            cloud=cloud,
        )
        ours = [timer, str(at / "surface.ply"), str(at / "curves.txt"), str(REPEATS)]
        theirs = [sys.executable, __file__, "--potpourri3d", str(at / "surface.npz"), str(REPEATS)]
        rounds = [
            (run([*ours, str(at / "ours")]), run([*theirs, str(at / "theirs")]))
            for _ in range(ROUNDS)
        ]
        phi = [np.fromfile(at / f) for f in ("ours", "theirs")]
    out: dict[str, Any] = {"name": "points" if cloud else "quads", "nodes": len(points)}
    for k, who in enumerate(("littoral", "potpourri3d")):
        out[who] = {key: statistics.median(r[k][key] for r in rounds) for key in rounds[0][k]}
    out["errors"] = [error(p, exact) for p in phi]
    return out


def table(results: list[dict[str, Any]]) -> str:
    heads = ["domain", "nodes", "program", "mean error, %", *COLUMNS.values()]
    lines = ["| " + " | ".join(heads) + " |", "|---" * len(heads) + "|"]
    for r in results:
        for k, who in enumerate(("littoral", "potpourri3d")):
            cells = [r["name"], f"{r['nodes']:,}", who, f"{r['errors'][k]:.2f}"]
            cells += [f"{r[who][c]:.3g}" if c in r[who] else "-" for c in COLUMNS]
            lines.append("| " + " | ".join(cells) + " |")
        ratio = [
            f"{r['littoral'][c] / r['potpourri3d'][c]:.2f}" if c in r["potpourri3d"] else "-"
            for c in COLUMNS
        ]
        lines.append("| | | ratio | | " + " | ".join(ratio) + " |")
    return "\n".join(lines)


def main() -> None:
    if sys.argv[1] == "--potpourri3d":
        return time_potpourri3d(sys.argv[2], int(sys.argv[3]), sys.argv[4])
    timer, page, *sizes = sys.argv[1:]
    before = machine()
    results = []
    for n in map(int, sizes or ("128", "256")):
        for cloud in (False, True):
            results.append(measure(timer, n, cloud))
            print(json.dumps(results[-1]), flush=True)
    rounds = f"medians of {ROUNDS} interleaved rounds, of {REPEATS} repeats in each"
    replace_section(
        page,
        "domain peers",
        f"Processor seconds of all threads; {rounds}. {before}.\n\n{table(results)}\n",
    )


if __name__ == "__main__":
    main()
