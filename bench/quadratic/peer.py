"""Quadratic-order geodesics against the same program in CVXPY with Clarabel, in one run.

usage: peer.py MESH... [--repeats N] [--vertex I]      prints a Markdown table

Both solve: maximise the integral of u subject to u >= |grad u|^2 / 4 at the seven points of every
triangle and u <= (1e-4 h)^2 at the source vertex. The objectives are compared before the times.
Seconds are processor time: the program's over all its threads, reading and writing included; the
peer's from handing the problem to CVXPY on.
"""

import argparse
import time
from pathlib import Path

import cvxpy
import numpy as np
import scipy.sparse as sp
from scipy.spatial import cKDTree
from surface import Floats, Ints, Run, Subdivision, load, mean_edge


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
    samples = np.array(
        [[1, 0, 0], [0, 1, 0], [0, 0, 1], [0.5, 0.5, 0], [0, 0.5, 0.5], [0.5, 0, 0.5], [1 / 3] * 3]
    )
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


def solve_peer(points: Floats, faces: Ints, vertex: int) -> tuple[float, float, str]:
    """Objective, processor seconds, status."""
    scale = np.sqrt(objective_weights(points, faces, *nodes_of(points, faces)).sum())
    points = points / scale
    Q, G, node = rows_of_program(points, faces)
    c = objective_weights(points, faces, node, Q.shape[1])
    u = cvxpy.Variable(Q.shape[1])
    cap = (1e-4 * mean_edge(points, faces)) ** 2
    t = Q @ u
    # t >= |g|^2 / 4 as |(sqrt(tau) g, t - tau)| <= t + tau; tau about the size of t helps Clarabel.
    at = np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1], [0.5, 0.5, 0], [0, 0.5, 0.5], [0.5, 0, 0.5]])
    places = np.concatenate([at, np.full((1, 3), 1 / 3)]) @ points[faces]
    far = np.linalg.norm(places.reshape(-1, 3) - points[vertex], axis=1)
    root = np.maximum(far, 0.5 * mean_edge(points, faces))
    tau = root**2
    scaled = [sp.diags(root) @ g @ u for g in G]
    cones = cvxpy.SOC(t + tau, cvxpy.vstack([*scaled, t - tau]), axis=0)
    problem = cvxpy.Problem(cvxpy.Maximize(c @ u), [cones, u[vertex] <= cap])
    start = time.process_time()
    problem.solve(
        solver=cvxpy.CLARABEL,
        tol_gap_rel=1e-9,
        tol_gap_abs=1e-9,
        tol_feas=1e-9,
        max_threads=1,
    )
    total = time.process_time() - start
    if problem.status not in ("optimal", "optimal_inaccurate"):
        raise RuntimeError(f"Clarabel: {problem.status}")
    return float(problem.value) * scale**4, total, problem.status


def nodes_of(points: Floats, faces: Ints) -> tuple[Ints, int]:
    """The six nodes of each triangle, and how many nodes there are."""
    Q, _, node = rows_of_program(points, faces)
    return node, Q.shape[1]


def solve_ours(points: Floats, faces: Ints, vertex: int) -> tuple[float, float, Run]:
    """Objective and processor seconds of the whole program, reading and writing included."""
    extra = ["--insert-samples=false", "--tolerance", "1e-7"]
    start = Run(points, faces, vertex, "quadratic", extra)
    shown = Run(points, faces, vertex, "quadratic", [*extra, "--subdivide", "2"])
    # The corners of the finer mesh are the nodes: find each edge's midpoint by its place.
    fine = Subdivision(points, faces)
    _, at = cKDTree(shown.points).query(fine.points)
    u = shown.values[at] ** 2
    sides = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), 1)
    _, where = np.unique(sides, axis=0, return_inverse=True)
    node = np.concatenate([faces, len(points) + where.reshape(3, -1).T], 1)
    value = float(objective_weights(points, faces, node, len(u)) @ u)
    return value, start.seconds, start


def main() -> None:
    """Prints the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("meshes", nargs="+", type=Path)
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--vertex", type=int, default=0)
    arguments = parser.parse_args()
    print(
        "| mesh | faces | objectives differ by | littoral | CVXPY + Clarabel | ratio | its status |"
    )
    print("|---|---|---|---|---|---|---|")
    for path in arguments.meshes:
        points, faces = load(path)
        ours, theirs = [], []
        difference = 0.0
        status = ""
        for _ in range(arguments.repeats):  # interleaved
            value, seconds, _ = solve_ours(points, faces, arguments.vertex)
            ours.append(seconds)
            try:
                peer, seconds, status = solve_peer(points, faces, arguments.vertex)
            except cvxpy.error.SolverError as error:
                status = str(error).split(".")[0]
                break
            theirs.append(seconds)
            difference = max(difference, abs(value - peer) / abs(peer))
        a, b = (float(np.median(x)) if x else float("nan") for x in (ours, theirs))
        print(
            f"| {path.stem} | {len(faces)} | {difference:.1e} | {a:.2f} s | {b:.2f} s "
            f"| {a / b:.3f} | {status} |",
            flush=True,
        )


if __name__ == "__main__":
    main()
