"""What the heat methods say about themselves, beside what is so: distance from one vertex.

usage: heat_check.py PROGRAM MESH...    prints a Markdown table: mean error against exact polyhedral
distance, the mean difference from fast marching, and the share of the surface where the gradient
is off unit length, all in %
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

CHECKS = ("mean difference from fast marching", "area fraction with gradient off unit length")


def solve(program: str, mesh: Path, vertex: str, method: str) -> tuple[np.ndarray, dict]:
    """Values, and the report."""
    out = mesh.with_suffix(".npy")
    ran = subprocess.run(
        [program, "distance", mesh, "--vertex", vertex, "--method", method, "--json", "-o", out],
        capture_output=True,
        text=True,
        timeout=120,
        check=True,
    )
    return np.abs(np.load(out)), json.loads(ran.stdout)


def rows(program: str, given: Path, folder: Path) -> None:
    """Both methods on one mesh."""
    mesh = folder / "mesh.obj"
    subprocess.run(
        [program, "convert", given, "--triangulate", "-o", mesh], check=True, capture_output=True
    )
    faces = [line for line in mesh.read_text().splitlines() if line.startswith("f ")]
    vertex = str(int(faces[0].split()[1].split("/")[0]) - 1)
    exact, _ = solve(program, mesh, vertex, "exact")
    known = np.isfinite(exact)
    for method in ("signed-heat", "unsigned-heat"):
        values, report = solve(program, mesh, vertex, method)
        error = np.abs(values - exact)[known].mean() / exact[known].max()
        shares = [100 * report["residuals"][name] for name in CHECKS]
        print(
            f"| {given.name} | {len(faces)} | {method} | {100 * error:.2f} | {shares[0]:.2f} "
            f"| {shares[1]:.1f} |",
            flush=True,
        )


def main() -> None:
    """Prints the table."""
    program = str(Path(sys.argv[1]).resolve())
    print("| mesh | triangles | method | error | from fast marching | off unit |")
    print("|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for name in sys.argv[2:]:
            try:
                rows(program, Path(name).resolve(), Path(folder))
            except (subprocess.SubprocessError, IndexError) as error:
                print(f"{name}: {type(error).__name__}", file=sys.stderr)


if __name__ == "__main__":
    main()
