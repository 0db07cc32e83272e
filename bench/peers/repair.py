"""`littoral repair` beside pymeshfix: how many broken surfaces become closed, and how they move.

usage: repair.py LITTORAL OUTPUT.md FILE...

Both get the same triangles; each input in a process of its own with a time limit. What comes out is
judged by `littoral info` (edges, crossings without rounding) and `littoral compare`.
"""

import json
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from compare import machine, replace_section

LIMIT = 300  # seconds
MESHFIX = """
import sys, numpy, trimesh, pymeshfix
mesh = trimesh.load(sys.argv[1], force="mesh")  # joins corners at one place
v, f = pymeshfix.clean_from_arrays(
    numpy.ascontiguousarray(mesh.vertices, numpy.float64),
    numpy.ascontiguousarray(mesh.faces, numpy.int32),
)
trimesh.Trimesh(v, f, process=False).export(sys.argv[2])
"""


def asked(program: str, *words: object) -> dict[str, Any]:
    found = subprocess.run(
        [program, *map(str, words), "--json"], capture_output=True, text=True, timeout=LIMIT
    )
    answer: dict[str, Any] = json.loads(found.stdout)
    return answer


def judged(program: str, words: list[str], given: Path, out: Path) -> dict[str, Any]:
    """What a program makes of a file: seconds, soundness, distance in % of the diagonal."""
    out.unlink(missing_ok=True)
    start = time.perf_counter()
    try:
        subprocess.run(words, capture_output=True, timeout=LIMIT)
    except subprocess.TimeoutExpired:
        return {"seconds": LIMIT}
    seconds = time.perf_counter() - start
    if not out.exists():
        return {"seconds": seconds}
    facts = asked(program, "info", out)
    if not facts.get("faces"):
        return {"seconds": seconds}
    box = asked(program, "info", given)["bounding_box"]
    diagonal = sum((box[k + 3] - box[k]) ** 2 for k in range(3)) ** 0.5
    sizes = asked(program, "compare", given, out)["sizes"]
    return {
        "seconds": seconds,
        "closed": facts["closed"] and facts["nonmanifold_vertices"] == 0,
        "watertight": facts["watertight"],
        "lost": 100 * sizes["A to B: mean"] / diagonal,
        "most": 100 * sizes["A to B: largest"] / diagonal,
    }


def row(name: str, answers: list[dict[str, Any]]) -> str:
    done = [a for a in answers if "lost" in a]
    share = [sum(a.get(key, False) for a in answers) for key in ("closed", "watertight")]
    middle = [statistics.median(a[key] for a in done) for key in ("lost", "most")]
    seconds = statistics.median(a["seconds"] for a in answers)
    return (
        f"| {name} | {share[0]} of {len(answers)} | {share[1]} of {len(answers)} "
        f"| {middle[0]:.3f} % | {middle[1]:.2f} % | {seconds:.1f} |"
    )


def main() -> None:
    program, output = sys.argv[1:3]
    ours, theirs = [], []
    with tempfile.TemporaryDirectory() as folder:
        for file in map(Path, sys.argv[3:]):
            given, out = Path(folder) / "given.ply", Path(folder) / "out.ply"
            made = subprocess.run([program, "convert", "--triangulate", file, "-o", given])
            if made.returncode:
                continue
            ours.append(
                judged(program, [program, "repair", str(given), "-o", str(out)], given, out)
            )
            words = [sys.executable, "-c", MESHFIX, str(given), str(out)]
            theirs.append(judged(program, words, given, out))
            print(file.name, ours[-1], theirs[-1], file=sys.stderr)
    table = [
        f"`bench/peers/repair.py`, {machine()}; {len(ours)} files, at most {LIMIT} s each.",
        "",
        "| program | closed, manifold | and free of crossings | input to result, mean | largest "
        "| seconds |",
        "|---|---|---|---|---|---|",
        row("`littoral repair`", ours),
        row("pymeshfix", theirs),
    ]
    replace_section(output, "repair", "\n".join(table) + "\n")


main()
