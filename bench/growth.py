"""How time and memory of signed heat grow with the mesh: the whole program, from reading to
writing.

usage: growth.py PROGRAM PAGE.md FACES...

Tori of radii 1 and 0.4 with vertices moved at random along them, from the circles on top and at
the bottom, whose exact distance is known. Writes a Markdown table with processor seconds (which
other work on the machine changes least), the largest memory, swapped out or not, errors, and the
exponent of growth.
"""

import json
import math
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).parent / "peers"))
from compare import Floats, Ints, machine, replace_section

TUBE = 0.4


def torus(faces: int) -> tuple[Floats, Ints, Floats, list[list[int]]]:
    """Vertices, triangles, exact distances and the two circles."""
    n_v = max(8, 4 * round(math.sqrt(faces / 2 / 2.5) / 4))
    n_u = max(8, round(faces / 2 / n_v))
    shift = np.random.default_rng(1).uniform(-0.25, 0.25, (2, n_v, n_u))
    circles = [n_v // 4, 3 * n_v // 4]
    shift[1, circles] = 0
    v, u = np.meshgrid(np.arange(n_v), np.arange(n_u), indexing="ij")
    a, b = (u + shift[0]) * (2 * np.pi / n_u), (v + shift[1]) * (2 * np.pi / n_v)
    r = 1 + TUBE * np.cos(b)
    points = np.stack([r * np.cos(a), r * np.sin(a), TUBE * np.sin(b)], axis=-1).reshape(-1, 3)
    corner = [((v + i) % n_v) * n_u + (u + j) % n_u for i, j in ((0, 0), (0, 1), (1, 1), (1, 0))]
    c = [x.reshape(-1) for x in corner]
    triangles = np.concatenate(
        [np.stack([c[0], c[1], c[2]], axis=1), np.stack([c[0], c[2], c[3]], axis=1)]
    )
    exact = TUBE * np.minimum(np.abs(b - np.pi / 2), np.abs(b - 3 * np.pi / 2))
    exact = np.minimum(exact, TUBE * np.abs(b + np.pi / 2)).reshape(-1)
    loops = [[k * n_u + i % n_u for i in range(n_u + 1)] for k in circles]
    return points, triangles, exact, [loops[0], loops[1][::-1]]


def write_ply(path: Path, points: Floats, triangles: Ints) -> None:
    rows = np.zeros(len(triangles), dtype=[("n", "u1"), ("corners", "<i4", 3)])
    rows["n"], rows["corners"] = 3, triangles
    header = [
        "ply\nformat binary_little_endian 1.0",
        f"element vertex {len(points)}",
        *(f"property double {x}" for x in "xyz"),
        f"element face {len(triangles)}",
        "property list uchar int vertex_indices\nend_header\n",
    ]
    with path.open("wb") as out:
        out.write("\n".join(header).encode())
        out.write(points.astype("<f8").tobytes())
        out.write(rows.tobytes())


def megabytes(pid: int) -> float:
    """What a process has in memory and in swap space."""
    lines = Path(f"/proc/{pid}/status").read_text().splitlines()
    return sum(int(x.split()[1]) for x in lines if x.startswith(("VmRSS:", "VmSwap:"))) / 1024


def measure(program: str, faces: int) -> dict[str, Any]:
    points, triangles, exact, circles = torus(faces)
    with tempfile.TemporaryDirectory() as folder:
        mesh, curve, out = (Path(folder) / name for name in ("mesh.ply", "curve.txt", "out.npy"))
        write_ply(mesh, points, triangles)
        lines = ("signed_curve\n" + "".join(f"v {i}\n" for i in circle) for circle in circles)
        curve.write_text("".join(lines))
        command = [program, "distance", str(mesh), "-s", str(curve), "-o", str(out), "--json"]
        command += ["--method", "signed-heat", "--threads", "1"]
        with (Path(folder) / "report.json").open("w") as report:
            child = subprocess.Popen(command, stdout=report)
            most = 0.0
            while (ended := os.wait4(child.pid, os.WNOHANG))[0] == 0:
                most = max(most, megabytes(child.pid))
                time.sleep(0.1)
            _, status, used = ended
        if status != 0:
            raise RuntimeError(f"{' '.join(command)} failed with status {status}")
        result = json.loads((Path(folder) / "report.json").read_text())
        stages = " ".join(f"{k} {v:.3g}" for k, v in result["timings"].items())
        print(f"{len(triangles):,} faces, clock: {stages}", file=sys.stderr, flush=True)
        phi = np.load(out)
    error = np.abs(np.abs(phi.reshape(-1)) - exact) / exact.max()
    return {
        "faces": len(triangles),
        "cpu": used.ru_utime + used.ru_stime,
        "mb": max(most, result["peak_memory_mb"]),
        "mean": 100 * float(error.mean()),
        "largest": 100 * float(error.max()),
        "iterations": dict(result.get("iterations", {})),
    }


def main() -> None:
    program, page, *sizes = sys.argv[1:]
    header = "| faces | processor s | us a face | peak MB | mean error, % | largest, % | heat |"
    lines = [header, "|---|---|---|---|---|---|---|"]
    results = []
    for size in sizes:
        r = measure(program, int(size))
        results.append(r)
        steps = r["iterations"]
        heat = next((f"{v:g} {k[5:]}" for k, v in steps.items() if k.startswith("heat")), "")
        lines.append(
            f"| {r['faces']:,} | {r['cpu']:.3g} | {1e6 * r['cpu'] / r['faces']:.3g} | "
            f"{r['mb']:.0f} | {r['mean']:.3f} | {r['largest']:.2f} | {heat} |"
        )
        print(lines[-1], flush=True)
    text = "\n".join(lines)
    if len(results) > 1:
        x = np.log([r["faces"] for r in results])
        exponents = [np.polyfit(x, np.log([r[k] for r in results]), 1)[0] for k in ("cpu", "mb")]
        text += (
            f"\n\nTime grows like faces^{exponents[0]:.2f}, memory like faces^{exponents[1]:.2f}."
        )
    replace_section(page, "growth", f"{machine()}.\n\n{text}\n")


if __name__ == "__main__":
    main()
