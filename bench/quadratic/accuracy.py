"""Accuracy of quadratic-order geodesics beside other unsigned methods.

usage: accuracy.py table MESH... | sphere | convergence MESH... | noise MESH | moving MESH

Prints Markdown, and draws with `--plot FILE.png` what the paper's figures 3, 6, 5, 8 and 12 show.
`--list FILE` adds the meshes named in a file, a path a line, from the folder $LITTORAL_SHARED/data.

The protocol is that of section 6.2: lengths in units of the bounding box's diagonal; the quadratic
method runs on the mesh, all others on the mesh subdivided once, as that has as many nodes; all are
compared on the mesh subdivided twice (once above 20,000 faces) with the exact polyhedral distance
there (PyPI pygeodesic, or littoral's own where the mesh is nonmanifold; on the sphere, great
circles), linear methods interpolated linearly, the quadratic one evaluated. RMSE is
sqrt(e^T M1 e / 1^T M1 1), over the parts that the source reaches.
"""

import argparse
import os
import resource
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

import draw
import numpy as np
from compared import LABELS, OF_PAPER, linear, quadratic
from surface import (
    Floats,
    Ints,
    Kind,
    Run,
    Subdivision,
    corner_angles,
    errors,
    load,
    mean_edge,
    part_of,
    subdivided,
)

Pair = tuple[float, float]  # RMSE and largest error


def exact(points: Floats, faces: Ints, vertex: int, own: set[str] | None = None) -> Floats:
    """Exact polyhedral distance at the vertices; infinite where the source does not reach. By
    littoral, which says so in `own`, where pygeodesic cannot: it ends at nonmanifold edges, its
    paths do not pass nonmanifold vertices, and on slivers it may not end."""
    reached = part_of(faces, vertex)
    number = np.cumsum(reached) - 1
    p, f, v = points[reached], number[faces[reached[faces[:, 0]]]], int(number[vertex])
    found = linear("pygeodesic", p, f, v) if Kind(p, f).manifold else None
    if found is None:
        found = linear("exact", p, f, v)
        if own is not None:
            own.add("littoral")
    if found is None:
        raise RuntimeError("no exact distance")
    distance = np.full(len(points), np.inf)
    distance[reached] = found
    return distance


def reached_errors(
    points: Floats, faces: Ints, values: Floats | None, truth: Floats
) -> Pair | None:
    """RMSE and largest error where the truth is finite; none without values there."""
    inside = np.isfinite(truth)
    if values is None or not np.isfinite(values[inside]).all():
        return None
    error = np.where(inside, values - np.where(inside, truth, 0), 0)
    return errors(points, faces[inside[faces[:, 0]]], error)


Project = Callable[[Floats], Floats]


def compare(
    points: Floats,
    faces: Ints,
    vertex: int,
    levels: int,
    truth: Callable[[Floats, Ints], Floats],
    project: Project = lambda x: x,
) -> dict[str, Pair | None]:
    """RMSE and largest error of each method, none where it fails, all evaluated on the mesh
    subdivided `levels` times. `project` moves the vertices of every subdivision (onto a sphere)."""
    fine = []
    p, f = points, faces
    for _ in range(levels):
        s = Subdivision(p, f)
        p, f = project(s.points), s.faces
        fine.append((s, p, f))
    reference = truth(p, f)
    found = {}
    for name in LABELS:
        values: Floats | None
        if name == "quadratic":
            values = quadratic(points, faces, vertex, levels)
        else:
            values = linear(name, fine[0][1], fine[0][2], vertex)
            for s, _, _ in fine[1:]:
                values = None if values is None else s.refine(values)
        found[name] = reached_errors(p, f, values, reference)
    return found


def cell(pair: Pair | None) -> str:
    """RMSE and largest error in a table."""
    return "fails" if pair is None else f"{pair[0]:.2e} / {pair[1]:.2e}"


def header(first: Sequence[str]) -> str:
    """Titles of a table's columns."""
    titles = [*first, *LABELS.values()]
    return "| " + " | ".join(titles) + " |\n" + "|---" * len(titles) + "|"


def table(paths: list[Path], vertex: int, plot: Path | None) -> None:
    """Table 1 of the paper over some meshes, and its means; figure 3."""
    print("RMSE / largest error\n\n" + header(["mesh", "faces", "angles", "kind"]))
    loaded = [(path, *load(path)) for path in paths]
    rows: list[tuple[str, dict[str, Pair | None]]] = []
    for path, points, faces in sorted(loaded, key=lambda row: len(row[2])):
        levels = 2 if len(faces) <= 20000 else 1
        own: set[str] = set()
        truth = partial(exact, vertex=vertex, own=own)
        found = compare(points, faces, vertex, levels, truth)
        rows.append((path.stem, found))
        kind = Kind(points, faces)
        first = (
            f"| {path.stem}{'*' if own else ''} | {len(faces)} | {kind.angles} | {kind.words} | "
        )
        print(first + " | ".join(cell(found[n]) for n in LABELS) + " |", flush=True)
    good = [row for _, row in rows if all(row.values())]
    for what, middle in (("mean", np.mean), ("median", np.median)):
        cells = []
        for n in LABELS:
            pairs = np.array([row[n] for row in good], dtype=np.float64)
            cells.append(cell((float(middle(pairs[:, 0])), float(middle(pairs[:, 1])))))
        print(f"| **{what} of {len(good)}** | | | | " + " | ".join(cells) + " |")
    print("\n\\* reference: littoral's own exact distance, as pygeodesic cannot", end="")
    for n in list(LABELS)[:-1]:
        both = [(row[n], row["quadratic"]) for _, row in rows if row[n] and row["quadratic"]]
        less = [sum(q[k] < o[k] for o, q in both if o and q) for k in range(2)]
        print(f"\nquadratic below {LABELS[n]}: {less[0]} and {less[1]} of {len(both)}", end="")
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    print(f"\n\n{used.ru_utime + used.ru_stime:.0f} processor seconds")
    if plot:
        draw.meshes(rows, plot)


def icosphere(level: int) -> tuple[Floats, Ints]:
    """A subdivided icosahedron on the unit sphere, vertex 0 at a pole."""
    angle = np.arange(5) * 2 * np.pi / 5
    z, r = 1 / np.sqrt(5), 2 / np.sqrt(5)
    upper = np.stack([r * np.cos(angle), r * np.sin(angle), np.full(5, z)], 1)
    lower = np.stack([r * np.cos(angle + np.pi / 5), r * np.sin(angle + np.pi / 5)], 1)
    lower = np.concatenate([lower, np.full((5, 1), -z)], 1)
    points = np.concatenate([[[0, 0, 1]], upper, lower, [[0, 0, -1]]])
    faces = []
    for i in range(5):
        j = (i + 1) % 5
        faces += [[0, 1 + i, 1 + j], [1 + i, 6 + i, 1 + j], [1 + j, 6 + i, 6 + j]]
        faces += [[11, 6 + j, 6 + i]]
    f = np.array(faces, dtype=np.int64)
    for _ in range(level):
        s = Subdivision(points, f)
        points, f = s.points / np.linalg.norm(s.points, axis=1, keepdims=True), s.faces
    return points, f


def sphere(plot: Path | None) -> None:
    """Figure 6: error against great circles, from the pole; order between levels."""
    results: list[tuple[float, dict[str, Pair | None]]] = []
    for level in range(1, 5):
        points, faces = icosphere(level)
        found = compare(
            points,
            faces,
            0,
            1,
            lambda p, f: np.arccos(np.clip(p[:, 2] / np.linalg.norm(p, axis=1), -1, 1)),
            lambda p: p / np.linalg.norm(p, axis=1, keepdims=True),
        )
        results.append((mean_edge(points, faces), found))
    show(results, "sphere")
    if plot:
        draw.convergence({"sphere": (results, None)}, plot)


def show(results: list[tuple[float, dict[str, Pair | None]]], title: str) -> None:
    """A table of errors against h with the order between rows."""
    print(f"\n{title}: RMSE (order) / largest error\n\n" + header(["h"]))
    for k, (h, found) in enumerate(results):
        cells = []
        for n in LABELS:
            now, before = found[n], results[k - 1][1][n] if k else None
            text = cell(now)
            if now and before and now[0] > 1e-12:
                order = np.log(before[0] / now[0]) / np.log(results[k - 1][0] / h)
                text = text.replace(" /", f" ({order:.1f}) /")
            # On the reference's own mesh the exact distance has no error.
            cells.append("the reference itself" if now and now[0] < 1e-12 else text)
        print(f"| {h:.3f} | " + " | ".join(cells) + " |", flush=True)


def convergence(paths: list[Path], vertex: int, plot: Path | None) -> None:
    """Figure 5: errors under subdivision against the exact distance on the third subdivision."""
    drawn = {}
    for path in paths:
        points, faces = load(path)
        title, least = path.stem, corner_angles(points, faces)
        results = []
        for level in range(3):
            found = compare(points, faces, vertex, 3 - level, partial(exact, vertex=vertex))
            results.append((mean_edge(points, faces), found))
            points, faces = subdivided(points, faces, 1)
        show(results, title)
        drawn[title] = (results, least)
    if plot:
        draw.convergence(drawn, plot)


def noise(path: Path, vertex: int, plot: Path | None) -> None:
    """Figure 8: Gaussian noise on the vertices (fixed seeds), errors against the clean surface."""
    clean, faces = load(path)
    once = Subdivision(clean, faces)  # linear methods: subdivided first, then noised
    twice = Subdivision(once.points, once.faces)
    reference = exact(twice.points, twice.faces, vertex)
    print(f"{path.stem}: RMSE / largest error\n\n" + header(["noise"]))
    results, shown = [], []
    for sigma in (0.0, 0.004, 0.008):
        moved, once_moved = (
            x + np.random.default_rng(1).normal(0, sigma, x.shape) for x in (clean, once.points)
        )
        found: dict[str, Pair | None] = {}
        for n in LABELS:
            if n == "quadratic":
                values = quadratic(moved, faces, vertex, 2)
                surface = subdivided(moved, faces, 2)
            else:
                coarse = linear(n, once_moved, once.faces, vertex)
                values = None if coarse is None else twice.refine(coarse)
                surface = (twice.refine(once_moved), twice.faces)
            found[n] = reached_errors(twice.points, twice.faces, values, reference)
            if n in OF_PAPER and values is not None:
                shown.append((sigma, n, *surface, values))
        results.append((sigma, found))
        print(f"| {sigma} | " + " | ".join(cell(found[n]) for n in LABELS) + " |", flush=True)
    if plot:
        draw.noise(results, shown, plot)


def moving(path: Path, first: int, plot: Path | None, steps: int = 8) -> None:
    """Figure 12: a source moves straight from one face's centre over an edge to the next one's.
    Distances may change by no more than the source moves."""
    points, faces = load(path)
    shared = set(faces[first, :2])
    second = next(f for f in range(len(faces)) if f != first and len(shared & set(faces[f])) == 2)
    runs: list[Run] = []
    places = np.empty((steps + 1, 3))
    changes = np.zeros(steps + 1)
    print("| step | face | source moves | largest change | mean change | steps of the solver |")
    print("|---|---|---|---|---|---|")
    for k in range(steps + 1):
        t = 2 * k / steps - 1
        face = first if t < 0 else second
        b = np.full(3, abs(t) / 3) + (1 - abs(t)) * 0.5 * np.isin(faces[face], faces[first, :2])
        places[k] = b @ points[faces[face]]
        runs.append(Run(points, faces, (face, b), "quadratic", ["--subdivide", "8"]))
        change = np.abs(runs[-1].values - runs[-2].values) if k else np.zeros(1)
        changes[k] = change.max()
        step = float(np.linalg.norm(places[k] - places[k - 1])) if k else 0.0
        print(
            f"| {k} | {face} | {step:.2e} | {changes[k]:.2e} | {change.mean():.2e} "
            f"| {runs[-1].report['iterations']['interior point']:.0f} |",
            flush=True,
        )
    if plot:
        draw.moving(points, faces, runs, places, changes[1:], plot)


def main() -> None:
    """Reads the arguments."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("study", choices=["table", "sphere", "convergence", "noise", "moving"])
    parser.add_argument("meshes", nargs="*", type=Path)
    parser.add_argument("--list", type=Path)
    parser.add_argument("--vertex", type=int, default=0)
    parser.add_argument("--face", type=int, default=0, help="where the moving source starts")
    parser.add_argument("--plot", type=Path)
    arguments = parser.parse_args()
    meshes, vertex, plot = arguments.meshes, arguments.vertex, arguments.plot
    if arguments.list:
        folder = Path(os.environ["LITTORAL_SHARED"]) / "data"
        meshes += [folder / line for line in arguments.list.read_text().split()]
    if arguments.study == "table":
        table(meshes, vertex, plot)
    elif arguments.study == "sphere":
        sphere(plot)
    elif arguments.study == "convergence":
        convergence(meshes, vertex, plot)
    elif arguments.study == "noise":
        noise(meshes[0], vertex, plot)
    else:
        moving(meshes[0], arguments.face, plot)


if __name__ == "__main__":
    main()
