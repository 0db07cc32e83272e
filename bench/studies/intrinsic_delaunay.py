"""What intrinsic Delaunay refinement does for point distances; prints a Markdown table.

usage: intrinsic_delaunay.py PROGRAM MESH...    needs numpy and pygeodesic (PyPI)

Mean / largest error against exact polyhedral distance from one vertex, in per cent of the largest
distance, without and with --intrinsic-delaunay.
"""

import re
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import pygeodesic.geodesic as geodesic
from point_accuracy import read_obj

METHODS = ("signed-heat", "unsigned-heat")


def smallest_angle(points: np.ndarray, faces: np.ndarray) -> float:
    smallest = 180.0
    for k in range(3):
        a, b, c = (points[faces[:, (k + i) % 3]] for i in range(3))
        u, v = b - a, c - a
        angle = np.arctan2(np.linalg.norm(np.cross(u, v), axis=1), (u * v).sum(1))
        smallest = min(smallest, float(np.degrees(angle.min())))
    return smallest


def heat(program: str, mesh: Path, source: int, options: list[str]) -> tuple[np.ndarray, str]:
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "out.txt"
        command = [program, "distance", str(mesh), "--vertex", str(source), "-o", str(out)]
        command += ["--verbose", "--quiet", *options]
        run = subprocess.run(command, check=True, capture_output=True, text=True)
        return np.loadtxt(out), run.stderr


def main(program: str, meshes: list[Path]) -> None:
    heads = [f"{m}{s}" for m in METHODS for s in ("", ", refined")]
    print("| mesh | faces | smallest angle | flips | added | " + " | ".join(heads) + " |")
    print("|---" * (5 + len(heads)) + "|")
    for path in meshes:
        with tempfile.TemporaryDirectory() as folder:
            mesh = Path(folder) / "mesh.obj"
            convert = [program, "convert", str(path), "-o", str(mesh), "--quiet"]
            subprocess.run(convert, check=True)
            points, faces = read_obj(mesh)
            source = int(np.unique(faces)[len(np.unique(faces)) // 3])
            exact = geodesic.PyGeodesicAlgorithmExact(points, faces)
            truth = exact.geodesicDistances(np.array([source]))[0]
            cells, report = [], ""
            for method in METHODS:
                for more in ([], ["--intrinsic-delaunay"]):
                    phi, report = heat(program, mesh, source, ["--method", method, *more])
                    ok = np.isfinite(phi) & (truth < 1e9)
                    error = 100 * abs(phi - truth)[ok] / truth[ok].max()
                    cells.append(f"{error.mean():.2f} / {error.max():.1f}")
        counts = [
            re.search(rf"intrinsic_{name}: (\d+)", report) for name in ("flips", "vertices_added")
        ]
        numbers = [found[1] if found else "" for found in counts]
        angle = f"{smallest_angle(points, faces):.3f}°"
        row = [path.stem, str(len(faces)), angle, *numbers, *cells]
        print("| " + " | ".join(row) + " |", flush=True)


if __name__ == "__main__":
    main(sys.argv[1], [Path(p) for p in sys.argv[2:]])
