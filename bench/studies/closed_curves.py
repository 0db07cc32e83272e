"""Closed curves on surfaces: error and order of the methods (signed heat paper, figures 24, 25).

usage: closed_curves.py LEVELS MESH...    needs littoral, scipy and trimesh; prints Markdown

Meshes are Loop-subdivided. On each level the nodal lines of three eigenfunctions are the sources.
The truth is the exact polyhedral distance to the same segments. Errors are means over the area in %
of the largest distance; seconds are processor time of one thread, from mesh and curves to the
answer. The order is log2 of the ratio between levels, over mean edge lengths.
"""

import sys
import time
from pathlib import Path

import numpy as np
import trimesh
from nodal import mean_error, nodal_lines

import littoral

METHODS = {
    "signed heat": {"method": "signed-heat", "constraint": "zero-set"},
    "unsigned heat": {"method": "unsigned-heat"},
    "fast marching": {"method": "fast-marching"},
    "Belyaev-Fayolle": {"method": "belyaev-fayolle"},
}


def main(levels: int, paths: list[Path]) -> None:
    print("| mesh | faces | edge | " + " | ".join(f"{name}: %, s" for name in METHODS) + " |")
    print("|---" * (3 + len(METHODS)) + "|")
    orders: dict[str, list[float]] = {name: [] for name in METHODS}
    for path in paths:
        mesh = littoral.read(path)
        V, F = np.array(mesh.points), np.array(mesh.faces)
        before: dict[str, tuple[float, float]] = {}
        for level in range(levels):
            if level:
                V, F = trimesh.remesh.subdivide_loop(V, F, iterations=1)
            mesh = littoral.Mesh(V, F)
            mass = littoral.operators(mesh).M
            edge = float(np.linalg.norm(V[F] - V[F[:, [1, 2, 0]]], axis=2).mean())
            sources = nodal_lines(mesh, 3)
            truth = [littoral.distance(mesh, s, method="exact").values for s in sources]
            cells = []
            for name, options in METHODS.items():
                errors, seconds = [], []
                for lines, exact in zip(sources, truth, strict=True):
                    start = time.process_time()
                    field = littoral.distance(mesh, lines, threads=1, **options)
                    seconds.append(time.process_time() - start)
                    errors.append(mean_error(abs(field.values), exact, mass))
                error = float(np.mean(errors))
                cells.append(f"{error:.2f}, {np.mean(seconds):.2f}")
                if name in before:
                    e, h = before[name]
                    orders[name].append(np.log(e / error) / np.log(h / edge))
                before[name] = error, edge
            print(
                "| " + " | ".join([path.stem, str(len(F)), f"{edge:.3g}", *cells]) + " |",
                flush=True,
            )
    medians = [f"{np.median(o):.2f}" for o in orders.values()]
    print("| median order | | | " + " | ".join(medians) + " |")


if __name__ == "__main__":
    main(int(sys.argv[1]), [Path(p) for p in sys.argv[2:]])
