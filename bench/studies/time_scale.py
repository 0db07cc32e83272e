"""Turns what littoral_time_scale measured into a table and a plot.

usage: time_scale.py MEASURED.csv PLOT.png    prints Markdown; needs matplotlib (PyPI)
"""

import csv
import statistics
import sys
from collections import defaultdict
from pathlib import Path

import matplotlib as mpl

mpl.use("Agg")
import matplotlib.pyplot as plt

Errors = dict[float, list[float]]


def main(measured: Path, picture: str) -> None:
    mean: dict[str, Errors] = defaultdict(lambda: defaultdict(list))
    largest: dict[str, Errors] = defaultdict(lambda: defaultdict(list))
    meshes = set()
    with measured.open() as file:
        for row in csv.DictReader(file):
            meshes.add(row["mesh"])
            scale = float(row["scale"])
            mean[row["source"]][scale].append(float(row["mean"]))
            largest[row["source"]][scale].append(float(row["largest"]))
    scales = sorted(next(iter(mean.values())))
    print(f"{len(meshes)} meshes: {', '.join(sorted(meshes))}.\n")
    print("| source | cases | " + " | ".join(f"{s:g}" for s in scales) + " |")
    print("|---" * (len(scales) + 2) + "|")
    for kind, errors in mean.items():
        best = [min(scales, key=lambda s, k=k, e=errors: e[s][k]) for k in range(len(errors[1]))]
        cells = [
            f"{statistics.median(errors[s]):.2f} / {statistics.median(largest[kind][s]):.1f} "
            f"({best.count(s)})"
            for s in scales
        ]
        print(f"| {kind} | {len(best)} | " + " | ".join(cells) + " |")

    fig, axes = plt.subplots(1, len(mean), figsize=(11, 3), sharey=True)
    for ax, (kind, errors) in zip(axes, mean.items(), strict=True):
        for k in range(len(errors[1])):
            ax.loglog(scales, [errors[s][k] for s in scales], color="0.8", linewidth=0.7)
        ax.loglog(scales, [statistics.median(errors[s]) for s in scales], "-o", color="C0")
        ax.set_title(kind, fontsize=9)
        ax.set_xlabel("time scale")
        ax.grid(alpha=0.3)
    axes[0].set_ylabel("mean error, % of the largest distance")
    fig.tight_layout()
    fig.savefig(picture, dpi=90)


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2])
