"""Regularized distance in the tables of its paper, on meshes at hand.

usage: study.py sizes MESH[:N]... | errors MESH... | pairs MESH... | symmetry MESH
                | spectrum MESH | reference FOLDER

Prints Markdown. `sizes` is table 1: iterations and seconds, of meshes subdivided N times.
`errors` is table 2: largest error over the largest exact distance, beside heat. `pairs` is table
3: the share of triplets against the triangle inequality, and the asymmetry, for all pairs of
vertices. `symmetry` is figure 11, `spectrum` figure 4 of the supplement. `reference` compares with
the authors' answers in the folder of one of their meshes: difference, objective, longest gradient.
Seconds are processor time of the program.
"""

import argparse
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np

sys.path.append(str(Path(__file__).parent.parent / "quadratic"))
from surface import Floats, Ints, Run, load, subdivided, timed, write_obj


def facts(run: Run) -> tuple[int, float, str]:
    """Iterations, longest gradient over 1, status."""
    report = run.report
    iterations = dict(items(report["iterations"])).get("admm", 0)
    longest = dict(items(report["residuals"])).get("largest gradient over 1", 0)
    return int(iterations), float(longest), report["status"]


def items(entries: dict[str, float] | list[list[str | float]]) -> list[tuple[str, float]]:
    """Names and numbers of a part of the report."""
    if isinstance(entries, dict):
        return list(entries.items())
    return [(str(name), float(value)) for name, value in entries]


def sizes(meshes: list[str]) -> None:
    """Table 1: one source, alpha-hat 0.05, the default tolerance; MESH:N is subdivided N times."""
    print(
        "| mesh | faces | iterations | processor seconds | of these reading and factoring (wall) "
        "| peak memory, MB | longest gradient over 1 |"
    )
    print("|---" * 7 + "|")
    for name in meshes:
        path, _, times = name.partition(":")
        points, faces = subdivided(*load(Path(path)), int(times or 0))
        with tempfile.TemporaryDirectory() as folder:
            mesh = Path(folder) / "mesh.obj"
            write_obj(mesh, points, faces)
            report, seconds = timed(
                ["distance", str(mesh), "--vertex", "0", "--method", "regularized",
                 "-o", str(Path(folder) / "d.npy")]
            )  # fmt: skip
        timings = dict(items(report["timings"]))
        longest = find(dict(items(report["residuals"])), "over 1")
        print(
            f"| {Path(path).stem} | {len(faces)} | {dict(items(report['iterations']))['admm']:.0f} "
            f"| {seconds:.1f} | {timings['read'] + timings['factor']:.1f} "
            f"| {report['peak_memory_mb']:.0f} | {longest:.1e} |",
            flush=True,
        )


COLUMNS: list[tuple[str, str, list[str]]] = [
    ("heat", "unsigned-heat", []),
    ("heat, t = 20 h^2", "unsigned-heat", ["--time-scale", "20"]),
    ("alpha 0 (Belyaev-Fayolle)", "regularized", ["--alpha", "0"]),
    ("alpha 0.02", "regularized", ["--alpha", "0.02"]),
    ("alpha 0.1", "regularized", ["--alpha", "0.1"]),
    ("quadratic", "quadratic", []),
]


def errors(paths: list[Path]) -> None:
    """Table 2."""
    print("| mesh | faces | exact, s | " + " | ".join(name for name, _, _ in COLUMNS) + " |")
    print("|---" * (3 + len(COLUMNS)) + "|")
    for path in paths:
        points, faces = load(path)
        exact = Run(points, faces, 0, "exact")
        truth = exact.values
        cells = []
        for _, method, extra in COLUMNS:
            run = Run(points, faces, 0, method, extra)
            reached = np.isfinite(truth)
            error = np.abs(run.values - truth)[reached].max() / truth[reached].max()
            cells.append(f"{100 * error:.2f} %, {run.seconds:.2f} s")
        print(
            f"| {path.stem} | {len(faces)} | {exact.seconds:.2f} | " + " | ".join(cells) + " |",
            flush=True,
        )


def all_pairs(mesh: Path, extra: list[str]) -> tuple[dict[str, float], float, Floats]:
    """Residuals of the report, processor seconds, matrix."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "d.npy"
        report, seconds = timed(["pairs", str(mesh), "-o", str(out), *extra])
        return dict(items(report["residuals"])), seconds, np.load(out)


def pairs(paths: list[Path]) -> None:
    """Table 3, and seconds as in the supplement's table 1."""
    rows = [("heat, symmetrized", ["--method", "unsigned-heat", "--time-scale", t]) for t in "149"]
    rows += [("one source each, symmetrized", ["--method", "regularized"])]
    rows += [("symmetric", [])]
    print("| mesh | vertices | method | parameter | against the triangle inequality | largest "
          "violation | largest asymmetry | seconds |")  # fmt: skip
    print("|---" * 8 + "|")
    for path in paths:
        points, faces = load(path)
        with tempfile.TemporaryDirectory() as folder:
            mesh = Path(folder) / "mesh.obj"
            write_obj(mesh, points, faces)
            for name, extra in rows:
                alphas = [["--alpha", a] for a in ("0.02", "0.05", "0.15")]
                parameters = [[]] if "heat" in name else alphas
                for parameter in parameters:
                    found, seconds, _ = all_pairs(mesh, [*extra, *parameter])
                    value = parameter[-1] if parameter else extra[-1]
                    share = 100 * find(found, "share")
                    worst = find(found, "largest violation")
                    uneven = find(found, "asymmetry over root of area, largest")
                    print(
                        f"| {path.stem} | {len(points)} | {name} | {value} | {share:.2f} % "
                        f"| {worst:.1e} | {uneven:.1e} | {seconds:.1f} |",
                        flush=True,
                    )


def find(residuals: dict[str, float], part: str) -> float:
    """The value whose name contains that."""
    return next(value for name, value in residuals.items() if part in name)


def symmetry(path: Path) -> None:
    """Figure 11: asymmetry from three vertices, in roots of the area, for heat and two alphas."""
    points, faces = load(path)
    print("| method | vertex | mean | largest |\n|---|---|---|---|")
    p, q, r = (points[faces[:, k]] for k in range(3))
    root = float(np.sqrt(0.5 * np.linalg.norm(np.cross(q - p, r - p), axis=1).sum()))
    with tempfile.TemporaryDirectory() as folder:
        mesh = Path(folder) / "mesh.obj"
        write_obj(mesh, points, faces)
        for name, extra in (
            ("heat", ["--method", "unsigned-heat"]),
            ("alpha 0.02", ["--method", "regularized", "--alpha", "0.02"]),
            ("alpha 0.1", ["--method", "regularized", "--alpha", "0.1"]),
        ):
            _, _, d = all_pairs(mesh, extra)
            for v in (0, len(points) // 3, 2 * len(points) // 3):
                e = np.abs(d[v] - d[:, v]) / root
                print(f"| {name} | {v} | {e.mean():.1e} | {e.max():.1e} |", flush=True)


def eigenfunctions(points: Floats, faces: Ints) -> tuple[Floats, Floats]:
    """Of the cotangent Laplacian, as columns ascending, and the lumped masses."""
    n = len(points)
    L, M = np.zeros((n, n)), np.zeros(n)
    for k in range(3):
        i, j, o = faces[:, k], faces[:, (k + 1) % 3], faces[:, (k + 2) % 3]
        a, b = points[i] - points[o], points[j] - points[o]
        double = np.linalg.norm(np.cross(a, b), axis=1)
        w = 0.5 * (a * b).sum(1) / double
        for r, c, sign in ((i, i, 1), (j, j, 1), (i, j, -1), (j, i, -1)):
            np.add.at(L, (r, c), sign * w)
        np.add.at(M, o, double / 6)
    root = 1 / np.sqrt(M)
    _, vectors = np.linalg.eigh(root[:, None] * L * root[None, :])
    return root[:, None] * vectors, M


def spectrum(path: Path) -> None:
    """What is left of a distance after projection to the first eigenfunctions, relative, mean."""
    points, faces = load(path)
    functions, M = eigenfunctions(points, faces)
    counts = (5, 10, 20, 40, 80)
    print("| method | " + " | ".join(f"{k} functions" for k in counts) + " |")
    print("|---" * (1 + len(counts)) + "|")
    with tempfile.TemporaryDirectory() as folder:
        mesh = Path(folder) / "mesh.obj"
        write_obj(mesh, points, faces)
        for name, extra in (
            ("heat", ["--method", "unsigned-heat"]),
            ("fast marching", ["--method", "fast-marching"]),
            ("exact", ["--method", "exact"]),
            ("alpha 0.05, one source each", ["--method", "regularized"]),
            ("alpha 0.05, symmetric", []),
            ("alpha 0.15, one source each", ["--method", "regularized", "--alpha", "0.15"]),
            ("alpha 0.15, symmetric", ["--alpha", "0.15"]),
        ):
            _, _, d = all_pairs(mesh, extra)
            weights = functions.T @ (M[:, None] * d.T)  # functions x sources
            size = np.sqrt((M[:, None] * d.T**2).sum(0))
            left = [np.sqrt((weights[k:] ** 2).sum(0)) / size for k in counts]
            print(f"| {name} | " + " | ".join(f"{100 * e.mean():.2f} %" for e in left) + " |")


def objective(points: Floats, faces: Ints, u: Floats, alpha_hat: float) -> tuple[float, float]:
    """Eq. 11 with the Dirichlet energy, of u shrunk to unit gradient, and u's longest gradient."""
    p, q, r = (points[faces[:, k]] for k in range(3))
    normal = np.cross(q - p, r - p)
    double = np.linalg.norm(normal, axis=1)
    n = normal / double[:, None]
    g = np.zeros_like(p)
    for k in range(3):
        side = points[faces[:, (k + 2) % 3]] - points[faces[:, (k + 1) % 3]]
        g += u[faces[:, k], None] * np.cross(n, side) / double[:, None]
    slope = np.linalg.norm(g, axis=1)
    area = double / 2
    shrink = 1 / max(1.0, float(slope.max()))
    alpha = alpha_hat * np.sqrt(area.sum())
    value = 0.5 * alpha * shrink**2 * float((area * slope**2).sum())
    return value - shrink * float((area * u[faces].mean(1)).sum()), float(slope.max())


def reference(folder: Path) -> None:
    """Difference from, and objective beside, each of the authors' Dirichlet answers."""
    points = np.loadtxt(folder / "vertices.txt").reshape(-1, 3)
    faces = np.loadtxt(folder / "faces_1based.txt", dtype=np.int64).reshape(-1, 3) - 1
    source = {"spot_rr": 2272, "cat_rr": 241}[folder.name]
    print(
        "| theirs | tolerance | difference / largest | their objective, slope | ours |\n"
        "|---|---|---|---|---|"
    )
    for path in sorted(folder.glob("u_*D_alpha*.txt")):
        theirs = np.loadtxt(path)
        alpha = float(path.stem.split("alpha")[1].split("_")[0])
        for tolerance in ("0.002", "1e-4") if "tight" not in path.stem else ("1e-4", "1e-5"):
            run = Run(points, faces, source, "regularized",
                      ["--alpha", str(alpha), "--tolerance", tolerance])  # fmt: skip
            a, b = (
                objective(points, faces, theirs, alpha),
                objective(points, faces, run.values, alpha),
            )
            difference = np.abs(run.values - theirs).max() / theirs.max()
            print(
                f"| {path.stem} | {tolerance} | {difference:.1e} | {a[0]:.6f}, {a[1]:.4f} "
                f"| {b[0]:.6f}, {b[1]:.4f}, {facts(run)[0]} iterations |",
                flush=True,
            )


STUDIES: dict[str, Callable[[list[Path]], None]] = {
    "sizes": lambda paths: sizes([str(path) for path in paths]),
    "errors": errors,
    "pairs": pairs,
    "symmetry": lambda paths: symmetry(paths[0]),
    "spectrum": lambda paths: spectrum(paths[0]),
    "reference": lambda paths: reference(paths[0]),
}


def main() -> None:
    """Reads the arguments."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("study", choices=sorted(STUDIES))
    parser.add_argument("paths", nargs="+", type=Path)
    arguments = parser.parse_args()
    STUDIES[arguments.study](arguments.paths)


if __name__ == "__main__":
    main()
