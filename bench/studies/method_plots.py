"""Error over time of every method, and a plot for each method's page.

usage: method_plots.py surface MESH... > FILE.csv    needs littoral and pygeodesic
       method_plots.py space > FILE.csv              needs littoral
       method_plots.py plot SURFACE.csv SPACE.csv MEASUREMENTS FOLDER  needs matplotlib
       method_plots.py table SURFACE.csv SPACE.csv   prints Markdown

Surface: from vertex 0 of each mesh, against exact polyhedral distance by pygeodesic; mean error in
% of the largest distance. Space: clouds of 2,048 points with exact normals on five shapes in
[-1, 1]^3 (bench/studies/tori_accuracy.py), on 32^3 nodes; mean error in % of the longest side.
Seconds are processor time of one thread for preparing and solving. Regions and all pairs are drawn
from their tables in docs/measurements, MEASUREMENTS.
"""

import csv
import sys
import time
from collections import defaultdict
from collections.abc import Callable
from pathlib import Path

import numpy as np

SURFACE = {
    "auto": {},
    "exact": {},
    "fast-marching": {},
    "signed-heat": {},
    "unsigned-heat": {},
    "regularized": {"alpha": 0.02},
    "belyaev-fayolle": {},
    "quadratic": {},
}
SPACE = ("auto", "winding", "tori", "signed-heat", "hopf-cole", "planar", "log-sum-exp")
FLOOR = 0.01  # smaller errors on surfaces are drawn here [%]
BELOW = {"unsigned-heat", "exact", "planar", "winding"}  # their names are crowded above


def row(where: str, size: int, method: str, error: float, seconds: float) -> None:
    print(f"{where},{size},{method},{error:.3g},{seconds:.3g}", flush=True)


def timed(call: Callable[[], object]) -> tuple[object, float]:
    start = time.process_time()
    result = call()
    return result, time.process_time() - start


def surface(paths: list[Path]) -> None:
    from pygeodesic import geodesic

    import littoral

    for path in paths:
        mesh = littoral.read(path)
        V, F = np.array(mesh.points), np.array(mesh.faces)
        truth = geodesic.PyGeodesicAlgorithmExact(V, F).geodesicDistances(np.array([0]))[0]
        for method, options in SURFACE.items():
            field, seconds = timed(
                lambda m=mesh, name=method, o=options: littoral.distance(
                    m, points=0, method=name, threads=1, **o
                )
            )
            error = 100 * abs(field.values - truth).mean() / truth.max()
            row(path.stem, len(F), method, error, seconds)


def space() -> None:
    from tori_accuracy import ANALYTIC, analytic_cloud

    import littoral

    a = np.linspace(-1, 1, 32)
    nodes = np.stack(np.meshgrid(a, a, a, indexing="ij"), -1).reshape(-1, 3)
    littoral.set_threads(1)
    for shape, distance in ANALYTIC.items():
        points, normals = analytic_cloud(shape, 2048, np.random.default_rng(5))
        truth, side = distance(nodes), np.ptp(points, axis=0).max()
        for method in SPACE:
            if method == "signed-heat":
                box = [-1.0] * 3 + [1.0] * 3
                volume, seconds = timed(
                    lambda p=points, n=normals, b=box: littoral.signed_heat_grid(
                        p, n, bounds=b, spacing=2 / 31
                    )
                )
                values = np.asarray(volume.values).reshape(-1)
            else:
                values, seconds = timed(
                    lambda p=points, n=normals, m=method: littoral.SDF(p, n, method=m)(nodes)
                )
            row(shape, 2048, method, 100 * abs(values - truth).mean() / side, seconds)


def read(path: Path) -> dict[str, list[tuple[str, int, float, float]]]:
    found = defaultdict(list)
    for where, size, method, error, seconds in csv.reader(path.open()):
        found[method].append((where, int(size), float(error), float(seconds)))
    return found


def plot(tables: list[Path], folder: Path) -> None:
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    per = "µs of processor time per triangle", "processor seconds"
    for kind, path, xlabel in zip(("surface", "space"), tables, per, strict=True):
        found = read(path)
        shared = {"planar", "log-sum-exp", "belyaev-fayolle"}  # on a page with another
        for shown in found.keys() - shared:
            figure, axes = plt.subplots(figsize=(5.6, 3.2), dpi=110)
            for method, rows in found.items():
                scale = [1e6 / r[1] if kind == "surface" else 1 for r in rows]
                x = [r[3] * s for r, s in zip(rows, scale, strict=True)]
                y = [max(r[2], FLOOR if kind == "surface" else 0) for r in rows]
                mine = method == shown
                axes.loglog(
                    x, y, "o", color="#00796b" if mine else "#c4c9d0",
                    markersize=6 if mine else 4, zorder=2 if mine else 1,
                )  # fmt: skip
                below = method in BELOW
                at = np.exp(np.log(x).mean()), min(y) if below else max(y)
                if method == "belyaev-fayolle":  # it lies where regularized does
                    continue
                axes.annotate(
                    method, at, fontsize=9 if mine else 7, ha="center", zorder=3,
                    color="#00564d" if mine else "#7a828c", xytext=(0, -6 if below else 6),
                    va="top" if below else "bottom", textcoords="offset points",
                )  # fmt: skip
            axes.set_xlabel(xlabel)
            axes.set_ylabel("mean error [%]" + (", 0.01 or less" if kind == "surface" else ""))
            axes.margins(0.14)
            axes.grid(alpha=0.3)
            figure.tight_layout()
            figure.savefig(folder / f"method-{kind}-{shown}.png")
            plt.close(figure)


def rows_of(page: Path, first: str) -> list[list[str]]:
    """The rows of the table of a page whose head starts with `first`."""
    text = page.read_text()
    body = text[text.index(first) :].split("\n\n")[0].splitlines()[2:]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in body]


def plot_tables(measurements: Path, folder: Path) -> None:
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    regions = rows_of(measurements / "regions.md", "| genus | faces | cases |")
    pairs = [
        r
        for r in rows_of(measurements / "regularized.md", "| method | parameter | against")
        if r[0] == "symmetric"
    ]
    for name, x, y, xlabel, ylabel in (
        ("surface-winding", [r[0] for r in regions], [float(r[3].split("/")[0]) for r in regions],
         "genus of the surface", "mislabelled area, mean [%]"),
        ("symmetric", [r[1] for r in pairs], [float(r[2].split()[0]) for r in pairs],
         "alpha", "triplets against the\ntriangle inequality [%]"),
    ):  # fmt: skip
        figure, axes = plt.subplots(figsize=(5.6, 3.2), dpi=110)
        axes.bar(x, y, color="#00796b", width=0.6)
        axes.set_xlabel(xlabel)
        axes.set_ylabel(ylabel)
        axes.grid(alpha=0.3, axis="y")
        figure.tight_layout()
        figure.savefig(folder / f"method-{name}.png")
        plt.close(figure)


def table(paths: list[Path]) -> None:
    for path in paths:
        found = read(path)
        columns = [r[0] for r in next(iter(found.values()))]
        print("| method | " + " | ".join(columns) + " |")
        print("|---" * (1 + len(columns)) + "|")
        for method, rows in found.items():
            cells = [f"{e:.2g}, {s:.2g}" if e > 1e-9 else f"0, {s:.2g}" for _, _, e, s in rows]
            print(f"| {method} | " + " | ".join(cells) + " |")
        print()


if __name__ == "__main__":
    what, *files = sys.argv[1:]
    if what == "surface":
        surface([Path(f) for f in files])
    elif what == "space":
        space()
    elif what == "plot":
        plot([Path(f) for f in files[:2]], Path(files[3]))
        plot_tables(Path(files[2]), Path(files[3]))
    else:
        table([Path(f) for f in files])
