"""`littoral repair` beside other programs: which broken surfaces become closed, how far they move.

usage: repair.py LITTORAL OUTPUT.md FILE...

All get the same triangles; each input in a process of its own with a time limit. What comes out is
judged by `littoral info` (edges, crossings without rounding) and `littoral compare`. Files that are
watertight, hold no triangles or cannot be read are left out.
"""

import json
import os
import resource
import signal
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

from compare import machine, replace_section

LIMIT = 120  # seconds of the processor
DEPTH, NODES, FINER = 8, 128, 30  # Poisson's octree; littoral's grid; alpha over the offset
MESHFIX = """
import sys, numpy, trimesh, pymeshfix
mesh = trimesh.load(sys.argv[1], force="mesh")  # joins corners at one place
v, f = pymeshfix.clean_from_arrays(
    numpy.ascontiguousarray(mesh.vertices, numpy.float64),
    numpy.ascontiguousarray(mesh.faces, numpy.int32),
)
trimesh.Trimesh(v, f, process=False).export(sys.argv[2])
"""
MANIFOLD = """
import sys, numpy, trimesh, manifold3d
mesh = trimesh.load(sys.argv[1], force="mesh")
given = manifold3d.Mesh64(
    numpy.ascontiguousarray(mesh.vertices, numpy.float64),
    numpy.ascontiguousarray(mesh.faces, numpy.uint64),
)
given.merge()
made = manifold3d.Manifold(given)
if made.status() != manifold3d.Error.NoError:
    sys.exit(str(made.status()))
out = made.to_mesh64()
trimesh.Trimesh(out.vert_properties[:, :3], out.tri_verts, process=False).export(sys.argv[2])
"""
POISSON = f"""
import sys, open3d
mesh = open3d.io.read_triangle_mesh(sys.argv[1])
mesh.compute_triangle_normals()
cloud = mesh.sample_points_uniformly(100000, use_triangle_normal=True)
out, _ = open3d.geometry.TriangleMesh.create_from_point_cloud_poisson(cloud, depth={DEPTH})
open3d.io.write_triangle_mesh(sys.argv[2], out)
"""
WRAP = f"""
import sys, numpy, trimesh
from CGAL.CGAL_Alpha_wrap_3 import Point_3_Vector, Polygon_Vector, Int_Vector, alpha_wrap_3
from CGAL.CGAL_Kernel import Point_3
from CGAL.CGAL_Polyhedron_3 import Polyhedron_3
mesh = trimesh.load(sys.argv[1], force="mesh")
points, faces = Point_3_Vector(), Polygon_Vector()
for x in mesh.vertices:
    points.append(Point_3(*map(float, x)))
for face in mesh.faces:
    corners = Int_Vector()
    for v in face:
        corners.append(int(v))
    faces.append(corners)
alpha = float(max(mesh.extents)) / {NODES}
out = Polyhedron_3()
alpha_wrap_3(points, faces, alpha, alpha / {FINER}, out)
out.write_to_file(sys.argv[2] + ".off")
trimesh.load(sys.argv[2] + ".off", process=False).export(sys.argv[2])
"""
PEERS = {
    "pymeshfix": MESHFIX,
    "manifold3d": MANIFOLD,
    f"Open3D, Poisson, depth {DEPTH}": POISSON,
    f"CGAL, alpha wrap, side / {NODES}": WRAP,
}


Answer = dict[str, Any]


def asked(program: str, *words: object) -> Answer:
    found = subprocess.run([program, *map(str, words), "--json"], capture_output=True, text=True)
    answer: Answer = json.loads(found.stdout)
    return answer


def processor_seconds(words: list[str]) -> float | None:
    """Of a program, which hardly depend on what else runs; None where it takes too long."""
    child = subprocess.Popen(
        words,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (LIMIT, LIMIT)),
    )
    _, status, used = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    return None if child.returncode == -signal.SIGKILL else used.ru_utime + used.ru_stime


def judged(program: str, words: list[str], given: Path, out: Path, box: list[float]) -> Answer:
    """What a program makes of a file: seconds, soundness, distances in % of the diagonal."""
    out.unlink(missing_ok=True)
    seconds = processor_seconds(words)
    if seconds is None or not out.exists():
        return {"seconds": LIMIT if seconds is None else seconds}
    facts = asked(program, "info", out)
    if not facts.get("faces"):
        return {"seconds": seconds}
    diagonal = sum((box[k + 3] - box[k]) ** 2 for k in range(3)) ** 0.5
    sizes = asked(program, "compare", given, out)["sizes"]
    return {
        "seconds": seconds,
        "closed": facts["closed"] and facts["nonmanifold_vertices"] == 0,
        "watertight": facts["watertight"],
        "lost": 100 * sizes["A to B: mean"] / diagonal,
        "there": 100 * sizes["A to B: largest"] / diagonal,
        "back": 100 * sizes["B to A: largest"] / diagonal,
    }


def row(name: str, answers: list[Answer]) -> str:
    done = [a for a in answers if "lost" in a]
    share = [sum(a.get(key, False) for a in answers) for key in ("closed", "watertight")]
    if not done:
        return f"| {name} | 0 of {len(answers)} | 0 of {len(answers)} | | | | |"
    middle = [statistics.median(a[key] for a in done) for key in ("lost", "there", "back")]
    seconds = statistics.median(a["seconds"] for a in answers)
    return (
        f"| {name} | {share[0]} of {len(answers)} | {share[1]} of {len(answers)} "
        f"| {middle[0]:.3f} % | {middle[1]:.2f} % | {middle[2]:.2f} % | {seconds:.1f} |"
    )


def main() -> None:
    program, output = sys.argv[1:3]
    answers: dict[str, list[Answer]] = {name: [] for name in ("`littoral repair`", *PEERS)}
    with tempfile.TemporaryDirectory() as folder:
        for file in map(Path, sys.argv[3:]):
            given, out = Path(folder) / "given.ply", Path(folder) / "out.ply"
            made = subprocess.run(
                [program, "convert", "--triangulate", file, "-o", given], capture_output=True
            )
            if made.returncode:
                continue
            facts = asked(program, "info", given)
            if facts["watertight"] or not facts["faces"]:
                continue
            calls = [[program, "repair", str(given), "-o", str(out), "--threads", "1"]]
            calls += [[sys.executable, "-c", text, str(given), str(out)] for text in PEERS.values()]
            for (name, held), words in zip(answers.items(), calls, strict=True):
                held.append(judged(program, words, given, out, facts["bounding_box"]))
                print(file.name, name, held[-1], file=sys.stderr, flush=True)
    table = [
        f"`bench/peers/repair.py`, {machine()}; {len(answers['`littoral repair`'])} files, at most",
        f"{LIMIT} s each. Distances are medians, in % of the diagonal, over the files that gave a",
        "result; seconds are the processor's, start of the program included.",
        "",
        "| program | closed, manifold | and free of crossings | input to result, mean "
        "| largest | result to input, largest | seconds |",
        "|---|---|---|---|---|---|---|",
        *(row(name, held) for name, held in answers.items()),
    ]
    replace_section(output, "repair", "\n".join(table) + "\n")


main()
