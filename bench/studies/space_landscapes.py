"""Draws the landscapes of `littoral_space_accuracy landscapes N` (thesis, figures 7.7 and 7.8).

usage: space_landscapes.py IN.csv OUT.png

One row a shape and kind of damage, one column a method; colours are mean errors of signed distance
over [-1, 1]^3. Prints a table in Markdown: the mean over all sizes of the shape.
"""

import csv
import sys
from collections import defaultdict
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm

LABELS = {
    "noise": "noise, standard deviation",
    "outliers": "outliers, share of points",
    "flips": "flipped normals, share",
    "points": "number of points",
}
Cells = dict[tuple[float, float], float]  # by radius and amount


def read(path: Path) -> dict[tuple[str, str], dict[str, Cells]]:
    """Errors by shape and damage, then by method."""
    out: dict[tuple[str, str], dict[str, Cells]] = defaultdict(lambda: defaultdict(dict))
    with path.open() as lines:
        for row in csv.DictReader(lines):
            cell = (float(row["radius"]), float(row["amount"]))
            out[row["shape"], row["damage"]][row["method"]][cell] = float(row["error"])
    return out


def draw(data: dict[tuple[str, str], dict[str, Cells]], out: Path) -> None:
    """The picture."""
    methods = list(next(iter(data.values())))
    size = (1.7 * len(methods) + 1, 1.5 * len(data) + 0.6)
    figure, axes = plt.subplots(len(data), len(methods), figsize=size, squeeze=False)
    least = 0.003
    norm = LogNorm(least, 0.5)
    for row, ((shape, damage), columns) in zip(axes, data.items(), strict=True):
        for axis, method in zip(row, methods, strict=True):
            cells = columns[method]
            radii = sorted({r for r, _ in cells})
            amounts = list(dict.fromkeys(a for _, a in cells))
            values = np.array([[cells[r, a] for r in radii] for a in amounts])
            axis.imshow(
                np.maximum(values, least), origin="lower", aspect="auto", cmap="magma", norm=norm
            )
            axis.set_xticks(range(len(radii)), [f"{r:g}" for r in radii], fontsize=6)
            axis.set_yticks(range(len(amounts)), [f"{a:g}" for a in amounts], fontsize=6)
        row[0].set_ylabel(f"{shape}\n{LABELS[damage]}", fontsize=6)
    for axis, method in zip(axes[0], methods, strict=True):
        axis.set_title(method, fontsize=8)
    for axis in axes[-1]:
        axis.set_xlabel("radius", fontsize=6)
    figure.tight_layout(rect=(0, 0, 0.93, 1))
    bar = figure.colorbar(
        ScalarMappable(norm, "magma"), cax=figure.add_axes((0.94, 0.25, 0.012, 0.5))
    )
    bar.ax.tick_params(labelsize=6)
    figure.savefig(out, dpi=90)


def table(data: dict[tuple[str, str], dict[str, Cells]]) -> None:
    """The mean over radii."""
    methods = list(next(iter(data.values())))
    print(f"| shape | damage | {' | '.join(methods)} |\n|---|---|{'---|' * len(methods)}")
    for (shape, damage), columns in data.items():
        amounts = list(dict.fromkeys(a for _, a in columns[methods[0]]))
        for amount in amounts:
            row = [
                float(np.mean([e for (_, a), e in columns[m].items() if a == amount]))
                for m in methods
            ]
            print(f"| {shape} | {damage} {amount:g} | {' | '.join(f'{e:.3f}' for e in row)} |")


def main() -> None:
    """Reads, draws, prints."""
    if len(sys.argv) != 3:
        raise SystemExit(__doc__)
    data = read(Path(sys.argv[1]))
    draw(data, Path(sys.argv[2]))
    table(data)


if __name__ == "__main__":
    main()
