"""What is answered without options, on many meshes: distance from one vertex.

The truth is exact polyhedral distance by pygeodesic, another program, where that takes the mesh.
Beside ours stands what potpourri3d's MeshHeatMethodDistanceSolver answers by default.

usage: defaults.py PROGRAM MESH...    prints a Markdown table: mean / largest error in % of the
largest distance, seconds of the whole program beside those of potpourri3d's constructor and solve
"""

import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import potpourri3d
import pygeodesic.geodesic as geodesic


def triangles(program: str, mesh: Path, folder: Path) -> tuple[np.ndarray, np.ndarray]:
    """The mesh as the program reads it, cut into triangles."""
    out = folder / "mesh.obj"
    subprocess.run(
        [program, "convert", mesh, "--triangulate", "-o", out], check=True, capture_output=True
    )
    points, faces = [], []
    for line in out.read_text().splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            points.append([float(x) for x in words[1:4]])
        if words[:1] == ["f"]:
            faces.append([int(x.split("/")[0]) - 1 for x in words[1:4]])
    return np.array(points), np.array(faces)


def errors(answer: np.ndarray, truth: np.ndarray) -> str:
    """Mean and largest error where the truth is finite, in % of its largest value."""
    known = np.isfinite(truth) & (truth < 1e100)
    difference = np.abs(answer[known] - truth[known])
    if not np.isfinite(difference).all():
        return "not finite"
    share = 100 * difference / truth[known].max()
    return f"{share.mean():.3f} / {share.max():.2f}"


def row(program: str, mesh: Path, folder: Path) -> str:
    """One mesh."""
    points, faces = triangles(program, mesh, folder)
    vertex = int(faces[0, 0])
    start = time.perf_counter()
    ran = subprocess.run(
        [program, "distance", folder / "mesh.obj", "--vertex", str(vertex), "-o", folder / "d.npy"],
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    ours_seconds = time.perf_counter() - start
    if ran.returncode != 0:
        return f"| {mesh.name} | {len(faces)} | {ran.stderr.strip()} | | | |"
    ours = np.load(folder / "d.npy")
    truth, _ = geodesic.PyGeodesicAlgorithmExact(points, faces).geodesicDistances(
        np.array([vertex]), None
    )
    start = time.perf_counter()
    try:
        theirs = errors(
            potpourri3d.MeshHeatMethodDistanceSolver(points, faces).compute_distance(vertex), truth
        )
    except RuntimeError as error:
        theirs = str(error).splitlines()[0][:40]
    theirs_seconds = time.perf_counter() - start
    return (
        f"| {mesh.name} | {len(faces)} | {errors(ours, truth)} | {ours_seconds:.2f} | {theirs} "
        f"| {theirs_seconds:.2f} |"
    )


def main() -> None:
    """Prints the table."""
    program = str(Path(sys.argv[1]).resolve())
    print("| mesh | triangles | littoral | s | potpourri3d | s |\n|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for mesh in sys.argv[2:]:
            print(row(program, Path(mesh).resolve(), Path(folder)), flush=True)


if __name__ == "__main__":
    main()
