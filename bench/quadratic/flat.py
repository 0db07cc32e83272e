"""Quadratic-order distance where it is known: from curves in a square, through tets of a cube.

usage: flat.py curves | tets    needs littoral; prints a Markdown table

Curves: n x n squares in two triangles each, inner vertices moved at random by up to 0.24 / n; a
straight line across, and a circle of radius 0.27, neither signed, with samples half an edge apart
(the paper) and with distances around the curve (the default). Tets: the unit cube in 6 n^3 of them,
inner vertices moved by up to 0.2 / n, from a corner and from an inner vertex; it is convex, so
distance is that of space. Tolerance 1e-6; seconds are processor time of one thread for preparing
and solving.
"""

import itertools
import sys
import time

import numpy as np
from numpy.typing import NDArray

import littoral

Floats = NDArray[np.float64]


def cube(n: int, seed: int) -> littoral.TetMesh:
    """Every small cube in the six tets of its ways from corner to corner along its edges."""
    a = np.arange(n + 1)
    places = np.stack(np.meshgrid(a, a, a, indexing="ij"), -1).reshape(-1, 3) / n
    number = np.arange((n + 1) ** 3).reshape(n + 1, n + 1, n + 1)
    tets = []
    for corner in itertools.product(range(n), repeat=3):
        for order in itertools.permutations(range(3)):
            at = list(corner)
            tet = [number[tuple(at)]]
            for axis in order:
                at[axis] += 1
                tet.append(number[tuple(at)])
            tets.append(tet)
    return littoral.TetMesh(jittered(places, 0.2 / n, seed), np.array(tets))


def square(n: int, seed: int) -> littoral.Mesh:
    """Every small square in two triangles."""
    a = np.arange(n + 1)
    places = np.stack(np.meshgrid(a, a, indexing="ij"), -1).reshape(-1, 2) / n
    i, j = np.meshgrid(np.arange(n), np.arange(n), indexing="ij")
    low = (i * (n + 1) + j).ravel()
    faces = np.concatenate(
        [
            np.stack([low, low + n + 1, low + n + 2], 1),
            np.stack([low, low + n + 2, low + 1], 1),
        ]
    )
    moved = jittered(places, 0.24 / n, seed)
    return littoral.Mesh(np.column_stack([moved, np.zeros(len(moved))]), faces)


def jittered(places: Floats, by: float, seed: int) -> Floats:
    """Coordinates between 0 and 1 moved at random."""
    moved = places + np.random.default_rng(seed).uniform(-by, by, places.shape)
    return np.where((places > 0) & (places < 1), moved, places)


def curves() -> None:
    print("| | n | samples at half an edge (the paper) | distances around the curve (default) |")
    print("|---|---|---|---|")
    angle = np.linspace(0, 2 * np.pi, 101)
    circle = np.column_stack([0.5 + 0.27 * np.cos(angle), 0.5 + 0.27 * np.sin(angle), 0 * angle])
    line = np.array([[0.0, 0.43, 0.0], [1.0, 0.43, 0.0]])
    for name, curve in (("line", line), ("circle", circle)):
        for n in (8, 16, 32):
            mesh = square(n, 1)
            p = mesh.points[:, :2]
            if name == "line":
                truth = abs(p[:, 1] - 0.43)
            else:
                truth = abs(np.linalg.norm(p - 0.5, axis=1) - 0.27)
            cells = []
            for spacing in (0.5, 0):
                field = littoral.distance(
                    mesh, curve, signed=False, method="quadratic", tolerance=1e-6, spacing=spacing
                )
                rms = np.sqrt(((field.values - truth) ** 2).mean())
                steps = sum(field.report.iterations.values())
                stopped = "" if field.report.status == "converged" else ", not converged"
                cells.append(f"{rms:.1e}, {steps:.0f} steps{stopped}")
            print(f"| {name} | {n} | {cells[0]} | {cells[1]} |", flush=True)


def tets() -> None:
    print("| tets | steps | largest error | processor seconds |")
    print("|---|---|---|---|")
    for n in (2, 4, 6, 8):
        mesh = cube(n, 1)
        inner = int(np.argmin(np.linalg.norm(mesh.points - 0.5, axis=1)))
        steps, errors, seconds = [], [], []
        for vertex in (0, inner):
            start = time.process_time()
            field = littoral.tet_distance(
                mesh, vertices=vertex, method="quadratic", tolerance=1e-6, threads=1
            )
            seconds.append(time.process_time() - start)
            truth = np.linalg.norm(mesh.points - mesh.points[vertex], axis=1)
            errors.append(abs(field.values - truth).max())
            steps.append(sum(field.report.iterations.values()))
        print(
            f"| {mesh.n_tets} | {min(steps):.0f} to {max(steps):.0f} | {max(errors):.0e} "
            f"| {min(seconds):.2g} to {max(seconds):.2g} |",
            flush=True,
        )


if __name__ == "__main__":
    {"curves": curves, "tets": tets}[sys.argv[1]]()
