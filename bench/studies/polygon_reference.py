"""Which of two answers on a polygon mesh is nearer to what both discretize?

usage: polygon_reference.py PROGRAM REFERENCE_FOLDER [SUBDIVISIONS]    needs numpy

The polygons are cut into triangles and subdivided, which keeps the surface; signed heat there, with
the diffusion time of the polygon mesh, is the yardstick for both answers at the original vertices.
The signs of the two conventions differ. Prints rows of Markdown.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]


def read_obj(path: Path) -> tuple[Floats, list[list[int]]]:
    rows = [line.split() for line in path.read_text().splitlines()]
    points = np.array([row[1:4] for row in rows if row[:1] == ["v"]], dtype=float)
    faces = [[int(c.split("/")[0]) - 1 for c in row[1:]] for row in rows if row[:1] == ["f"]]
    return points, faces


def edges(faces: list[list[int]]) -> Ints:
    sides = [(f[k], f[(k + 1) % len(f)]) for f in faces for k in range(len(f))]
    ends: Ints = np.unique(np.sort(np.array(sides), axis=1), axis=0)
    return ends


def mean_length(points: Floats, faces: list[list[int]]) -> float:
    e = edges(faces)
    return float(np.linalg.norm(points[e[:, 0]] - points[e[:, 1]], axis=1).mean())


def subdivide(points: Floats, faces: list[list[int]]) -> tuple[Floats, list[list[int]]]:
    e = edges(faces)
    middle = {(int(a), int(b)): len(points) + i for i, (a, b) in enumerate(e)}
    out = []
    for a, b, c in faces:
        ab, bc, ca = (middle[min(i, j), max(i, j)] for i, j in ((a, b), (b, c), (c, a)))
        out += [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
    return np.vstack([points, 0.5 * (points[e[:, 0]] + points[e[:, 1]])]), out


def distance(program: str, mesh: Path, sources: Path, *options: str) -> Floats:
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "out.txt"
        command = [program, "distance", str(mesh), "--sources", str(sources), "-o", str(out)]
        command += ["--method", "signed-heat"]
        subprocess.run([*command, "--quiet", *options], check=True)
        return np.loadtxt(out)


def main(program: str, reference: Path, levels: int) -> None:
    points, polygons = read_obj(reference / "mesh.obj")
    n = len(points)
    h = mean_length(points, polygons)
    names = {"none": "dist_none.txt", "zero-set": "dist_zero.txt"}
    theirs = {c: np.loadtxt(reference / f) for c, f in names.items()}
    with tempfile.TemporaryDirectory() as folder:
        fine, cut = Path(folder) / "fine.obj", Path(folder) / "cut.obj"
        convert = [program, "convert", str(reference / "mesh.obj"), "--triangulate"]
        subprocess.run([*convert, "-o", str(cut), "--quiet"], check=True)
        source = reference / "input_source.txt"
        given = reference / "mesh.obj"
        ours = {c: distance(program, given, source, "--constraint", c) for c in names}
        x, faces = read_obj(cut)
        print("| constraint | faces of the yardstick | ours, mean / largest | theirs |")
        print("|---|---|---|---|")
        for _ in range(levels):
            x, faces = subdivide(x, faces)
            lines = [f"v {a!r} {b!r} {c!r}" for a, b, c in x.tolist()]
            lines += [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in faces]
            fine.write_text("\n".join(lines) + "\n")
            scale = (h / (0.5 * mean_length(x, faces))) ** 2
            for c in names:
                more = ("--constraint", c, "--time-scale", repr(scale))
                truth = distance(program, fine, source, *more)[:n]
                size = np.ptp(truth)
                a, b = abs(ours[c] - truth) / size, abs(-theirs[c] - truth) / size
                cells = [f"{100 * d.mean():.2f} / {100 * d.max():.2f}" for d in (a, b)]
                print(f"| {c} | {len(faces):,} | {cells[0]} | {cells[1]} |", flush=True)


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]), int(sys.argv[3]) if len(sys.argv) > 3 else 3)
