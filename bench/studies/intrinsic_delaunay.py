"""What intrinsic Delaunay refinement does for distances on bad triangulations.

usage: intrinsic_delaunay.py PROGRAM PAGE.md MESH...    needs numpy

Distance from one vertex against exact polyhedral distance, without and with --intrinsic-delaunay:
mean / largest error in per cent of the largest distance. Every mesh is run, those with a smallest
angle below one degree get a row; the table replaces a section of the page.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

METHODS = ("signed-heat", "unsigned-heat")


def read_obj(path: Path) -> tuple[np.ndarray, np.ndarray]:
    rows = [line.split() for line in path.read_text().splitlines()]
    points = np.array([row[1:4] for row in rows if row[:1] == ["v"]], dtype=float)
    faces = [[int(c.split("/")[0]) - 1 for c in row[1:]] for row in rows if row[:1] == ["f"]]
    return points, np.array(faces)


def smallest_angle(points: np.ndarray, faces: np.ndarray) -> float:
    smallest = 180.0
    for k in range(3):
        a, b, c = (points[faces[:, (k + i) % 3]] for i in range(3))
        u, v = b - a, c - a
        angle = np.arctan2(np.linalg.norm(np.cross(u, v), axis=1), (u * v).sum(1))
        smallest = min(smallest, float(np.degrees(angle.min())))
    return smallest


def distance(program: str, mesh: Path, source: int, *options: str) -> tuple[np.ndarray, dict]:
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "out.txt"
        command = [program, "distance", str(mesh), "--vertex", str(source), "-o", str(out)]
        command += ["--json", "--quiet", *options]
        run = subprocess.run(command, check=True, capture_output=True, text=True)
        return np.loadtxt(out), json.loads(run.stdout)


def row(program: str, path: Path, folder: Path) -> str:
    """A line of the table; empty if the triangles are not bad."""
    mesh = folder / "mesh.obj"
    convert = [program, "convert", str(path), "--triangulate", "-o", str(mesh), "--quiet"]
    subprocess.run(convert, check=True)
    points, faces = read_obj(mesh)
    source = int(np.unique(faces)[len(np.unique(faces)) // 3])
    exact, _ = distance(program, mesh, source, "--method", "exact")
    cells: list[str] = []
    sizes: dict = {}
    seconds = 0.0
    for method in METHODS:
        for more in ([], ["--intrinsic-delaunay"]):
            phi, report = distance(program, mesh, source, "--method", method, *more)
            sizes = report["sizes"]
            seconds = report["timings"].get("retriangulation", 0.0)
            ok = np.isfinite(phi) & np.isfinite(exact)
            error = 100 * abs(phi - exact)[ok] / exact[ok].max()
            cells.append(f"{error.mean():.2f} / {error.max():.1f}")
    counts = [sizes[f"intrinsic_{n}"] for n in ("flips", "vertices_added", "edges_not_delaunay")]
    angle = smallest_angle(points, faces)
    numbers = [f"{n:.0f}" for n in counts]
    print(path.name, len(faces), f"{angle:.3g}", *numbers, f"{seconds:.2f} s", *cells, flush=True)
    if angle >= 1:
        return ""
    return f"| {path.stem} | {len(faces)} | {angle:.2g}° | " + " | ".join([*numbers, *cells]) + " |"


def main(program: str, page: str, meshes: list[Path]) -> None:
    heads = ["mesh", "faces", "smallest angle", "flips", "added", "not Delaunay"]
    heads += [f"{m}{s}" for m in METHODS for s in ("", ", refined")]
    lines = ["| " + " | ".join(heads) + " |", "|---" * len(heads) + "|"]
    refused = []
    for path in meshes:
        with tempfile.TemporaryDirectory() as folder:
            try:
                line = row(program, path, Path(folder))
            except subprocess.CalledProcessError as error:
                refused.append(f"{path.name} ({error.stderr.strip().splitlines()[-1]})")
                print(refused[-1], flush=True)
                continue
            if line:
                lines.append(line)
    text = "\n".join(lines) + f"\n\n{len(meshes) - len(refused)} meshes were run"
    text += f"; refused: {', '.join(refused)}.\n" if refused else ".\n"
    begin, end = "<!-- bad triangulations -->\n", "<!-- end of bad triangulations -->\n"
    head, rest = Path(page).read_text().split(begin)
    Path(page).write_text(head + begin + text + end + rest.split(end)[1])


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2], [Path(p) for p in sys.argv[3:]])
