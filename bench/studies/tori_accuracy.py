"""Distance from clouds in the protocol of the thesis (section 5.3); prints a Markdown table.

usage: tori_accuracy.py PROGRAM MESH... [--points 512 2048] [--methods NAME...] [--csv FILE]
       tori_accuracy.py --plot FILE.csv OUT.png    needs matplotlib
needs numpy; screened Poisson needs open3d (PyPI) and is left out without it

Shapes fill [-0.9, 0.9]^3. Clouds are drawn evenly by area (seed 5) with exact normals; the error is
the mean absolute one on 64^3 nodes over [-1, 1]^3, times 1000. Meshes must be closed. --outliers
adds that share of points anywhere in [-1, 1]^3, with normals anyhow.
"""

import argparse
import csv
import subprocess
import tempfile
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

import numpy as np

NODES = 64
METHODS = {
    "tori": ["--method", "tori"],
    "tori, learned": ["--method", "tori", "--fit", "learned"],
    "tori, outliers dropped": ["--method", "tori", "--drop-outliers"],
    "winding, nearest point": ["--method", "winding"],
    "Poisson, open3d": [],
    "planar": ["--method", "planar"],
    "hopf-cole": ["--method", "hopf-cole"],
    "signed-heat": ["--method", "signed-heat"],
}

Array = np.ndarray
Mesh = tuple[Array, Array]
Distance = Callable[[Array], Array]


def grid() -> Array:
    a = np.linspace(-1, 1, NODES)
    return np.stack(np.meshgrid(a, a, a, indexing="ij"), -1).reshape(-1, 3)


def box(x: Array, half: Array) -> Array:
    d = np.abs(x) - half
    return np.linalg.norm(np.maximum(d, 0), axis=-1) + np.minimum(d.max(-1), 0)


def in_plane(x: Array) -> Array:
    return np.linalg.norm(x[:, :2], axis=1)


ANALYTIC: dict[str, Distance] = {
    "sphere": lambda x: np.linalg.norm(x, axis=1) - 0.7,
    "torus": lambda x: np.hypot(in_plane(x) - 0.6, x[:, 2]) - 0.25,
    "box": lambda x: box(x, np.array([0.8, 0.6, 0.4])),
    "cylinder": lambda x: box(np.stack([in_plane(x), x[:, 2]], 1), np.array([0.5, 0.7])),
    "plate": lambda x: box(x, np.array([0.8, 0.7, 0.05])),
}


def analytic_cloud(name: str, n: int, r: np.random.Generator) -> Mesh:
    """Points near the surface, brought onto it along the gradient: evenly by area but for edges."""
    f, h = ANALYTIC[name], 1e-6
    gradient = lambda x: np.stack(  # noqa: E731
        [(f(x + h * e) - f(x - h * e)) / (2 * h) for e in np.eye(3)], 1
    )
    x = r.uniform(-1, 1, (400 * n, 3))
    x = x[np.abs(f(x)) < 0.01]
    x = x - f(x)[:, None] * gradient(x)
    normals = gradient(x)
    good = np.abs(np.linalg.norm(normals, axis=1) - 1) < 1e-3
    rows = r.permutation(np.flatnonzero(good))[:n]
    return x[rows], normals[rows]


def read_mesh(path: Path) -> Mesh:
    """Triangles of an .obj or .off, moved and scaled into the cube."""
    rows = [line.split() for line in path.read_text().splitlines() if line.strip()]
    rows = [r for r in rows if not r[0].startswith("#")]
    if path.suffix == ".off":
        n, m = (int(x) for x in (rows[1] if rows[0] == ["OFF"] else rows[0][1:])[:2])
        rows = rows[2 if rows[0] == ["OFF"] else 1 :]
        points = np.array([[float(x) for x in r[:3]] for r in rows[:n]])
        polygons = [[int(x) for x in r[1 : 1 + int(r[0])]] for r in rows[n : n + m]]
    else:
        points = np.array([[float(x) for x in r[1:4]] for r in rows if r[0] == "v"])
        polygons = [[int(x.split("/")[0]) - 1 for x in r[1:]] for r in rows if r[0] == "f"]
    faces = np.array([[p[0], a, b] for p in polygons for a, b in pairwise(p[1:])])
    low, high = points.min(0), points.max(0)
    return (points - (low + high) / 2) * 1.8 / (high - low).max(), faces


def mesh_cloud(mesh: Mesh, n: int, r: np.random.Generator) -> Mesh:
    a, b, c = (mesh[0][mesh[1][:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    areas = np.linalg.norm(normals, axis=1)
    f = r.choice(len(areas), n, p=areas / areas.sum())
    u, v = np.sqrt(r.random(n))[:, None], r.random(n)[:, None]
    return (1 - u) * a[f] + u * (1 - v) * b[f] + u * v * c[f], normals[f] / areas[f, None]


def with_outliers(cloud: Mesh, share: float, r: np.random.Generator) -> Mesh:
    extra = int(share * len(cloud[0]))
    normals = r.normal(size=(extra, 3))
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    points = np.vstack([cloud[0], r.uniform(-1, 1, (extra, 3))])
    return points, np.vstack([cloud[1], normals])


def write_obj(path: Path, mesh: Mesh) -> None:
    lines = ["v {} {} {}".format(*p) for p in mesh[0]]
    lines += ["f {} {} {}".format(*(f + 1)) for f in mesh[1]]
    path.write_text("\n".join(lines) + "\n")


def sdf(program: str, source: Path, options: list[str]) -> Array:
    """Values on the grid, x slowest."""
    out = source.with_suffix(".npy")
    words = [program, "sdf", source, "--bounds=-1,-1,-1,1,1,1", "--resolution", str(NODES)]
    subprocess.run([*words, *options, "-o", out, "--quiet"], check=True)
    values = np.load(out)
    assert values.shape == (NODES, NODES, NODES)
    return values.reshape(-1)


def poisson(cloud: Mesh) -> Mesh | None:
    try:
        import open3d
    except ImportError:
        return None
    points = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(cloud[0]))
    points.normals = open3d.utility.Vector3dVector(cloud[1])
    make = open3d.geometry.TriangleMesh.create_from_point_cloud_poisson
    mesh, _ = make(points, depth=8, n_threads=1)
    return np.asarray(mesh.vertices), np.asarray(mesh.triangles)


def error(program: str, method: str, cloud: Mesh, exact: Array, folder: Path) -> float:
    source, options = folder / "cloud.xyz", METHODS[method]
    if method.startswith("Poisson"):
        mesh = poisson(cloud)
        if mesh is None:
            return float("nan")
        source, options = folder / "poisson.obj", METHODS["winding, nearest point"]
        write_obj(source, mesh)
    else:
        np.savetxt(source, np.hstack(cloud), fmt="%.9g")
    return float(1000 * np.abs(sdf(program, source, options) - exact).mean())


def plot(table: Path, out: Path) -> None:
    import matplotlib.pyplot as plt

    rows = list(csv.DictReader(table.open()))
    shapes = list(dict.fromkeys(r["shape"] for r in rows))
    counts = list(dict.fromkeys(r["points"] for r in rows))
    figure, axes = plt.subplots(1, len(counts), figsize=(11, 4), sharey=True, squeeze=False)
    for axis, count in zip(axes[0], counts, strict=True):
        for method in METHODS:
            found = {
                r["shape"]: float(r["error"])
                for r in rows
                if r["method"] == method and r["points"] == count
            }
            if not found:
                continue
            at = [shapes.index(s) for s in found]
            axis.plot(at, list(found.values()), "o-", label=method, markersize=4, linewidth=1)
        axis.set_yscale("log")
        axis.set_xticks(range(len(shapes)), shapes, rotation=40, ha="right")
        axis.set_title(f"{count} points")
        axis.grid(alpha=0.3)
    axes[0][0].set_ylabel("mean absolute error, thousandths")
    axes[0][-1].legend(fontsize=7, loc="lower right")
    figure.tight_layout()
    figure.savefig(out, dpi=80)


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("program", nargs="?")
    parser.add_argument("meshes", nargs="*", type=Path)
    parser.add_argument("--points", nargs="+", type=int, default=[512, 2048])
    parser.add_argument("--methods", nargs="+", default=[m for m in METHODS if "dropped" not in m])
    parser.add_argument("--outliers", type=float, default=0)
    parser.add_argument("--csv", type=Path)
    parser.add_argument("--plot", nargs=2, type=Path)
    asked = parser.parse_args()
    if asked.plot:
        return plot(*asked.plot)
    print("| shape | points | " + " | ".join(asked.methods) + " |")
    print("|---" * (2 + len(asked.methods)) + "|", flush=True)
    with tempfile.TemporaryDirectory() as name:
        folder, nodes = Path(name), grid()
        for shape in [*ANALYTIC, *asked.meshes]:
            random = np.random.default_rng(5)
            if isinstance(shape, Path):
                mesh = read_mesh(shape)
                write_obj(folder / "mesh.obj", mesh)
                exact = sdf(asked.program, folder / "mesh.obj", METHODS["winding, nearest point"])
            else:
                exact = ANALYTIC[shape](nodes)
            for n in asked.points:
                mine = isinstance(shape, Path)
                cloud = mesh_cloud(mesh, n, random) if mine else analytic_cloud(shape, n, random)
                cloud = with_outliers(cloud, asked.outliers, random)
                title = shape.stem if isinstance(shape, Path) else shape
                cells = []
                for method in asked.methods:
                    cells.append(error(asked.program, method, cloud, exact, folder))
                    if asked.csv:
                        with asked.csv.open("a") as out:
                            if out.tell() == 0:
                                out.write("shape,points,method,error\n")
                            out.write(f'{title},{n},"{method}",{cells[-1]:.4f}\n')
                shown = " | ".join("-" if np.isnan(c) else f"{c:.2f}" for c in cells)
                print(f"| {title} | {n} | {shown} |", flush=True)
    return None


if __name__ == "__main__":
    main()
