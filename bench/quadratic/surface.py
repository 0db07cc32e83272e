"""Triangle meshes as arrays, and the littoral program as a function, for the quadratic studies."""

import json
import os
import resource
import subprocess
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import meshio
import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import connected_components

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

PROGRAM = os.environ.get("LITTORAL", "build/release/littoral")


def read_obj(path: Path) -> tuple[Floats, Ints]:
    """Vertices and triangles of an OBJ without other faces."""
    points, faces = [], []
    for line in path.read_text().splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            points.append([float(x) for x in words[1:4]])
        elif words[:1] == ["f"]:
            faces.append([int(w.split("/")[0]) - 1 for w in words[1:]])
    return np.array(points), np.array(faces, dtype=np.int64)


def write_obj(path: Path, points: Floats, faces: Ints) -> None:
    """Writes a mesh with all digits."""
    with path.open("w") as out:
        for x, y, z in points:
            out.write(f"v {x:.17g} {y:.17g} {z:.17g}\n")
        for a, b, c in faces + 1:
            out.write(f"f {a} {b} {c}\n")


def load(path: Path) -> tuple[Floats, Ints]:
    """Any mesh the program reads, without unused vertices, its bounding box diagonal made 1."""
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder) / "mesh.obj"
        subprocess.run(
            [PROGRAM, "convert", str(path), "--triangulate", "-o", str(copy), "--quiet"], check=True
        )
        points, faces = read_obj(copy)
    faces = faces[(faces != np.roll(faces, 1, axis=1)).all(1)]  # repeated vertices are no triangles
    used = np.unique(faces)
    number = np.full(len(points), -1)
    number[used] = np.arange(len(used))
    points, faces = points[used], number[faces]
    size = float(np.linalg.norm(points.max(0) - points.min(0)))
    return (points - points.min(0)) / size, faces


class Subdivision:
    """Every triangle in four; linear interpolation from the coarse mesh to the fine one."""

    def __init__(self, points: Floats, faces: Ints) -> None:
        sides = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), 1)
        self.edges, where = np.unique(sides, axis=0, return_inverse=True)
        a, b, c = (len(points) + where.reshape(3, -1)).astype(np.int64)
        i, j, k = faces.T
        self.points = self.refine(points)
        self.faces = np.concatenate(
            [np.stack(t, 1) for t in ((i, a, c), (a, j, b), (c, b, k), (a, b, c))]
        )

    def refine(self, values: Floats) -> Floats:
        """Values at the fine vertices: the coarse ones, then edge midpoints."""
        return np.concatenate([values, values[self.edges].mean(1)])


def mass(points: Floats, faces: Ints, error: Floats) -> tuple[float, float]:
    """error^T M1 error and the area, M1 the mass matrix of linear functions."""
    p, q, r = (points[faces[:, k]] for k in range(3))
    area = 0.5 * np.linalg.norm(np.cross(q - p, r - p), axis=1)
    e = error[faces]
    product = (e**2).sum(1) + e[:, 0] * e[:, 1] + e[:, 1] * e[:, 2] + e[:, 2] * e[:, 0]
    return float((area * product / 6).sum()), float(area.sum())


def errors(points: Floats, faces: Ints, error: Floats) -> tuple[float, float]:
    """Root mean square over the surface, as in the paper's section 6.2, and the largest."""
    squared, area = mass(points, faces, error)
    return float(np.sqrt(squared / area)), float(np.abs(error).max())


def mean_edge(points: Floats, faces: Ints) -> float:
    """Mean edge length."""
    edges = Subdivision(points, faces).edges
    return float(np.linalg.norm(points[edges[:, 0]] - points[edges[:, 1]], axis=1).mean())


def part_of(faces: Ints, vertex: int) -> NDArray[np.bool_]:
    """Vertices connected with one of them."""
    n = int(faces.max()) + 1
    sides = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]]])
    graph = csr_matrix((np.ones(len(sides)), (sides[:, 0], sides[:, 1])), (n, n))
    label = connected_components(graph, directed=False)[1]
    return np.asarray(label == label[vertex])


def corner_angles(points: Floats, faces: Ints) -> Floats:
    """Angles of the triangles, in degrees."""  # faces x 3
    sides = [points[faces[:, (k + 1) % 3]] - points[faces[:, k]] for k in range(3)]
    corners = []
    for k in range(3):
        area = np.linalg.norm(np.cross(sides[k], sides[k - 1]), axis=1)
        corners.append(np.degrees(np.arctan2(area, -(sides[k] * sides[k - 1]).sum(1))))
    return np.stack(corners, 1)


class Kind:
    """What a mesh is like: `angles` the smallest one and the first percentile of the triangles'
    smallest ones in degrees, `words` on its topology, `manifold` or not."""

    def __init__(self, points: Floats, faces: Ints) -> None:
        with tempfile.TemporaryDirectory() as folder:
            mesh = Path(folder) / "mesh.obj"
            write_obj(mesh, points, faces)
            command = [PROGRAM, "info", "--json", str(mesh)]
            done = subprocess.run(command, check=True, capture_output=True, text=True)
        info = json.loads(done.stdout)
        least = corner_angles(points, faces).min(1)
        self.angles = f"{least.min():.2g}, {np.percentile(least, 1):.2g}"
        self.manifold = info["nonmanifold_edges"] + info["nonmanifold_vertices"] == 0
        words = [f"{info['components']} parts"] if info["components"] > 1 else []
        if info["boundary_edges"]:
            words.append("open")
        if not self.manifold:
            words.append("nonmanifold")
        if not info["orientable"]:
            words.append("not orientable")
        genus = info["components"] - info["euler_characteristic"] / 2
        if self.manifold and info["orientable"] and not info["boundary_edges"] and genus > 0:
            words.append(f"genus {genus:g}")
        self.words = ", ".join(words)


def limited(seconds: int) -> Callable[[], None]:
    """For subprocesses: ends them after so many processor seconds."""
    return lambda: resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds))


def timed(arguments: Sequence[str], limit: int = 3600) -> tuple[dict[str, Any], float]:
    """Report and processor seconds of one call of the program, which may take `limit` of them."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(
        [PROGRAM, *arguments, "--json", "--quiet"],
        check=True,
        capture_output=True,
        text=True,
        preexec_fn=limited(limit),
    )
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return json.loads(done.stdout), seconds


def subdivided(points: Floats, faces: Ints, levels: int) -> tuple[Floats, Ints]:
    """Every triangle in four, some times."""
    for _ in range(levels):
        s = Subdivision(points, faces)
        points, faces = s.points, s.faces
    return points, faces


class Run:
    """One call of `littoral distance`: values, report and processor seconds; with `--subdivide`
    also the mesh the values belong to."""

    def __init__(
        self,
        points: Floats,
        faces: Ints,
        source: int | tuple[int, Floats],  # a vertex, or a face and barycentrics
        method: str,
        extra: Sequence[str] = (),
        limit: int = 3600,  # processor seconds
    ) -> None:
        with tempfile.TemporaryDirectory() as folder:
            mesh, out = Path(folder) / "mesh.obj", Path(folder) / "out.ply"
            write_obj(mesh, points, faces)
            if isinstance(source, int):
                where = ["--vertex", str(source)]
            else:
                a, b, c = source[1]
                text = f"unsigned_point\nf {source[0]} {a:.17g} {b:.17g} {c:.17g}\n"
                (Path(folder) / "source.txt").write_text(text)
                where = ["--sources", str(Path(folder) / "source.txt")]
            command = ["distance", str(mesh), *where, "--method", method, "-o", str(out), *extra]
            self.report, self.seconds = timed(command, limit)
            fine = meshio.read(out)
        self.points, self.faces = np.asarray(fine.points), fine.cells_dict["triangle"]
        self.values: Floats = fine.point_data["distance"].astype(np.float64)
