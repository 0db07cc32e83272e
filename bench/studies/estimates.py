"""What --dry-run estimates beside what runs take.

usage: estimates.py PROGRAM [FACES...]

Distance on the tori of bench/growth.py from their two circles, by each method that takes them, and
signed distance on grids around them: processor seconds of one thread and the largest memory, each
beside the estimate. Prints a Markdown table.
"""

import os
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from run_costs import asked, run

sys.path.insert(0, str(Path(__file__).parent.parent))
from growth import torus, write_ply

METHODS = ["signed-heat", "unsigned-heat", "auto", "exact", "fast-marching", "regularized"]
GRIDS = {"auto": 256, "winding": 256, "signed-heat": 128}


def row(words: list[Any], what: str) -> None:
    plan: dict[str, float] = asked(*words)["plan"]
    seconds, memory = run(*words)
    memory /= 2**20
    print(
        f"| {what} | {seconds:.3g} | {seconds / plan['processor_seconds']:.2f} "
        f"| {memory:.0f} | {memory / plan['memory_mb']:.2f} |",
        flush=True,
    )


def main() -> None:
    os.chdir(tempfile.mkdtemp())
    print("| run | processor s | over estimate | MB | over estimate |\n|---|---|---|---|---|")
    for faces in map(int, sys.argv[2:] or [10000, 100000, 400000, 1000000]):
        points, triangles, _, loops = torus(faces)
        mesh, curves = Path("torus.ply"), Path("curves.txt")
        write_ply(mesh, points, triangles)
        curves.write_text("".join("signed_curve\n" + "".join(f"v {v}\n" for v in x) for x in loops))
        for method in METHODS:
            words = ["distance", mesh, "-s", curves, "--method", method, "-o", "a.npy"]
            row(words, f"{method}, {len(triangles):,} faces")
    points, triangles, *_ = torus(10000)
    write_ply(mesh, points, np.asarray(triangles))
    for method, nodes in GRIDS.items():
        words = ["sdf", mesh, "--method", method, "--resolution", nodes, "-o", "a.npy"]
        row(words, f"{method}, grid of {nodes} nodes a side")


if __name__ == "__main__":
    main()
