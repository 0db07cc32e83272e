"""Runs littoral beside potpourri3d on the same meshes and curves, and writes what it measured.

usage: compare.py TIMER wall|cpu OUTPUT.md OUTPUT.png MESH[:SUBDIVISIONS]...

wall: seconds on all cores, for a quiet machine; cpu: processor seconds on one thread, for a busy
one. Each round starts a fresh process of both programs, one after the other; tables hold medians
over rounds; there are fewer of both on large meshes. Answers are compared before times: with each
other, and up to 200k faces with exact polyhedral distance to the nodes of the curve (pygeodesic).
"""

import json
import os
import platform
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

EXACT_UP_TO = 200_000
Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
HERE = Path(__file__).parent


def read_mesh(path: str) -> tuple[Floats, Ints]:
    import potpourri3d as pp3d

    points, faces = pp3d.read_mesh(path)
    return np.asarray(points, dtype=float), np.asarray(faces, dtype=np.int64)


def subdivide(points: Floats, faces: Ints) -> tuple[Floats, Ints]:
    """One triangle becomes four, of the same surface."""
    sides = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    edges, edge_of = np.unique(sides, axis=0, return_inverse=True)
    a, b, c = faces.T
    x, y, z = len(points) + edge_of.reshape(3, -1)
    points = np.concatenate([points, points[edges].mean(axis=1)])
    quarters = [np.stack(q, axis=1) for q in ([a, x, z], [x, b, y], [z, y, c], [x, y, z])]
    return points, np.concatenate(quarters)


def ring(points: Floats, faces: Ints, seed: int, radius: float) -> list[int]:
    """The longest closed loop of edges around the vertices within a radius of one, in space."""
    near = np.linalg.norm(points - points[seed], axis=1) <= radius
    inside = faces[near[faces].all(axis=1)]
    half = {(int(f[k]), int(f[(k + 1) % 3])) for f in inside for k in range(3)}
    after = {i: j for i, j in sorted(half) if (j, i) not in half}
    best: list[int] = []
    while after:
        start, i = next(iter(after.items()))
        loop = [start]
        del after[start]
        while i in after:
            loop.append(i)
            i = after.pop(i)
        if i == start and len(loop) > len(best):
            best = [*loop, start]
    if not best:
        raise ValueError("no closed loop at this radius")
    return best


def write_obj(path: Path, points: Floats, faces: Ints) -> None:
    with path.open("w") as out:
        out.writelines(f"v {x!r} {y!r} {z!r}\n" for x, y, z in points.tolist())
        out.writelines(f"f {a} {b} {c}\n" for a, b, c in (faces + 1).tolist())


def write_curve(path: Path, nodes: list[int]) -> None:
    path.write_text("signed_curve\n" + "".join(f"v {v}\n" for v in nodes))


def run(command: list[str]) -> dict[str, float]:
    threads = {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"} if command[-1] == "cpu" else {}
    environment = os.environ | threads
    done = subprocess.run(command, check=True, capture_output=True, text=True, env=environment)
    result: dict[str, float] = json.loads(done.stdout)
    return result


def rounds_and_repeats(faces: int) -> tuple[int, int]:
    return (3, 5) if faces <= 100_000 else (3, 3) if faces <= 300_000 else (1, 1)


def error(values: Floats, truth: Floats) -> float:
    """Mean absolute difference of absolute values, in % of the largest true one."""
    return float(100 * np.abs(np.abs(values) - np.abs(truth)).mean() / np.abs(truth).max())


def measure(timer: str, clock: str, name: str, points: Floats, faces: Ints) -> dict[str, Any]:
    size = float(np.linalg.norm(np.ptp(points, axis=0)))
    seed = int(np.argmax(points[:, 1]))
    curves = [ring(points, faces, seed, share * size) for share in (0.2, 0.22)]
    with tempfile.TemporaryDirectory() as folder:
        at = Path(folder)
        write_obj(at / "mesh.obj", points, faces)
        for k, curve in enumerate(curves):
            write_curve(at / f"{k}.txt", curve)
        np.savez(at / "mesh.npz", points=points, faces=faces, curve=curves[0], other=curves[1])
        ours = [timer, *(str(at / f) for f in ("mesh.obj", "0.txt", "1.txt"))]
        n_rounds, repeats = rounds_and_repeats(len(faces))
        ours += [str(repeats), str(at / "ours"), clock]
        theirs = [sys.executable, str(HERE / "potpourri3d_timer.py"), str(at / "mesh.npz")]
        theirs += [str(repeats), str(at / "theirs"), clock]
        rounds = [(run(ours), run(theirs)) for _ in range(n_rounds)]
        phi = [np.fromfile(at / f) for f in ("ours", "theirs")]
    out: dict[str, Any] = {"name": name, "faces": len(faces), "nodes": len(curves[0])}
    for k, who in enumerate(("littoral", "potpourri3d")):
        keys = rounds[0][k]
        out[who] = {key: statistics.median(r[k][key] for r in rounds) for key in keys}
    out["difference"] = float(100 * np.abs(phi[0] - phi[1]).mean() / np.ptp(phi[0]))
    if len(faces) <= EXACT_UP_TO:
        from pygeodesic import geodesic

        solver = geodesic.PyGeodesicAlgorithmExact(points, faces.astype(np.int32))
        truth, _ = solver.geodesicDistances(np.unique(curves[0]).astype(np.int32))
        out["errors"] = [error(p, truth) for p in phi]
    return out


COLUMNS = {
    "first": "first solve",
    "none": "repeated, none",
    "zero_set": "repeated, zero-set",
    "level_sets": "repeated, level-sets",
    "soft": "repeated, soft",
    "preserved_normals": "repeated, preserved normals",
    "moved_curve_zero_set": "curve moved, zero-set",
    "first_peak_mb": "peak MB, first solve",
    "peak_mb": "peak MB",
}


def table(results: list[dict[str, Any]]) -> str:
    lines = [
        "| mesh | faces | program | mean error, % | "
        + " | ".join(COLUMNS.values())
        + " |\n|---|---|---|---|"
        + "---|" * len(COLUMNS)
    ]
    for r in results:
        for k, who in enumerate(("littoral", "potpourri3d")):
            wrong = f"{r['errors'][k]:.2f}" if "errors" in r else "-"
            cells = [f"{r[who][c]:.3g}" if c in r[who] else "-" for c in COLUMNS]
            lines.append(f"| {r['name']} | {r['faces']:,} | {who} | {wrong} | " + " | ".join(cells))
            lines[-1] += " |"
        ratio = [
            f"{r['littoral'][c] / r['potpourri3d'][c]:.2f}" if c in r["potpourri3d"] else "-"
            for c in COLUMNS
        ]
        lines.append(f"| | | ratio | differ by {r['difference']:.2f} | " + " | ".join(ratio) + " |")
    return "\n".join(lines)


def plot(results: list[dict[str, Any]], unit: str, path: str) -> None:
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    fig, ax = plt.subplots(figsize=(6, 4))
    results = sorted(results, key=lambda r: int(r["faces"]))
    faces = [r["faces"] for r in results]
    for who, colour in (("littoral", "C0"), ("potpourri3d", "C1")):
        for column, style in (("first", "-o"), ("zero_set", "--s"), ("none", ":^")):
            ax.loglog(
                faces,
                [r[who].get(column, np.nan) for r in results],
                style,
                color=colour,
                label=f"{who}, {COLUMNS[column]}",
            )
    ax.set_xlabel("faces")
    ax.set_ylabel(unit)
    ax.grid(alpha=0.3)
    ax.legend(fontsize=7)
    fig.tight_layout()
    fig.savefig(path, dpi=100)


def machine() -> str:
    model = platform.processor() or "unknown processor"
    info = Path("/proc/cpuinfo")
    if info.exists():
        names = [
            x.split(":")[1].strip() for x in info.read_text().splitlines() if "model name" in x
        ]
        model = names[0] if names else model
    commit = subprocess.run(
        ["git", "rev-parse", "--short", "HEAD"], capture_output=True, text=True, cwd=HERE
    ).stdout.strip()
    load = os.getloadavg()[0]
    return f"{model}, {os.cpu_count()} cores, load {load:.1f}, commit {commit}"


def replace_section(path: str, name: str, text: str) -> None:
    """Puts the text between the markers of a Markdown file."""
    begin, end = f"<!-- {name} -->\n", f"<!-- end of {name} -->\n"
    page = Path(path).read_text()
    head, rest = page.split(begin)
    Path(path).write_text(head + begin + text + end + rest.split(end)[1])


def main() -> None:
    timer, clock, page, picture, *meshes = sys.argv[1:]
    before = machine()
    results = []
    for spec in meshes:
        path, _, times = spec.partition(":")
        points, faces = read_mesh(path)
        for _ in range(int(times or 0)):
            points, faces = subdivide(points, faces)
        name = Path(path).stem + (f", subdivided {times}x" if times else "")
        results.append(measure(timer, clock, name, points, faces))
        print(json.dumps(results[-1]), flush=True)
    unit = {"cpu": "Processor seconds, one thread", "wall": "Seconds, all cores"}[clock]
    rounds = (
        "medians of 3 interleaved rounds, of 5 repeats in each (3 above 100k faces; one round of "
        "one repeat above 300k)"
    )
    drawn = f"![seconds over faces]({os.path.relpath(picture, Path(page).parent)})"
    text = f"{unit}; {rounds}.\n{before}.\n\n{table(results)}\n\n{drawn}\n"
    replace_section(page, "surface peers", text)
    plot(results, unit.lower(), picture)


if __name__ == "__main__":
    main()
