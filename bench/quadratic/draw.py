"""Plots and pictures of the studies in accuracy.py."""

import io
import subprocess
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from compared import LABELS, OF_PAPER
from numpy.typing import NDArray
from PIL import Image, ImageChops
from surface import PROGRAM, Floats, Ints, Run

matplotlib.use("Agg")
from matplotlib import pyplot
from matplotlib.tri import Triangulation

Pair = tuple[float, float]
Results = list[tuple[float, dict[str, Pair | None]]]
WHAT = ("RMSE", "largest error")
COLOURS = dict(
    zip(
        LABELS,
        ["#d55e00", "#e69f00", "#56b4e9", "#0072b2", "#009e73", "#999999", "#cc0077"],
        strict=True,
    )
)


def save(figure: Any, plot: Path, dpi: int = 90, colours: int = 64, below: float = 0) -> None:
    """Writes the figure with so many colours, `below` inches left at its bottom."""
    figure.tight_layout(rect=(0, below / figure.get_size_inches()[1], 1, 1))
    memory = io.BytesIO()
    figure.savefig(memory, dpi=dpi)
    Image.open(memory).convert("RGB").quantize(colours).save(plot, optimize=True)
    pyplot.close(figure)


def value(found: dict[str, Pair | None], name: str, which: int) -> float:
    """An error to draw: none where the method fails or is the reference itself."""
    pair = found[name]
    return pair[which] if pair and pair[0] > 1e-12 else np.nan


def meshes(rows: list[tuple[str, dict[str, Pair | None]]], plot: Path) -> None:
    """Every method's errors over the quadratic one's, mesh by mesh; below 1 it is better."""
    figure, axes = pyplot.subplots(2, 1, figsize=(9, 6.4), sharex=True)
    at = np.arange(len(rows))
    for which, axis in enumerate(axes):
        own = np.array([value(found, "quadratic", which) for _, found in rows])
        for name in list(LABELS)[:-1]:
            ratio = own / np.array([value(found, name, which) for _, found in rows])
            mark = "o" if name in OF_PAPER else "x"
            axis.semilogy(at, ratio, mark, ms=4, color=COLOURS[name], label=LABELS[name])
        axis.axhline(1, color="#cc0077", lw=1)
        axis.set_ylabel(f"{WHAT[which]}, quadratic over other", fontsize=8)
        axis.grid(True, which="major", alpha=0.3)
    axes[1].set_xticks(at, [name for name, _ in rows], rotation=90, fontsize=7)
    figure.legend(*axes[0].get_legend_handles_labels(), fontsize=7, ncols=6, loc="lower center")
    save(figure, plot, below=0.3)


def convergence(drawn: Mapping[str, tuple[Results, Floats | None]], plot: Path) -> None:
    """Errors against the mean edge length, logarithmic, and the angles of each mesh if given."""
    count = 2 if all(angles is None for _, angles in drawn.values()) else 3
    size = (3.6 * count, 3.3) if len(drawn) == 1 else (2.1 * len(drawn), 2.0 * count + 0.5)
    shape = (1, count) if len(drawn) == 1 else (count, len(drawn))
    figure, grid = pyplot.subplots(*shape, figsize=size, squeeze=False)
    for k, (title, (results, angles)) in enumerate(drawn.items()):
        axes = grid[0] if len(drawn) == 1 else grid[:, k]
        for which in range(2):
            for n in LABELS:
                values = [value(found, n, which) for _, found in results]
                mark = "o-" if n in OF_PAPER else "x:"
                axes[which].loglog(
                    [h for h, _ in results],
                    values,
                    mark,
                    ms=3,
                    lw=1,
                    color=COLOURS[n],
                    label=LABELS[n],
                )
            axes[which].minorticks_off()
            axes[which].set_xticks([h for h, _ in results], [f"{h:.2g}" for h, _ in results])
            axes[which].tick_params(labelsize=6)
            axes[which].set_title(f"{title}: {WHAT[which]}" if k == 0 else title, fontsize=8)
            axes[which].grid(True, which="both", alpha=0.3)
        if angles is not None:
            axes[2].hist(angles.ravel(), bins=45, range=(0, 180), color="#999999")
            axes[2].set_yticks([])
            axes[2].tick_params(labelsize=6)
            axes[2].set_title("angles, degrees" if k == 0 else "", fontsize=8)
        for axis in axes[:2] if len(drawn) == 1 else axes[1:2]:
            axis.set_xlabel("mean edge length h", fontsize=7)
    labels = grid[0, 0].get_legend_handles_labels()
    figure.legend(*labels, fontsize=7, ncols=4, loc="lower center")
    save(figure, plot, below=0.45)


def field(points: Floats, faces: Ints, values: Floats) -> Image.Image:
    """The program's picture of a field, without its scale."""
    with tempfile.TemporaryDirectory() as folder:
        mesh, out = Path(folder) / "field.ply", Path(folder) / "field.png"
        lines = [
            f"ply\nformat ascii 1.0\nelement vertex {len(points)}",
            *(f"property double {name}" for name in ("x", "y", "z", "distance")),
            f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header",
            *(
                f"{x:.9g} {y:.9g} {z:.9g} {d:.9g}"
                for (x, y, z), d in zip(points, values, strict=True)
            ),
            *(f"3 {a} {b} {c}" for a, b, c in faces),
        ]
        mesh.write_text("\n".join(lines) + "\n")
        size = ["--width", "1200", "--height", "900", "--isolines", "14"]
        subprocess.run([PROGRAM, "render", str(mesh), *size, "--quiet", "-o", str(out)], check=True)
        image = Image.open(out).convert("RGB")
        image = image.crop((0, 0, int(image.width * 0.9), image.height))  # without the scale
        plain = Image.new("RGB", image.size, image.getpixel((0, 0)))
        return image.crop(ImageChops.difference(image, plain).getbbox())


def noise(
    results: Results,
    shown: Sequence[tuple[float, str, Floats, Ints, Floats]],
    plot: Path,
) -> None:
    """Figure 8: fields of the paper's four methods under noise, and the errors of all."""
    sigmas = [sigma for sigma, _ in results]
    figure = pyplot.figure(figsize=(9, 9.6))
    grid = figure.add_gridspec(len(sigmas) + 1, 4, height_ratios=[1] * len(sigmas) + [1])
    for sigma, name, points, faces, values in shown:
        row, column = sigmas.index(sigma), OF_PAPER.index(name)
        axis = figure.add_subplot(grid[row, column])
        axis.imshow(field(points, faces, values))
        axis.axis("off")
        title = LABELS[name] if row == 0 else ""
        axis.set_title(title, fontsize=8)
        if column == 0:
            axis.text(
                -0.02,
                0.5,
                f"noise {sigma:g}",
                transform=axis.transAxes,
                rotation=90,
                va="center",
                ha="right",
                fontsize=8,
            )
    for which in range(2):
        axis = figure.add_subplot(grid[-1, 2 * which : 2 * which + 2])
        for n in LABELS:
            mark = "o-" if n in OF_PAPER else "x:"
            axis.semilogy(
                sigmas,
                [value(found, n, which) for _, found in results],
                mark,
                ms=4,
                color=COLOURS[n],
                label=LABELS[n],
            )
        axis.set_xticks(sigmas)
        axis.set_xlabel("standard deviation of the noise, in diagonals", fontsize=8)
        axis.set_title(WHAT[which], fontsize=8)
        axis.tick_params(labelsize=7)
        axis.grid(True, which="both", alpha=0.3)
        if which == 0:
            axis.legend(fontsize=6)
    save(figure, plot, 100, 255)


def moving(
    points: Floats,
    faces: Ints,
    runs: Sequence[Run],
    places: Floats,
    changes: Floats,
    plot: Path,
) -> None:
    """Figure 12: the field around a source on its way, seen from above, with the mesh; and how far
    the distance changes from step to step."""
    middle, far = places.mean(0), 3 * float(np.linalg.norm(places[-1] - places[0]))
    a, b, c = (points[faces[:, k]] for k in range(3))
    near = np.linalg.norm((a + b + c) / 3 - middle, axis=1) < far / 2
    normal = np.cross(b - a, c - a)[near].sum(0)
    up = normal / np.linalg.norm(normal)
    x = np.cross(up, np.eye(3)[np.abs(up).argmin()])
    x /= np.linalg.norm(x)
    flat = np.stack([x, np.cross(up, x)], 1)  # 3 x 2: onto the picture
    mesh = faces[front(points, faces, up, middle, 2 * far)]
    level = np.linspace(0, 1.5 * far, 19)
    shown = range(0, len(runs), max(1, (len(runs) - 1) // 4))
    figure = pyplot.figure(figsize=(9, 4.0))
    grid = figure.add_gridspec(2, len(shown), height_ratios=[1.6, 1])
    for column, k in enumerate(shown):
        axis, run = figure.add_subplot(grid[0, column]), runs[k]
        fine = run.faces[front(run.points, run.faces, up, middle, 2 * far)]
        across, along = ((run.points - middle) @ flat).T
        plane = Triangulation(across, along, fine)
        axis.tricontourf(plane, run.values, level, cmap="YlGnBu", extend="max")
        axis.tricontour(plane, run.values, level, colors="#333333", linewidths=0.6)
        axis.triplot(*((points - middle) @ flat).T, mesh, color="white", lw=0.5)
        axis.plot(*((places[k] - middle) @ flat), "o", color="#cc0077", ms=4)
        axis.set(xlim=(-far, far), ylim=(-far, far), aspect="equal")
        axis.axis("off")
        axis.set_title(f"after step {k}", fontsize=8)
    axis = figure.add_subplot(grid[1, :])
    steps = np.arange(1, len(changes) + 1)
    moves = np.linalg.norm(np.diff(places, axis=0), axis=1)
    axis.bar(steps - 0.2, moves, 0.4, color="#999999", label="the source moves")
    axis.bar(steps + 0.2, changes, 0.4, color="#cc0077", label="largest change of the distance")
    axis.set_xticks(steps)
    axis.set_xlabel("step", fontsize=8)
    axis.tick_params(labelsize=7)
    axis.set_ylim(0, 1.5 * max(moves.max(), changes.max()))
    axis.legend(fontsize=7, ncols=2)
    save(figure, plot, colours=128)


def front(points: Floats, faces: Ints, up: Floats, middle: Floats, far: float) -> NDArray[np.bool_]:
    """Faces near a place whose front is seen from above."""
    a, b, c = (points[faces[:, k]] for k in range(3))
    close = np.linalg.norm((a + b + c) / 3 - middle, axis=1) < far
    return np.asarray(close & (np.cross(b - a, c - a) @ up > 0))
