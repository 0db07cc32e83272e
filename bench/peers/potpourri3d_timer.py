"""Times potpourri3d's signed heat solver as surface_timer.cpp times littoral's.

usage: potpourri3d_timer.py MESH.npz REPEATS VALUES wall|cpu

Preserved normals, which cost a factorization each time, are left out above 100k faces.
"""

import json
import statistics
import sys
import time
from pathlib import Path

import numpy as np
import potpourri3d as pp3d

CASES = {
    "none": {"level_set_constraint": "None"},
    "zero_set": {"level_set_constraint": "ZeroSet"},
    "level_sets": {"level_set_constraint": "Multiple"},
    "soft": {"level_set_constraint": "None", "soft_level_set_weight": 100.0},
    "preserved_normals": {"level_set_constraint": "None", "preserve_source_normals": True},
}


def peak_megabytes() -> float:
    status = Path("/proc/self/status").read_text().split("VmHWM:")[1]
    return int(status.split()[0]) / 1024


def main() -> None:
    mesh, repeats, values = np.load(sys.argv[1]), int(sys.argv[2]), sys.argv[3]
    now = time.process_time if sys.argv[4] == "cpu" else time.perf_counter
    if len(mesh["faces"]) > 100_000:
        del CASES["preserved_normals"]
    curve = [(int(v), []) for v in mesh["curve"]]
    other = [(int(v), []) for v in mesh["other"]]
    out = {"faces": len(mesh["faces"])}
    start = now()
    solver = pp3d.MeshSignedHeatSolver(mesh["points"], mesh["faces"])
    phi = solver.compute_distance([curve], **CASES["zero_set"])
    out["first"] = now() - start
    out["first_peak_mb"] = peak_megabytes()
    np.asarray(phi, dtype=np.float64).tofile(values)

    def seconds(nodes: list[tuple[int, list[float]]], case: str) -> float:
        begin = now()
        solver.compute_distance([nodes], **CASES[case])
        return now() - begin

    times: dict[str, list[float]] = {}
    for round_ in range(repeats + 1 if repeats else 0):  # the first is not counted
        for case in CASES:
            try:
                t = seconds(curve, case)
            except RuntimeError:
                continue
            if round_:
                times.setdefault(case, []).append(t)
        t = seconds(curve if round_ % 2 else other, "zero_set")
        if round_:
            times.setdefault("moved_curve_zero_set", []).append(t)
    out.update({name: statistics.median(t) for name, t in times.items()})
    out["peak_mb"] = peak_megabytes()
    print(json.dumps(out))


if __name__ == "__main__":
    main()
