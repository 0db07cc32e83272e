"""Regularized distance in the tables of its paper, on meshes at hand.

usage: study.py sizes MESH [--levels N] | errors MESH... | pairs MESH... | symmetry MESH
                | reference FOLDER

Prints Markdown. `sizes` is table 1: iterations and seconds as a mesh is subdivided. `errors` is
table 2: largest error over the largest exact distance, beside heat. `pairs` is table 3: the share
of triplets against the triangle inequality, and the asymmetry, for all pairs of vertices.
`symmetry` is figure 11. `reference` compares with the authors' answers in the folder of one of
their meshes: difference, objective, longest gradient. Seconds are processor time of the program.
"""

import argparse
import json
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

sys.path.append(str(Path(__file__).parent.parent / "quadratic"))
from surface import PROGRAM, Floats, Ints, Run, Subdivision, load, write_obj


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


def sizes(path: Path, levels: int) -> None:
    """Table 1: one source, alpha-hat 0.05, the default tolerance."""
    points, faces = load(path)
    print("| faces | iterations | seconds | of these solving | longest gradient over 1 |")
    print("|---|---|---|---|---|")
    for level in range(levels):
        if level > 0:
            finer = Subdivision(points, faces)
            points, faces = finer.points, finer.faces
        run = Run(points, faces, 0, "regularized")
        iterations, longest, status = facts(run)
        solving = dict(items(run.report["timings"])).get("solve", 0)
        print(
            f"| {len(faces)} | {iterations} | {run.seconds:.1f} | {solving:.1f} (wall) "
            f"| {longest:.1e}{'' if status == 'converged' else ' (' + status + ')'} |",
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
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        done = subprocess.run(
            [PROGRAM, "pairs", str(mesh), "-o", str(out), "--json", "--quiet", *extra],
            check=True,
            capture_output=True,
            text=True,
        )
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        return dict(items(json.loads(done.stdout)["residuals"])), seconds, np.load(out)


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


def objective(points: Floats, faces: Ints, u: Floats, alpha_hat: float) -> tuple[float, float]:
    """Eq. 11 with the Dirichlet energy, of u shrunk to slope 1, and u's longest gradient."""
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


def main() -> None:
    """Reads the arguments."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("study", choices=["sizes", "errors", "pairs", "symmetry", "reference"])
    parser.add_argument("paths", nargs="+", type=Path)
    parser.add_argument("--levels", type=int, default=4)
    arguments = parser.parse_args()
    if arguments.study == "sizes":
        sizes(arguments.paths[0], arguments.levels)
    elif arguments.study == "errors":
        errors(arguments.paths)
    elif arguments.study == "pairs":
        pairs(arguments.paths)
    elif arguments.study == "symmetry":
        symmetry(arguments.paths[0])
    else:
        reference(arguments.paths[0])


if __name__ == "__main__":
    main()
