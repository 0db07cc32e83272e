"""Quadratic-order geodesics against the same program in CVXPY with Clarabel, in one run.

usage: peer.py MESH... [--repeats N] [--vertex I]      prints a Markdown table

Both solve: maximise the integral of u subject to u >= |grad u|^2 / 4 at the seven points of every
triangle and u <= (1e-4 h)^2 at the source vertex. First the answers are compared: the optimum is
Clarabel's at tolerances of 1e-9; its own default (1e-8) differs from it by as much as the table
says; ours is computed at the loosest of 1e-5, 1e-6, 1e-7 and 1e-8 that is within 1e-6 of it. Then
these are timed, interleaved, medians. Seconds are processor time: the program's over all its
threads, reading and writing included; the peer's from handing the problem to CVXPY on. The last
column is the program as it is by default, which inserts samples and so solves a larger problem.
"""

import argparse
import time
from pathlib import Path

import cvxpy
import numpy as np
import scipy.sparse as sp
from compared import quadratic
from surface import Floats, Ints, Run, load, mean_edge

# Corners, midpoints of the sides and the centre of a triangle.
SAMPLES = np.array(
    [[1, 0, 0], [0, 1, 0], [0, 0, 1], [0.5, 0.5, 0], [0, 0.5, 0.5], [0.5, 0, 0.5], [1 / 3] * 3]
)


def rows_of_program(points: Floats, faces: Ints) -> tuple[sp.csr_matrix, list[sp.csr_matrix], Ints]:
    """Values and the two gradient components at seven points a triangle (rows x nodes), from the
    paper's appendix B; and the six nodes of each triangle."""
    nv = len(points)
    sides = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), 1)
    edges, where = np.unique(sides, axis=0, return_inverse=True)
    node = np.concatenate([faces, nv + where.reshape(3, -1).T], 1)
    p, q, r = (points[faces[:, k]] for k in range(3))
    x = (q - p) / np.linalg.norm(q - p, axis=1, keepdims=True)
    n = np.cross(q - p, r - p)
    double_area = np.linalg.norm(n, axis=1)
    y = np.cross(n / double_area[:, None], x)
    flat = [np.stack([((v - p) * x).sum(1), ((v - p) * y).sum(1)], 1) for v in (p, q, r)]
    grad = np.empty((len(faces), 3, 2))
    for i in range(3):
        e = flat[(i + 2) % 3] - flat[(i + 1) % 3]
        grad[:, i] = np.stack([-e[:, 1], e[:, 0]], 1) / double_area[:, None]
    samples = SAMPLES
    value = np.empty((7, 6))
    slope = np.empty((len(faces), 7, 6, 2))
    for i in range(3):
        j = (i + 1) % 3
        value[:, i] = samples[:, i] * (2 * samples[:, i] - 1)
        value[:, 3 + i] = 4 * samples[:, i] * samples[:, j]
        slope[:, :, i] = (4 * samples[:, i] - 1)[None, :, None] * grad[:, None, i]
        slope[:, :, 3 + i] = 4 * (
            samples[:, i][None, :, None] * grad[:, None, j]
            + samples[:, j][None, :, None] * grad[:, None, i]
        )
    row = np.repeat(np.arange(7 * len(faces)), 6)
    column = np.repeat(node[:, None, :], 7, axis=1).ravel()
    shape = (7 * len(faces), nv + len(edges))
    Q = sp.csr_matrix((np.tile(value[None], (len(faces), 1, 1)).ravel(), (row, column)), shape)
    G = [sp.csr_matrix((slope[..., d].ravel(), (row, column)), shape) for d in range(2)]
    return Q, G, node


def objective_weights(points: Floats, faces: Ints, node: Ints, n: int) -> Floats:
    """Integrals of the basis functions: a third of the area at edge midpoints."""
    p, q, r = (points[faces[:, k]] for k in range(3))
    area = 0.5 * np.linalg.norm(np.cross(q - p, r - p), axis=1)
    c = np.zeros(n)
    np.add.at(c, node[:, 3:].ravel(), np.repeat(area / 3, 3))
    return c


class Peer:
    """The problem in CVXPY, lengths in square roots of the area."""

    def __init__(self, points: Floats, faces: Ints, vertex: int) -> None:
        self.scale = np.sqrt(objective_weights(points, faces, *nodes_of(points, faces)).sum())
        points = points / self.scale
        Q, G, node = rows_of_program(points, faces)
        c = objective_weights(points, faces, node, Q.shape[1])
        u = cvxpy.Variable(Q.shape[1])
        cap = (1e-4 * mean_edge(points, faces)) ** 2
        t = Q @ u
        # t >= |g|^2 / 4 as |(sqrt(tau) g, t - tau)| <= t + tau; tau about the size of t helps it.
        places = SAMPLES @ points[faces]
        far = np.linalg.norm(places.reshape(-1, 3) - points[vertex], axis=1)
        root = np.maximum(far, 0.5 * mean_edge(points, faces))
        scaled = [sp.diags(root) @ g @ u for g in G]
        cones = cvxpy.SOC(t + root**2, cvxpy.vstack([*scaled, t - root**2]), axis=0)
        self.program = lambda: cvxpy.Problem(cvxpy.Maximize(c @ u), [cones, u[vertex] <= cap])

    def solve(self, tolerance: float | None) -> tuple[float, float]:
        """Objective and processor seconds; at Clarabel's default tolerances without one."""
        problem = self.program()
        names = ("tol_gap_rel", "tol_gap_abs", "tol_feas")
        options = {} if tolerance is None else dict.fromkeys(names, tolerance)
        start = time.process_time()
        problem.solve(solver=cvxpy.CLARABEL, max_threads=1, **options)
        total = time.process_time() - start
        if problem.status not in ("optimal", "optimal_inaccurate"):
            raise cvxpy.error.SolverError(f"Clarabel: {problem.status}")
        return float(problem.value) * self.scale**4, total


def nodes_of(points: Floats, faces: Ints) -> tuple[Ints, int]:
    """The six nodes of each triangle, and how many nodes there are."""
    Q, _, node = rows_of_program(points, faces)
    return node, Q.shape[1]


SEVEN = ["--insert-samples=false"]


def objective(points: Floats, faces: Ints, vertex: int, extra: list[str]) -> float:
    """The program's objective, from its values at the nodes."""
    d = quadratic(points, faces, vertex, 1, [*SEVEN, *extra])
    if d is None:
        raise RuntimeError("no answer")
    sides = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), 1)
    _, where = np.unique(sides, axis=0, return_inverse=True)
    node = np.concatenate([faces, len(points) + where.reshape(3, -1).T], 1)
    return float(objective_weights(points, faces, node, len(d)) @ d**2)


def compare(path: Path, vertex: int, repeats: int) -> str:
    """A row of the table."""
    points, faces = load(path)
    peer = Peer(points, faces, vertex)
    try:
        optimum, theirs = peer.solve(1e-9)[0], peer.solve(None)[0]
    except cvxpy.error.SolverError as error:
        return f"| {path.stem} | {len(faces)} | {str(error).split('.')[0]} |"
    for tolerance in ("1e-5", "1e-6", "1e-7", "1e-8"):
        own = objective(points, faces, vertex, ["--tolerance", tolerance])
        if abs(own - optimum) < 1e-6 * abs(optimum):
            break
    seconds: list[list[float]] = []
    for _ in range(repeats):
        run = Run(points, faces, vertex, "quadratic", [*SEVEN, "--tolerance", tolerance])
        usual = Run(points, faces, vertex, "quadratic")
        seconds.append([run.seconds, peer.solve(1e-9)[1], peer.solve(None)[1], usual.seconds])
    ours, tight, default, inserting = np.median(seconds, axis=0)
    return (
        f"| {path.stem} | {len(faces)} | {tolerance} | {abs(own / optimum - 1):.1e} "
        f"| {abs(theirs / optimum - 1):.1e} | {run.report['iterations']['interior point']:.0f} "
        f"| {ours:.2f} | {tight:.2f} | {default:.2f} | {ours / tight:.3f} | {ours / default:.3f} "
        f"| {inserting:.2f} |"
    )


def main() -> None:
    """Prints the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("meshes", nargs="+", type=Path)
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--vertex", type=int, default=0)
    arguments = parser.parse_args()
    titles = [
        "mesh",
        "faces",
        "our tolerance",
        "we differ by",
        "Clarabel's default differs by",
        "our steps",
        "littoral, s",
        "Clarabel 1e-9, s",
        "default, s",
        "ratio",
        "ratio to default",
        "littoral's default, s",
    ]
    print("| " + " | ".join(titles) + " |\n" + "|---" * len(titles) + "|")
    for path in arguments.meshes:
        print(compare(path, arguments.vertex, arguments.repeats), flush=True)


if __name__ == "__main__":
    main()
