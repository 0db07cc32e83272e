"""Repair first, then distance, beside littoral (signed heat paper, section 9.5.3, figure 28).

usage: repair_first.py MESH...    needs littoral and scipy; prints Markdown

Nodal lines of five eigenfunctions are damaged as in broken_curves.cpp. The pipeline completes the
curves by surface winding numbers, measures exactly to where their rounded value passes from at most
k to more, and signs by it; k is the step with the longest line, as the paper takes the most
frequent one. Each entry: mean error in % of the range / % of the area on the wrong side.
"""

import sys
import time
from pathlib import Path

import numpy as np
from nodal import Floats, Lines, damaged, mean_error, nodal_lines, wrong_side

import littoral

DAMAGES = {
    "25 % missing": (0.25, 0.0, 0.0),
    "50 % missing": (0.5, 0.0, 0.0),
    "20 % reversed": (0.0, 0.2, 0.0),
    "curve and its offset, 50 % missing": (0.5, 0.0, 3.0),
}


def by_winding(mesh: littoral.Surface, lines: Lines) -> Floats:
    """Winding numbers, then exact distance to their most frequent step."""
    regions = littoral.winding(mesh, lines)
    cut, functions = regions.surface
    label = functions["region"][cut.faces[:, 0]]
    points = np.unique(cut.points.round(9), axis=0, return_inverse=True)
    corner = points[1].reshape(-1)[cut.faces]
    steps: dict[tuple[int, int], list[float]] = {}
    for face, value in zip(corner, label, strict=True):
        for a, b in zip(face, np.roll(face, -1), strict=True):
            steps.setdefault((min(a, b), max(a, b)), []).append(float(value))
    lengths: dict[float, float] = {}
    between = [(e, v) for e, v in steps.items() if len(v) == 2 and v[0] != v[1]]
    for (a, b), values in between:
        length = float(np.linalg.norm(points[0][a] - points[0][b]))
        for k in np.arange(min(values), max(values)):
            lengths[k] = lengths.get(k, 0.0) + length
    if not lengths:
        return np.full(mesh.n_vertices, np.nan)
    level = max(lengths, key=lambda k: lengths[k])
    rim = [points[0][[a, b]] for (a, b), v in between if min(v) <= level < max(v)]
    distance = littoral.distance(mesh, rim, signed=False, method="exact").values
    inside = np.zeros(mesh.n_vertices)
    sides = np.where(regions.region > level, 1.0, -1.0)
    area = littoral.operators(mesh).A
    for k in range(3):
        np.add.at(inside, mesh.faces[:, k], sides * area)
    return distance * np.sign(inside)


def main(paths: list[Path]) -> None:
    answers = {
        "auto": lambda mesh, lines: littoral.distance(mesh, lines).values,
        "signed heat": lambda mesh, lines: littoral.distance(
            mesh, lines, method="signed-heat", constraint="none", time_scale=1
        ).values,
        "winding, then exact": by_winding,
    }
    print("| mesh | faces | answer | " + " | ".join(DAMAGES) + " | processor s |")
    print("|---" * (4 + len(DAMAGES)) + "|")
    for path in paths:
        mesh = littoral.read(path)
        mass = littoral.operators(mesh).M
        points = mesh.points[mesh.faces]
        edge = float(np.linalg.norm(points - points[:, [1, 2, 0]], axis=2).mean())
        curves = nodal_lines(mesh, 5)
        truths = [littoral.distance(mesh, lines).values for lines in curves]
        for name, answer in answers.items():
            cells, start = [], time.process_time()
            for drop, reverse, offset in DAMAGES.values():
                errors, wrong = [], []
                for k, (lines, truth) in enumerate(zip(curves, truths, strict=True)):
                    broken = damaged(lines, drop, reverse, k)
                    if offset:
                        copy = littoral.isolines(mesh, truth, offset * edge)
                        broken += damaged(copy, drop, reverse, k + 100)
                    values = answer(mesh, broken)
                    errors.append(mean_error(values, truth, mass))
                    wrong.append(wrong_side(values, truth, mass))
                cells.append(f"{np.mean(errors):.2f} / {np.mean(wrong):.2f}")
            seconds = (time.process_time() - start) / (len(DAMAGES) * len(curves))
            row = [path.stem, str(mesh.n_faces), name, *cells, f"{seconds:.2f}"]
            print("| " + " | ".join(row) + " |", flush=True)


if __name__ == "__main__":
    main([Path(p) for p in sys.argv[1:]])
