"""What a call from Python costs beyond the same call from C++.

usage: python_overhead.py TIMER MESH [ROUNDS]

TIMER is littoral_call_timer. Both solve on MESH from its first vertex, and ask for the signed
distance at 100,000 points and at one, on one thread; they take turns. Sums of the values are
compared first; seconds are of the processor, medians of the rounds.
"""

from __future__ import annotations

import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

import littoral

REPEATS = {"unsigned-heat": 20, "quadratic": 1, "points": 2, "point": 2000}


def main() -> None:
    timer, path = sys.argv[1:3]
    rounds = int(sys.argv[3]) if len(sys.argv) > 3 else 15
    littoral.set_threads(1)
    mesh = littoral.read(path)
    low, high = mesh.points.min(axis=0), mesh.points.max(axis=0)
    margin = 0.1 * (high - low).max()
    X = np.random.default_rng(1).uniform(low - margin, high + margin, (100_000, 3))
    heat = littoral.DistanceSolver(mesh, "unsigned-heat")
    quadratic = littoral.DistanceSolver(mesh, "quadratic")
    sdf, one = littoral.SDF(mesh), X[:1].copy()
    calls: dict[str, Callable[[], np.ndarray]] = {
        "unsigned-heat": lambda: heat.solve(points=0).values,
        "quadratic": lambda: quadratic.solve(points=0).values,
        "points": lambda: sdf(X),
        "point": lambda: sdf(one),
    }
    with tempfile.TemporaryDirectory() as folder:
        queries = Path(folder, "queries")
        X.tofile(queries)
        with subprocess.Popen(
            [timer, path, queries], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        ) as other:
            assert other.stdin and other.stdout
            print(f"{mesh.n_faces} faces, one thread, medians of {rounds}\n")
            print("| call | C++ [ms] | Python [ms] | more | sums differ, relative |")
            print("|---|---|---|---|---|")
            for task, call in calls.items():
                ours, theirs = [], []
                for k in range(rounds + 1):  # the first makes what later ones share
                    other.stdin.write(f"{task} {REPEATS[task]}\n")
                    other.stdin.flush()
                    seconds, there = map(float, other.stdout.readline().split())
                    begin = time.process_time()
                    for _ in range(REPEATS[task]):
                        values = call()
                    spent = (time.process_time() - begin) / REPEATS[task]
                    if k > 0:
                        ours.append(spent)
                        theirs.append(seconds)
                here = float(values.sum())
                a, b = statistics.median(theirs), statistics.median(ours)
                more = f"{1e6 * (b - a):.1f} us, {100 * (b / a - 1):.2g} %"
                differ = abs(here - there) / abs(there)
                print(f"| {task} | {1e3 * a:.4g} | {1e3 * b:.4g} | {more} | {differ:.1g} |")
            other.stdin.close()


if __name__ == "__main__":
    main()
