"""Accuracy of quadratic-order geodesics beside the program's other unsigned methods.

usage: accuracy.py table MESH... | sphere | convergence MESH... | noise MESH | moving MESH

Prints Markdown; `convergence`, `sphere` and `noise` also write a plot with `--plot FILE.png`. The
protocol is that of section 6.2: lengths in units of the bounding box's diagonal; the quadratic
method runs on the mesh, all others on the mesh subdivided once, as that has as many nodes; all are
compared on the mesh subdivided twice with the exact polyhedral distance there (PyPI pygeodesic; on
the sphere, with great circles), linear methods interpolated linearly, the quadratic one evaluated.
RMSE is sqrt(e^T M1 e / 1^T M1 1).
"""

import argparse
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pygeodesic.geodesic as geodesic
from scipy.spatial import cKDTree
from surface import Floats, Ints, Run, Subdivision, errors, known_methods, load, mean_edge

LINEAR = ("unsigned-heat", "fast-marching", "regularized", "exact")
OPTIONS = {"regularized": ["--alpha", "0"]}
LABELS = {
    "unsigned-heat": "heat",
    "fast-marching": "fast marching",
    "regularized": "Belyaev-Fayolle",
    "exact": "exact polyhedral",
    "quadratic": "quadratic",
}


def methods() -> list[str]:
    """Those to compare, of what this build has; quadratic last."""
    known = known_methods()
    return [name for name in LINEAR if name in known] + ["quadratic"]


def exact(points: Floats, faces: Ints, vertex: int) -> Floats:
    """Exact polyhedral distance at the vertices."""
    solver = geodesic.PyGeodesicAlgorithmExact(points, faces.astype(np.int32))
    distance, _ = solver.geodesicDistances(np.array([vertex], dtype=np.int32), None)
    return np.asarray(distance)


Project = Callable[[Floats], Floats]


def compare(
    points: Floats,
    faces: Ints,
    vertex: int,
    levels: int,
    truth: Callable[[Floats, Ints], Floats],
    project: Project = lambda x: x,
) -> tuple[dict[str, tuple[float, float]], dict[str, float]]:
    """RMSE and largest error, and processor seconds, of each method, all evaluated on the mesh
    subdivided `levels` times. `project` moves the vertices of every subdivision (onto a sphere)."""
    fine = []
    p, f = points, faces
    for _ in range(levels):
        s = Subdivision(p, f)
        p, f = project(s.points), s.faces
        fine.append((s, p, f))
    reference = truth(p, f)
    found, seconds = {}, {}
    for name in methods():
        if name == "quadratic":
            run = Run(points, faces, vertex, name, ["--subdivide", str(2**levels)])
            flat, g = points, faces  # the same places on the unprojected mesh
            for _ in range(levels):
                s = Subdivision(flat, g)
                flat, g = s.points, s.faces
            _, at = cKDTree(run.points).query(flat)
            values = run.values[at]
        else:
            run = Run(fine[0][1], fine[0][2], vertex, name, OPTIONS.get(name, []))
            values = run.values
            for s, _, _ in fine[1:]:
                values = s.refine(values)
        found[name] = errors(p, f, values - reference)
        seconds[name] = run.seconds
    return found, seconds


def table(paths: list[Path], vertex: int) -> None:
    """Table 1 of the paper over some meshes, and its means."""
    names = methods()
    print("| mesh | faces | " + " | ".join(f"{LABELS[n]}: RMSE / max" for n in names) + " |")
    print("|---" * (2 + len(names)) + "|")
    rows = []
    for path in paths:
        points, faces = load(path)
        found, _ = compare(points, faces, vertex, 2, lambda p, f: exact(p, f, vertex))
        rows.append([found[n] for n in names])
        cells = " | ".join(f"{found[n][0]:.2e} / {found[n][1]:.2e}" for n in names)
        print(f"| {path.stem} | {len(faces)} | {cells} |", flush=True)
    mean = np.array(rows).mean(0)
    print("| **mean** | | " + " | ".join(f"{a:.2e} / {b:.2e}" for a, b in mean) + " |")


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
    names = methods()
    results: list[tuple[float, dict[str, tuple[float, float]]]] = []
    for level in range(1, 5):
        points, faces = icosphere(level)
        found, _ = compare(
            points,
            faces,
            0,
            1,
            lambda p, f: np.arccos(np.clip(p[:, 2] / np.linalg.norm(p, axis=1), -1, 1)),
            lambda p: p / np.linalg.norm(p, axis=1, keepdims=True),
        )
        results.append((mean_edge(points, faces), found))
    show(results, names, "sphere", plot)


def show(
    results: list[tuple[float, dict[str, tuple[float, float]]]],
    names: list[str],
    title: str,
    plot: Path | None,
) -> None:
    """A table of errors against h with the order between rows, and a plot of both."""
    print(
        f"\n{title}\n\n| h | "
        + " | ".join(f"{LABELS[n]}: RMSE (order) / max" for n in names)
        + " |"
    )
    print("|---" * (1 + len(names)) + "|")
    for k, (h, found) in enumerate(results):
        cells = []
        for n in names:
            order = ""
            if k > 0:
                before, last = results[k - 1]
                order = f" ({np.log(last[n][0] / found[n][0]) / np.log(before / h):.1f})"
            cells.append(f"{found[n][0]:.2e}{order} / {found[n][1]:.2e}")
        print(f"| {h:.3f} | " + " | ".join(cells) + " |", flush=True)
    if plot:
        draw(results, names, title, plot, "mean edge length h")


def draw(
    results: list[tuple[float, dict[str, tuple[float, float]]]],
    names: list[str],
    title: str,
    plot: Path,
    label: str,
) -> None:
    """RMSE and largest error, logarithmic."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot
    from matplotlib.ticker import NullFormatter

    figure, axes = pyplot.subplots(1, 2, figsize=(8, 3.4))
    for axis, which, what in ((axes[0], 0, "RMSE"), (axes[1], 1, "largest error")):
        for n in names:
            # On the reference's own mesh the exact distance has no error to draw.
            values = [e[n][which] if e[n][which] > 1e-12 else np.nan for _, e in results]
            axis.loglog([h for h, _ in results], values, "o-", label=LABELS[n])
        axis.xaxis.set_minor_formatter(NullFormatter())
        axis.set_xlabel(label)
        axis.set_title(f"{title}: {what}", fontsize=9)
        axis.grid(True, which="both", alpha=0.3)
    axes[0].legend(fontsize=7)
    figure.tight_layout()
    figure.savefig(plot, dpi=90)


def convergence(paths: list[Path], vertex: int, plot: Path | None) -> None:
    """Figure 5: errors under subdivision against the exact distance on the third subdivision."""
    names = methods()
    for path in paths:
        points, faces = load(path)
        results = []
        for level in range(3):
            found, _ = compare(points, faces, vertex, 3 - level, lambda p, f: exact(p, f, vertex))
            results.append((mean_edge(points, faces), found))
            s = Subdivision(points, faces)
            points, faces = s.points, s.faces
        out = plot.with_stem(f"{plot.stem}-{path.stem}") if plot else None
        show(results, names, path.stem, out)


def noise(path: Path, vertex: int) -> None:
    """Figure 8: Gaussian noise on the vertices (fixed seeds), errors against the clean surface."""
    clean, faces = load(path)
    p, f = clean, faces
    for _ in range(2):
        s = Subdivision(p, f)
        p, f = s.points, s.faces
    reference = exact(p, f, vertex)
    names = methods()
    print("| noise | " + " | ".join(f"{LABELS[n]}: RMSE / max" for n in names) + " |")
    print("|---" * (1 + len(names)) + "|")
    for sigma in (0.0, 0.004, 0.008):
        moved = clean + np.random.default_rng(1).normal(0, sigma, clean.shape)
        once = Subdivision(clean, faces)  # linear methods: subdivided first, then noised
        once_moved = once.points + np.random.default_rng(1).normal(0, sigma, once.points.shape)
        twice = Subdivision(once.points, once.faces)
        cells = []
        for n in names:
            if n == "quadratic":
                run = Run(moved, faces, vertex, n, ["--subdivide", "4"])
                s1 = Subdivision(moved, faces)
                s2 = Subdivision(s1.points, s1.faces)
                _, at = cKDTree(run.points).query(s2.points)
                values = run.values[at]
            else:
                run = Run(once_moved, once.faces, vertex, n, OPTIONS.get(n, []))
                values = twice.refine(run.values)
            rmse, largest = errors(p, f, values - reference)
            cells.append(f"{rmse:.2e} / {largest:.2e}")
        print(f"| {sigma} | " + " | ".join(cells) + " |", flush=True)


def moving(path: Path, steps: int = 8) -> None:
    """Figure 12: a source moves straight from one face's centre over an edge to the next one's.
    Distances may change by no more than the source moves."""
    points, faces = load(path)
    first = 0
    shared = set(faces[first, :2])
    second = next(f for f in range(len(faces)) if f != first and len(shared & set(faces[f])) == 2)
    middle = points[faces[first, :2]].mean(0)
    before: Floats | None = None
    last = np.zeros(3)
    print("| step | face | source moves | largest change | mean change | iterations |")
    print("|---|---|---|---|---|---|")
    for k in range(steps + 1):
        t = 2 * k / steps - 1
        face = first if t < 0 else second
        b = np.full(3, abs(t) / 3) + (1 - abs(t)) * 0.5 * np.isin(faces[face], faces[first, :2])
        place = b @ points[faces[face]]
        run = Run(points, faces, (face, b), "quadratic")
        change = np.abs(run.values - before) if before is not None else np.zeros(1)
        step = float(np.linalg.norm(place - last)) if before is not None else 0.0
        iterations = run.report["iterations"]["interior point"]
        print(
            f"| {k} | {face} | {step:.2e} | {change.max():.2e} | {change.mean():.2e} "
            f"| {iterations:.0f} |",
            flush=True,
        )
        before, last = run.values, place
    print(f"\nThe edge's midpoint is at {np.round(middle, 3)}.")


def main() -> None:
    """Reads the arguments."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("study", choices=["table", "sphere", "convergence", "noise", "moving"])
    parser.add_argument("meshes", nargs="*", type=Path)
    parser.add_argument("--vertex", type=int, default=0)
    parser.add_argument("--plot", type=Path)
    arguments = parser.parse_args()
    if arguments.study == "table":
        table(arguments.meshes, arguments.vertex)
    elif arguments.study == "sphere":
        sphere(arguments.plot)
    elif arguments.study == "convergence":
        convergence(arguments.meshes, arguments.vertex, arguments.plot)
    elif arguments.study == "noise":
        noise(arguments.meshes[0], arguments.vertex)
    else:
        moving(arguments.meshes[0])


if __name__ == "__main__":
    main()
