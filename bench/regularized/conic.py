"""Regularized distance beside a conic solver (its paper, table 1); prints a Markdown table.

usage: conic.py MESH...    needs littoral, scipy, cvxpy and clarabel

Eq. 11 with the Dirichlet energy, alpha-hat 0.05, from vertex 0. Both answers are shrunk to unit
gradient before their objectives are compared; the difference of the two is the largest one over the
largest distance. Seconds are processor time of one thread, from the operators' mesh to the answer;
those of CVXPY with handing over the problem.
"""

import sys
import time
from pathlib import Path

import cvxpy as cp
import numpy as np
from scipy.sparse import diags

import littoral

ALPHA = 0.05


def conic(ops: littoral.Operators) -> np.ndarray:
    """The optimum by Clarabel at its default tolerances."""
    u = cp.Variable(len(ops.M))
    g = ops.G @ u
    alpha = ALPHA * np.sqrt(ops.A.sum())
    weighted = diags(np.repeat(np.sqrt(ops.A), 3)) @ g
    energy = 0.5 * alpha * cp.sum_squares(weighted) - ops.M @ u
    length = cp.SOC(np.ones(len(ops.A)), cp.reshape(g, (3, len(ops.A)), order="F"), axis=0)
    cp.Problem(cp.Minimize(energy), [length, u[0] == 0]).solve(solver=cp.CLARABEL, max_threads=1)
    return u.value


def objective(ops: littoral.Operators, u: np.ndarray) -> float:
    slope = np.linalg.norm((ops.G @ u).reshape(-1, 3), axis=1)
    shrink = 1 / max(1.0, float(slope.max()))
    alpha = ALPHA * np.sqrt(ops.A.sum())
    return float(0.5 * alpha * shrink**2 * (ops.A @ slope**2) - shrink * (ops.M @ u))


def main(paths: list[Path]) -> None:
    print("| mesh | faces | tolerance | littoral, s | Clarabel, s | they differ by | objectives |")
    print("|---" * 7 + "|")
    for path in paths:
        mesh = littoral.read(path)
        ops = littoral.operators(mesh)
        start = time.process_time()
        truth = conic(ops)
        theirs = time.process_time() - start
        for tolerance in (2e-3, 1e-4):
            start = time.process_time()
            u = littoral.distance(
                mesh, points=0, method="regularized", alpha=ALPHA, tolerance=tolerance, threads=1
            ).values
            ours = time.process_time() - start
            away = abs(u - truth).max() / truth.max()
            both = f"{objective(ops, u):.5g}, {objective(ops, truth):.5g}"
            row = [path.stem, str(mesh.n_faces), f"{tolerance:g}", f"{ours:.2f}", f"{theirs:.2f}"]
            print("| " + " | ".join([*row, f"{away:.1e}", both]) + " |", flush=True)


if __name__ == "__main__":
    main([Path(p) for p in sys.argv[1:]])
