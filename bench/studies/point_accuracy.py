"""Errors of distances from points against exact polyhedral distance; prints a Markdown table.

usage: point_accuracy.py PROGRAM MESH.obj...    needs numpy and pygeodesic (PyPI)

Each entry is mean / largest error in mean edge lengths. Sources are drawn at random (seed 5): one
vertex, that vertex and one four edge lengths away, ten vertices, a hundred.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import pygeodesic.geodesic as geodesic

COLUMNS = {
    "unsigned": ["--method", "unsigned-heat"],
    "signed, 4": ["--method", "signed-heat", "--time-scale", "4"],
    "signed, 16": ["--method", "signed-heat", "--time-scale", "16"],
    "signed, 64": ["--method", "signed-heat", "--time-scale", "64"],
    "signed, 16, radial": [
        "--method",
        "signed-heat",
        "--time-scale",
        "16",
        "--point-sources",
        "radial",
    ],
}


def read_obj(path: Path) -> tuple[np.ndarray, np.ndarray]:
    rows = [line.split() for line in path.read_text().splitlines()]
    points = [[float(x) for x in r[1:4]] for r in rows if r[:1] == ["v"]]
    faces = [[int(x.split("/")[0]) - 1 for x in r[1:4]] for r in rows if r[:1] == ["f"]]
    return np.array(points), np.array(faces)


def heat(program: str, mesh: Path, sources: list[int], options: list[str]) -> np.ndarray:
    with tempfile.TemporaryDirectory() as folder:
        points, out = Path(folder) / "points.txt", Path(folder) / "out.txt"
        points.write_text("unsigned_point\n" + "".join(f"v {s}\n" for s in sources))
        command = [program, "distance", mesh, "--sources", points, "-o", out, "--quiet", *options]
        subprocess.run(command, check=True)
        return np.loadtxt(out)


def main(program: str, meshes: list[Path]) -> None:
    random = np.random.default_rng(5)
    print("| mesh | faces | points | " + " | ".join(COLUMNS) + " |")
    print("|---" * (3 + len(COLUMNS)) + "|")
    for mesh in meshes:
        points, faces = read_obj(mesh)
        exact = geodesic.PyGeodesicAlgorithmExact(points, faces)
        sides = np.vstack([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
        edges = np.unique(np.sort(sides, axis=1), axis=0)
        h = np.linalg.norm(points[edges[:, 0]] - points[edges[:, 1]], axis=1).mean()
        first = int(random.integers(len(points)))
        beside = int(np.argmin(abs(exact.geodesicDistances(np.array([first]))[0] - 4 * h)))
        sets = [[first], [first, beside]]
        sets += [list(map(int, random.choice(len(points), n, replace=False))) for n in (10, 100)]
        for sources in sets:
            truth = exact.geodesicDistances(np.array(sources))[0]
            cells = []
            for options in COLUMNS.values():
                error = abs(heat(program, mesh, sources, options) - truth) / h
                cells.append(f"{error.mean():.2f} / {error.max():.1f}")
            name = "2, 4 edges apart" if len(sources) == 2 else str(len(sources))
            row = [mesh.stem, str(len(faces)), name, *cells]
            print("| " + " | ".join(row) + " |", flush=True)


if __name__ == "__main__":
    main(sys.argv[1], [Path(p) for p in sys.argv[2:]])
